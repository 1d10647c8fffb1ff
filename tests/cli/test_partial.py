"""calibgui calibrate on views that do not determine the camera, and on copies."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from calibgui.cli.main import main
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.result import Degeneracy
from calibgui.formats.result_json import read_result
from tests.engine import scenes
from tests.engine.degenerate_scenes import LONG, one_view, parallel

Capture = pytest.CaptureFixture[str]


def _corners_file(file: Path, views: list[Observation]) -> str:
    """A corners.json of views by a 640 x 480 camera."""
    records = [
        {"image": f"{k}.png", "uv": view.uv.tolist(), "board": view.xy.tolist()}
        for k, view in enumerate(views)
    ]
    file.write_text(json.dumps({"size": [640, 480], "views": records}))
    return str(file)


def _noisy(made: scenes.Scene) -> list[Observation]:
    return made.noisy(0.05, np.random.default_rng(2))


@pytest.mark.parametrize(
    ("views", "kind", "said"),
    [
        (
            _noisy(parallel(LONG, 0.0)),
            Degeneracy.PARALLEL_TO_SENSOR,
            "All views are parallel to the sensor",
        ),
        (_noisy(one_view(LONG)), Degeneracy.ONE_VIEW, "One view does not determine a camera"),
        (_noisy(one_view(LONG)) * 5, Degeneracy.COPIES, "All 5 views are copies of one"),
    ],
)
def test_views_that_do_not_determine_the_camera_give_a_partial_calibration(
    views: list[Observation], kind: Degeneracy, said: str, tmp_path: Path, capsys: Capture
) -> None:
    """Written and told with the reason, but no success, and in no format that could not say so."""
    corners, file = _corners_file(tmp_path / "corners.json", views), tmp_path / "result.json"
    exports = [f"opencv={tmp_path / 'camera.yaml'}", f"corners-csv={tmp_path / 'corners.csv'}"]
    options = [option for export in exports for option in ("--export", export)]
    assert main(["calibrate", corners, "-o", str(file), *options]) == 1
    printed, problems = capsys.readouterr()
    assert problems.startswith(f"calibgui: {said}")
    assert "20 to 45 degrees" in problems
    assert "A partial calibration" in printed
    assert "camera.yaml is not written" in printed.replace("\n  ", " ")
    assert not (tmp_path / "camera.yaml").exists()
    assert (tmp_path / "corners.csv").exists()
    record = json.loads(file.read_text())
    assert (record["status"], record["diagnosis"]["kind"]) == ("partial", kind)
    found = read_result(file).calibration
    assert main(["uncertainty", str(file), "-q"]) == 0
    assert "result.json is a partial calibration" in capsys.readouterr().err
    free = found.sigma > 0
    assert (np.abs(found.camera.params - LONG.params)[free] < 4 * found.sigma[free]).all()


def test_a_copy_of_a_view_counts_once(tmp_path: Path, capsys: Capture) -> None:
    views = scenes.scene(scenes.barrel(), 5).noisy(0.1, np.random.default_rng(0))
    files = tmp_path / "once.json", tmp_path / "twice.json"
    for file, given in zip(files, (views, [*views, views[2]]), strict=True):
        corners = _corners_file(tmp_path / "corners.json", given)
        assert main(["calibrate", corners, "-o", str(file)]) == 0
    assert "A copy of 2.png, which counts once" in capsys.readouterr().out
    once, twice = (read_result(file).calibration for file in files)
    np.testing.assert_array_equal(twice.sigma, once.sigma)
