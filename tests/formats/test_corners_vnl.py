"""corners.vnl, read by mrcal where it is installed, and by ourselves."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from calibgui.dataset import Result, View
from calibgui.engine.errors import CalibrationError
from calibgui.formats import export
from calibgui.formats.corner_import import read_corner_file
from tests.formats.readers import in_other_python

_MRCAL = """
import json, sys
import mrcal
import numpy as np

observations, indices, paths = mrcal.compute_chessboard_corners(
    W=8, H=6, globs_per_camera=("*",), corners_cache_vnl=sys.argv[1],
)
print(json.dumps({"corners": observations.tolist(), "paths": paths}))
"""


def list_expected(view: View) -> np.ndarray:
    """Corners (6, 8, 2) of a view, NaN where there is none."""
    assert view.corners is not None
    places = np.full((6, 8, 2), np.nan)
    places[tuple(view.corners.grid.T)] = view.corners.uv
    return places


def test_mrcal_reads_the_corners_and_their_weights(tmp_path: Path, weighted: Result) -> None:
    report = export(weighted, "corners-vnl", tmp_path / "corners.vnl")
    assert "--object-width-n 8 --object-height-n 6" in report.note
    assert "Blanks in names" in report.note
    read = in_other_python(_MRCAL, report.path, needs="import mrcal")
    found = [view for view in weighted.views if view.corners is not None]
    assert [path.split("/")[-1] for path in read["paths"]] == [
        view.image.replace(" ", "_").encode("ascii", "backslashreplace").decode() for view in found
    ]
    sigmas = []
    for view in found:
        sigma = np.full((6, 8), np.nan)
        sigma[tuple(view.corners.grid.T)] = np.sqrt(view.corners.cov[:, [0, 1], [0, 1]].mean(1))
        sigmas.append(sigma)
    typical = np.nanmedian(sigmas)
    for corners, view, sigma in zip(np.array(read["corners"]), found, sigmas, strict=True):
        expected = list_expected(view)
        seen = np.isfinite(expected[..., 0])
        assert np.array_equal(corners[..., 2] > 0, seen)
        assert np.abs(corners[seen, :2] - expected[seen]).max() < 1e-9
        levels = np.maximum(np.rint(np.log2(sigma[seen] / typical)), 0)
        assert 0 < levels.mean() < 1
        np.testing.assert_allclose(corners[seen, 2], 0.5**levels)


def test_corners_come_back(tmp_path: Path, result: Result) -> None:
    path = export(result, "corners-vnl", tmp_path / "corners.vnl").path
    read = read_corner_file(path, (6, 8), size=(640, 480))
    kept = [view for view in result.views if view.points is None]
    for view, expected in zip(read.views, kept, strict=True):
        assert (view.corners is None) is (expected.corners is None)
        if expected.corners is not None:
            np.testing.assert_array_equal(list_expected(view), list_expected(expected))
    assert "level" in path.read_text().splitlines()[2]


def test_corners_without_places_on_a_board_are_refused(tmp_path: Path, result: Result) -> None:
    foreign = tuple(view for view in result.views if view.points is not None)
    with pytest.raises(CalibrationError, match="have no rows and columns on a board"):
        export(
            replace(
                result,
                views=foreign,
                calibration=replace(result.calibration, poses=result.calibration.poses[:1]),
            ),
            "corners-vnl",
            tmp_path / "corners.vnl",
        )
