"""Rows and columns of widgets, written as what stands in them."""

from __future__ import annotations

from typing import TypeVar

from PySide6.QtWidgets import QBoxLayout, QHBoxLayout, QLayout, QVBoxLayout, QWidget

from calibgui.gui.widgets import theme

Part = QWidget | QLayout | tuple[QWidget | QLayout, int] | None
"""One part of a row or a column, with its share of the spare room if it takes any; None is the room
that nothing else takes."""
Margins = int | tuple[int, int, int, int]
"""Room around all parts: on every side, or left, above, right and below, device-independent px."""
INDENTED = (theme.SPACING, 0, 0, theme.SPACING)
"""Room around what stands below its heading."""
Box = TypeVar("Box", bound=QBoxLayout)


def make_row(
    *parts: Part, of: QWidget | None = None, spacing: int = theme.SPACING, margins: Margins = 0
) -> QHBoxLayout:
    """Lay parts out from left to right.

    Args:
        parts: what stands in the row.
        of: the widget that the row fills; None for a row within another layout.
        spacing: room between neighbours, device-independent px.
        margins: room around all of them.
    """
    return _fill(QHBoxLayout() if of is None else QHBoxLayout(of), parts, spacing, margins)


def make_column(
    *parts: Part, of: QWidget | None = None, spacing: int = theme.SPACING, margins: Margins = 0
) -> QVBoxLayout:
    """Lay parts out from top to bottom; the arguments are those of `make_row`."""
    return _fill(QVBoxLayout() if of is None else QVBoxLayout(of), parts, spacing, margins)


def keep_place(*widgets: QWidget) -> None:
    """Let widgets keep their place while they are hidden: what stands beside them must not move."""
    for widget in widgets:
        policy = widget.sizePolicy()
        policy.setRetainSizeWhenHidden(True)
        widget.setSizePolicy(policy)


def _fill(box: Box, parts: tuple[Part, ...], spacing: int, margins: Margins) -> Box:
    box.setContentsMargins(*((margins,) * 4 if isinstance(margins, int) else margins))
    box.setSpacing(spacing)
    for entry in parts:
        if entry is None:
            box.addStretch()
            continue
        part, share = entry if isinstance(entry, tuple) else (entry, 0)
        if isinstance(part, QWidget):
            box.addWidget(part, share)
        else:
            box.addLayout(part, share)
    return box
