"""Files that come with the program: the sample set, schemas, boards to print, icons."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from calibgui.engine.errors import CalibrationError
from calibgui.formats.json_document import read_json
from calibgui.formats.node import Node

_PACKAGE = Path(__file__).resolve().parents[2]


def find_resource(name: str) -> Path:
    """Return the file or folder `name` of resources/, in an installed package or in a checkout.

    Raises:
        CalibrationError: if it is missing.
    """
    for folder in (_PACKAGE / "resources", _PACKAGE.parent / "resources"):
        if (folder / name).exists():
            return folder / name
    raise CalibrationError(
        f"The program's own file {name} is missing.", "Install calibgui again, completely."
    )


def read_sample_truth() -> Node:
    """Read the camera and the board from which the sample set was rendered.

    Raises:
        CalibrationError: if it is missing.
    """
    return read_json(find_resource("sample") / "truth.json")


def find_sample_square(images: Sequence[Path]) -> float | None:
    """Return the side of the squares, mm, if `images` are the sample set; None for others."""
    sample = find_resource("sample")
    if not images or any(path.absolute().parent != sample for path in images):
        return None
    return read_sample_truth()["target"]["square_mm"].number()
