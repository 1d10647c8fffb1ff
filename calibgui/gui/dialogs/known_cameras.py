"""Camera files that are dropped, opened or chosen: the camera is held, and boards are located."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QCoreApplication

from calibgui.app.calibrating.known_camera import read_known_camera
from calibgui.app.projects.project import hold_known
from calibgui.app.projects.project_file import is_project
from calibgui.engine.images import FORMATS, list_suffixes
from calibgui.formats import holds_camera
from calibgui.gui.session.session import Session

translate = QCoreApplication.translate


def is_camera_file(name: str) -> bool:
    """Return whether a file that is not named as a photograph, and is no project, holds a
    camera."""
    path = Path(name)
    is_other = path.suffix.lower() not in (*FORMATS, *list_suffixes()) and path.is_file()
    return is_other and not is_project(path) and holds_camera(path)


def take_camera(session: Session, path: Path, *others: Path) -> None:
    """Hold the camera of a file in the project; of `others` it is said that they are not taken.

    Raises:
        CalibrationError: if the file holds no camera that can be read, or several.
    """
    views, size = session.project.views, session.project.size
    if size is None and views:
        size = session.images.read(views[0].image).size
    known, notes = read_known_camera(path, size)
    session.edit(
        translate("KnownCameras", "Known camera"), lambda project: hold_known(project, known)
    )
    said = translate(
        "KnownCameras",
        "The camera of {0} ({1}) stays as it is: Calibrate only finds where the board was. To "
        "calibrate another, take it away in the Set-up.",
    ).format(known.file, known.title)
    left = (
        translate("KnownCameras", "Of {0} camera files it is the first.").format(len(others) + 1)
        if others
        else ""
    )
    session.notified.emit("\n".join(filter(None, [said, *notes, left])))
