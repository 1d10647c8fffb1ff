"""calibgui paper: the paper's own images against the paper."""

from __future__ import annotations

import re
from pathlib import Path

import cv2
import numpy as np
import pytest

from calibgui.app.system.resources import find_resource
from calibgui.cli.main import main
from calibgui.engine.images.reading import read_image_size
from calibgui.formats.result_json import read_result

FIGURES = ("4", "5", "6", "7a", "7b", *map(str, range(8, 17)))


@pytest.mark.data
@pytest.mark.slow
def test_the_papers_images(
    bouguet: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["paper", str(bouguet), "-o", str(tmp_path)]) == 0
    page = (tmp_path / "index.html").read_text(encoding="utf-8")
    for name in FIGURES:
        assert f'src="figure-{name}.png"' in page
        assert read_image_size(tmp_path / f"figure-{name}.png")[0] > 400
    assert "located by edges" in page
    # Single views hardly object to the printed xp, yp and k1, though theirs are up to 9 px away.
    found = re.search(r"within ([\d.]+) reference px rms instead of ([\d.]+)\.", page)
    assert found is not None
    held_rms, own_rms = map(float, found.groups())
    assert own_rms < held_rms < 1.02 * own_rms
    assert "in 25 of 25 views" in page
    real, image_cost, synthetic = (
        read_result(tmp_path / f"{name}.json") for name in ("real", "image-cost", "synthetic")
    )
    assert len(real.used) == len(image_cost.used) == len(synthetic.used) == 25
    assert real.calibration.cost is not image_cost.calibration.cost
    assert str(tmp_path / "index.html") in capsys.readouterr().out


def test_views_that_are_missing_are_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Table 1 is compared view by view, so that a view less would shift all that follow."""
    for number in range(1, 4):
        cv2.imwrite(str(tmp_path / f"Image{number}.tif"), np.full((48, 64), 128, np.uint8))
    assert main(["paper", str(tmp_path), "-o", str(tmp_path / "out")]) == 1
    problem = " ".join(capsys.readouterr().err.split())
    assert "without a board that is found: Image1, Image2, Image3, Image4" in problem
    assert "Image25." in problem and "25 images" in problem


def test_other_photographs_are_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["paper", str(find_resource("sample")), "-o", str(tmp_path / "out")]) == 1
    problem = " ".join(capsys.readouterr().err.split())
    assert "has none of the paper's images, Image1 to Image25. Name the folder" in problem
    assert main(["paper", str(tmp_path / "no"), "-o", str(tmp_path / "out")]) == 1
    assert "There is no folder" in capsys.readouterr().err
