"""A zoom lens photographed at seven focal lengths: what the series says of those between."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.assessment.changes.comparison import compare_cameras
from calibgui.engine.assessment.changes.drift import UncertainCamera, choose_covariance
from calibgui.engine.assessment.changes.series import Series, Setting, fit_series
from calibgui.engine.boards.board import Board
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.camera.camera import Camera
from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.images.rendering import render_view
from tests.engine import scenes

_SIZE = (240, 180)
_BOARD = Board(rows=6, cols=8, square=30.0)
_ZOOMS_MM = np.linspace(18.0, 55.0, 7)
_VIEWS = 8


def zoomed(mm: float) -> Camera:
    """The camera at a focal length: f, centre and distortion vary, the centre by 5 px."""
    s = mm - 18.0
    f = 230 + 8.0 * s + 0.04 * s**2
    centre = [118 + 0.08 * s, 91 - 0.1 * s + 0.002 * s**2]
    distortion = [0.28 - 0.012 * s + 1e-4 * s**2, 0.05, 0.0, 0.0, 0.0, 0.0]
    return Camera(_SIZE, [f, f, *centre, *distortion])


def photograph(mm: float, rng: np.random.Generator) -> list[Observation]:
    """Corners that are found in rendered photographs."""
    views = []
    for _ in range(_VIEWS):
        pose = scenes.looking(zoomed(mm), rng, fill=(0.75, 0.9), board=_BOARD)
        image = render_view(
            zoomed(mm), pose, _BOARD, blur=0.7, noise=2.0, seed=int(rng.integers(1 << 30))
        )
        corners = find_corners(image, _BOARD.grid_size)
        views.append(Observation(corners.uv, corners.grid[:, ::-1] * _BOARD.square))
    return views


@pytest.fixture(scope="module")
def series() -> Series:
    rng = np.random.default_rng(20)
    held = {"k2": 0.05, "k3": 0.0, "p1": 0.0, "p2": 0.0, "p3": 0.0}
    settings = []
    for mm in _ZOOMS_MM:
        found = calibrate(photograph(float(mm), rng), _SIZE, fix=held)
        settings.append(Setting(float(mm), UncertainCamera(found.camera, choose_covariance(found))))
    return fit_series(settings)


def miss(series: Series, mm: float) -> Array:
    """Errors of f, centre and k1 at a focal length, in standard deviations."""
    known = series.predict(mm)
    sigma = np.sqrt(np.diag(known.covariance))[:5]
    return (known.camera.params - zoomed(mm).params)[:5] / sigma


@pytest.mark.slow
def test_photographed_zooms_are_known_between_as_is_said(series: Series) -> None:
    between = (_ZOOMS_MM[:-1] + _ZOOMS_MM[1:]) / 2
    z = np.array([miss(series, float(mm)) for mm in between])
    assert 0.3 < np.sqrt(np.mean(z**2)) < 1.5
    errors = [compare_cameras(zoomed(mm), series.predict(mm).camera).rms for mm in between]
    assert max(errors) < 0.01, "px rms over the image"


@pytest.mark.slow
def test_one_setting_knows_less_than_the_series(series: Series) -> None:
    """The truth's error at the settings is smaller by the series than by each calibration."""
    single, joint = [], []
    for value, known in series.settings:
        single.append(compare_cameras(zoomed(value), known.camera).rms)
        joint.append(compare_cameras(zoomed(value), series.predict(value).camera).rms)
    assert np.sqrt(np.mean(np.square(joint))) < 0.9 * np.sqrt(np.mean(np.square(single)))
