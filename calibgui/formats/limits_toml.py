"""Limits of calibrations as a TOML file, and as the member `limits` of result.json.

    largest_edge_error_px, fewest_views, least_coverage (0 to 1), largest_change_px
    largest_length_sigma_mm, length_mm, distance_mm    the three of a length go together

Reader: `read_limits`. What is not named is not demanded. In result.json there is the `name` too.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from calibgui.dataset.limits import LengthLimit, Limits
from calibgui.engine.errors import CalibrationError
from calibgui.formats.node import Node
from calibgui.formats.toml_document import read_toml

_MAX_SIZE = 1 << 20
"""Size of the largest file of limits that is read, bytes."""
_FIGURES = ("largest_edge_error_px", "fewest_views", "least_coverage", "largest_change_px")
_LENGTH = ("largest_length_sigma_mm", "length_mm", "distance_mm")


def read_limits(file: Path) -> Limits:
    """Read limits from a TOML file, whose name without the suffix is theirs.

    Raises:
        CalibrationError: if the file cannot be read, or a key or a value is none that is known.
    """
    return _decode(read_toml(file, _MAX_SIZE), file.stem)


def decode_limits(node: Node | None) -> Limits | None:
    """Return the limits of a JSON object; None if there is none."""
    if node is None:
        return None
    name = node["name"].text()
    rest = {key: value for key, value in node.value.items() if key != "name"}
    return _decode(Node(rest, node.where, node.file), name)


def encode_limits(limits: Limits) -> dict[str, Any]:
    """Return the JSON object of limits."""
    figures = {name: getattr(limits, name) for name in _FIGURES}
    length = limits.length
    stated = (
        (None,) * 3 if length is None else (length.sigma_mm, length.length_mm, length.distance_mm)
    )
    figures |= dict(zip(_LENGTH, stated, strict=True))
    return {"name": limits.name} | {
        name: value for name, value in figures.items() if value is not None
    }


def _decode(node: Node, name: str) -> Limits:
    """Return the limits of an object that has nothing else."""
    known, found = (*_FIGURES, *_LENGTH), {}
    for key, value in node.members().items():
        if key not in known:
            raise CalibrationError(
                f"{node.file}: there is no limit {key!r}.", f"Choose from {', '.join(known)}."
            )
        if (limit := value.number()) < 0:
            value.fail("a number from 0 on")
        found[key] = limit
    stated = [found.pop(key) for key in _LENGTH if key in found]
    if stated and (len(stated) < len(_LENGTH) or not min(stated[1:]) > 0):
        raise CalibrationError(
            f"{node.file}: a limit on a length lacks a part of it, or is of no length.",
            f"State {', '.join(_LENGTH)} together, above 0.",
        )
    return Limits(**found, length=LengthLimit(*stated) if stated else None, name=name)
