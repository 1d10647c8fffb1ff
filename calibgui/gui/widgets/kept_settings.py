"""The window keeps settings from one session to the next, and reads damaged ones as far as they go.

A settings file may have been edited, cut or written by another version: whatever is not of the type
that is asked for counts as not kept.
"""

from __future__ import annotations

from PySide6.QtCore import QByteArray, QSettings


def read_kept_bytes(name: str) -> QByteArray | None:
    """Return the kept bytes, such as a layout; None if there are none."""
    value = _read(name)
    return value if isinstance(value, QByteArray) else None


def read_kept_text(name: str) -> str | None:
    """Return the kept text; None if there is none."""
    value = _read(name)
    return value if isinstance(value, str) else None


def keep(name: str, value: QByteArray | str) -> None:
    """Keep a value for the next session."""
    QSettings().setValue(name, value)


def _read(name: str) -> object:
    try:
        return QSettings().value(name)
    except Exception:  # Qt makes Python's objects of some values, which fails in any way
        return None
