"""Files that come with the program: the sample set, schemas, targets, icons."""

from __future__ import annotations

from pathlib import Path

import calibgui
from calibgui.engine.errors import CalibrationError

_PACKAGE = Path(calibgui.__file__).resolve().parent


def resource(name: str) -> Path:
    """The file or folder `name` of resources/, in an installed package or in a checkout.

    Raises:
        CalibrationError: if it is missing.
    """
    for folder in (_PACKAGE / "resources", _PACKAGE.parent / "resources"):
        if (folder / name).exists():
            return folder / name
    raise CalibrationError(
        f"The program's own file {name} is missing.", "Install calibgui again, completely."
    )
