"""Regions of interest from a file."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from calibgui.app.photographs.regions import read_regions
from calibgui.engine.errors import CalibrationError

QUAD = [[10, 10], [90, 12], [88, 70], [9, 75]]
IMAGES = [Path("a/1.png"), Path("b/1.png"), Path("b/2.png")]


def written(folder: Path, content: object) -> Path:
    file = folder / "roi.json"
    file.write_text(json.dumps(content))
    return file


def test_images_are_named_with_or_without_their_folder(tmp_path: Path) -> None:
    regions = read_regions(written(tmp_path, {"2.png": QUAD, "a/1.png": QUAD}), IMAGES)
    assert set(regions) == {Path("b/2.png"), Path("a/1.png")}
    assert regions[Path("b/2.png")].tolist() == QUAD


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        ({"1.png": QUAD}, "several images"),
        ({"3.png": QUAD}, "none of the images"),
        ({"2.png": QUAD[:3]}, "4 entries"),
        ({"2.png": [QUAD[0], QUAD[2], QUAD[1], QUAD[3]]}, "convex"),
        ({"2.png": [[0, 0], [1, None], [1, 1], [0, 1]]}, "finite"),
        ([QUAD], "object"),
    ],
)
def test_what_is_wrong_is_named(tmp_path: Path, content: object, reason: str) -> None:
    with pytest.raises(CalibrationError, match=reason) as caught:
        read_regions(written(tmp_path, content), IMAGES)
    assert "roi.json" in caught.value.message
