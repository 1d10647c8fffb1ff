"""Every method, on corners without noise of a lens that it can follow, finds that lens and pose."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.methods import METHODS
from calibgui.engine.calibration.methods.dlt import DLT, make_dlt
from calibgui.engine.calibration.methods.plumb_line import LINE_METHODS
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.models import find_model
from calibgui.engine.geometry.frames import centre_of_array
from tests.engine.scenes import LENSES, VGA, relative, scene

ALL = {**METHODS, DLT.name: DLT}
"""All methods; the DLT is made for places of the board."""
TOLERANCE = 1e-6
LENS = {"weng": (-0.3, *LENSES["thin-prism"][1:])}
"""Lenses other than those of `LENSES`: turns end sooner the stronger the barrel is."""
SINGLE_PRECISION = {"opencv": 2e-5}
"""Error of coefficients that corners in single precision leave."""
KNOWN = {"zhang-alternation": ("k2",), "weng": ("cx", "cy")}
"""Parameters that are given to methods that take turns, of which they need thousands without."""


def make_truth(name: str) -> Camera:
    """A camera of the method's own lens model, with a value for every parameter it estimates."""
    method = ALL[name]
    model = method.lens_models[0]
    held = find_model(model).held if method.held is None else method.held
    usual = dict(zip(("cx", "cy"), centre_of_array(VGA).tolist(), strict=True)) | {"fy": 650.0}
    values = [650.0, 657.0, 303.0, 246.0, *LENS.get(name, LENSES[model])]
    names = Camera(VGA, values, model).names
    params = [
        usual.get(parameter, 0.0) if parameter in held else value
        for parameter, value in zip(names, values, strict=True)
    ]
    return Camera(VGA, params, model)


@pytest.mark.parametrize("name", ALL)
def test_a_camera_method_recovers_what_it_estimates(name: str) -> None:
    truth = make_truth(name)
    exact = scene(truth, 4, seed=2)
    params = dict(zip(truth.names, truth.params.tolist(), strict=True))
    known = {parameter: params[parameter] for parameter in KNOWN.get(name, ())}
    method = make_dlt(exact.poses) if name == "dlt" else ALL[name]
    found = calibrate(exact.views, VGA, method=method, fix=known, max_iterations=3000)
    np.testing.assert_allclose(
        found.camera.params, truth.params, rtol=TOLERANCE, atol=SINGLE_PRECISION.get(name, 0.0)
    )
    for pose, true in zip(found.poses, exact.poses, strict=True):
        assert np.abs(pose.rvec - true.rvec).max() < TOLERANCE
        assert relative(pose.tvec, true.tvec) < TOLERANCE
    estimated = {parameter for parameter in truth.names if parameter not in found.fixed}
    assert all(params[parameter] != 0 for parameter in estimated)


@pytest.mark.parametrize("name", LINE_METHODS)
def test_a_line_method_recovers_what_it_estimates(name: str) -> None:
    """About (305, 250), with one coefficient and pixels 0.95 as wide, or two and square ones."""
    aspect, k2 = (1.0, 0.15) if name == "stein" else (0.95, 0.0)
    truth = Camera(VGA, [650.0 * aspect, 650.0, 305.0, 250.0, 0.25, k2, 0, 0, 0, 0])
    found = LINE_METHODS[name].estimate(scene(truth, 3, seed=5).views, VGA)
    values = {
        "cx": 305.0,
        "cy": 250.0,
        "k1": 0.25 / 650.0**2,
        "k2": k2 / 650.0**4,
        "aspect": aspect,
    }
    np.testing.assert_allclose(found.centre, [305.0, 250.0], rtol=TOLERANCE)
    np.testing.assert_allclose(found.aspect, aspect, rtol=TOLERANCE)
    k = [values[parameter] for parameter in found.names if parameter.startswith("k")]
    np.testing.assert_allclose(found.k, k, rtol=TOLERANCE)
    assert set(found.estimated) == set(found.names)
