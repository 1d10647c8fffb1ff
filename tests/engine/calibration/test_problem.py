"""The arguments that repeat a calibration are recovered from it."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from calibgui.dataset import Result, View, ViewStatus
from calibgui.engine.boards.shape import BoardShapePrior
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.problem import recover_arguments
from calibgui.formats.result_json import read_result, write_result
from tests.engine.scenes import VGA, barrel, scene


def test_the_same_again_from_its_file(tmp_path: Path) -> None:
    views = scene(barrel(), 5, seed=1).noisy(0.1, np.random.default_rng(0))
    prior = BoardShapePrior(0.05, 0.2)
    first = calibrate(views, VGA, fix={"k3": 0.01}, free="p3", board_shape="free", prior=prior)
    seen = tuple(View(f"{k}", ViewStatus.FOUND, points=view) for k, view in enumerate(views))
    write_result(Result(first, seen), tmp_path / "result.json")
    read = read_result(tmp_path / "result.json").calibration
    for calibration in (first, read):
        assert recover_arguments(calibration)["prior"] == prior
        again = calibrate(views, VGA, **recover_arguments(calibration))
        np.testing.assert_array_equal(again.camera.params, first.camera.params)
        assert again.digest == first.digest
