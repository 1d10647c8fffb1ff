"""Files that come with the program: the sample set, schemas, targets, icons."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import calibgui
from calibgui.engine.errors import CalibrationError
from calibgui.formats.json_document import Node, read

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


def sample_truth() -> Node:
    """What the sample set was rendered from.

    Raises:
        CalibrationError: if it is missing.
    """
    return read(resource("sample") / "truth.json")


def sample_square(images: Iterable[Path]) -> float | None:
    """Side of the squares, mm, if `images` are the sample's; None of any others."""
    folders = {path.absolute().parent for path in images}
    if folders != {resource("sample")}:
        return None
    return sample_truth()["target"]["square_mm"].number()
