"""The question for the name of a file to write, which never replaces one that the user did not see.

Qt's dialog asks before a file is replaced, by the name that was typed. Where that has no suffix, it
gets one afterwards, and the file of the longer name is asked about here.
"""

from __future__ import annotations

import re
from pathlib import Path

from PySide6.QtCore import QCoreApplication
from PySide6.QtWidgets import QFileDialog, QWidget

from calibgui.gui.widgets import questions
from calibgui.gui.widgets.questions import Answer


def ask_for_name(parent: QWidget, title: str, start: str, kinds: str) -> Path | None:
    """Ask for the file to write.

    Args:
        parent: the dialog opens over it.
        title: of the dialog.
        start: name that is proposed; one without a folder is put beside the file that the window
            shows (Qt's `windowFilePath`).
        kinds: Qt's filters, as "PDF (*.pdf);;SVG drawing (*.svg)"; a name without a suffix gets the
            one that was chosen.

    Returns:
        The path; None if the user does not want to write, or to replace.
    """
    name, chosen = QFileDialog.getSaveFileName(parent, title, _find_place(parent, start), kinds)
    if not name:
        return None
    path = Path(name)
    if path.suffix:
        return path
    suffix = re.search(r"\*(\.\w+)", chosen or kinds)
    path = path.with_name(path.name + (suffix[1] if suffix else ""))
    return path if not path.exists() or _may_replace(parent, path) else None


def _find_place(parent: QWidget, start: str) -> str:
    """Return where the dialog begins: `start`, in a folder of the user's work."""
    at: QWidget | None = parent
    while at is not None and not at.windowFilePath():
        at = at.parentWidget()
    if at is None or Path(start).parent != Path():
        return start
    return str(Path(at.windowFilePath()).parent / start)


def _may_replace(parent: QWidget, path: Path) -> bool:
    translate = QCoreApplication.translate
    answer = questions.ask(
        parent,
        translate("files", "Replace a file"),
        translate("files", "{0} exists. Replace it?").format(path),
        Answer.Yes | Answer.No,
        Answer.No,
    )
    return answer == Answer.Yes
