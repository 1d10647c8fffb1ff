"""Methods side by side: every figure against another way to it, and every way to fail."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

from calibgui.engine.assessment.choices import method_comparison
from calibgui.engine.assessment.choices.cross_validation import cross_validate
from calibgui.engine.assessment.choices.method_comparison import (
    AS_PRINTED,
    MethodComparison,
    compare_methods,
    list_compared_methods,
    measure_radial_shift,
)
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.methods import METHODS
from calibgui.engine.calibration.methods.dlt import DLT
from calibgui.engine.calibration.methods.plumb_line import LINE_METHODS
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.camera.camera import Camera
from calibgui.engine.errors import CalibrationError, Cancelled
from tests.engine.scenes import VGA, Scene, brown, scene

FEW = ("lucchese", "bouguet", "dlt", "devernay-faugeras")


@pytest.fixture(scope="module", autouse=True)
def few_methods() -> Iterator[None]:
    """Let there be few methods to compare, which is quick."""
    few = {name: list_compared_methods()[name] for name in FEW}
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(method_comparison, "list_compared_methods", lambda: few)
        yield


def photograph(exact: Scene) -> list[Observation]:
    return exact.noisy(0.1, np.random.default_rng(5))


EXACT = scene(brown(), 6, seed=3)
VIEWS = photograph(EXACT)


@pytest.fixture(scope="module")
def compared() -> MethodComparison:
    """All on the views, with the poses of the board known, in folds of two."""
    return compare_methods(VIEWS, VGA, folds=3, board_poses=EXACT.poses)


def test_all_methods_are_listed_the_default_first() -> None:
    names = list(list_compared_methods())
    assert names[:2] == ["lucchese", AS_PRINTED]
    assert set(names) == {AS_PRINTED, *METHODS, DLT.name, *LINE_METHODS}


def test_the_radial_shift_is_that_of_the_formula() -> None:
    """n = d / (1 + k1 r^2) of the division model has the measured radius in closed form."""
    k1, f, radius = -0.3, 500.0, 240.0
    camera = Camera(VGA, [f, f, 310.0, 250.0, k1], "division")
    r = radius / f
    assert measure_radial_shift(camera, radius) == pytest.approx(radius - f * r / (1 + k1 * r * r))
    forward = Camera(VGA, [f, f, 310.0, 250.0, 0.2, 0.1, 0, 0, 0], "brown-conrady-4")
    n = brentq(lambda n: n * (1 + 0.2 * n**2 + 0.1 * n**4) - r, 0, 1, xtol=1e-14)
    assert measure_radial_shift(forward, radius) == pytest.approx(radius - f * n)


def test_uncertainty_of_a_linear_function_is_exact() -> None:
    rng = np.random.default_rng(0)
    a, root = rng.normal(size=4), rng.normal(size=(4, 4))
    root[2] = 0  # a parameter that is held
    C = root @ root.T
    found = method_comparison._propagate(lambda p: float(a @ p), rng.normal(size=4), C)
    assert found == pytest.approx(np.sqrt(a @ C @ a))


def test_the_scatter_of_the_shift_is_as_stated(compared: MethodComparison) -> None:
    rng = np.random.default_rng(6)
    stated = compared.trials["bouguet"].distortion
    estimate = LINE_METHODS["devernay-faugeras"].estimate
    by_lines = compared.lines["devernay-faugeras"].distortion
    shifts = []
    for _ in range(25):
        views = EXACT.noisy(0.1, rng)
        camera = calibrate(views, VGA, method="bouguet").camera
        lines = method_comparison._measure_line_distortion(estimate(views, VGA), by_lines.radius)
        shifts.append([measure_radial_shift(camera, stated.radius), lines.shift])
    scatter = np.std(shifts, axis=0, ddof=1)
    np.testing.assert_allclose(scatter, [stated.sigma, by_lines.sigma], rtol=0.45)


def test_the_error_on_unseen_views_is_that_of_the_cross_validation(
    compared: MethodComparison,
) -> None:
    for name in ("lucchese", "bouguet"):
        expected = cross_validate(VIEWS, VGA, 3, method=name).held_out
        assert compared.trials[name].held_out == pytest.approx(expected)


def test_the_default_camera_is_the_one_to_compare_with(compared: MethodComparison) -> None:
    default = compared.trials["lucchese"]
    assert compared.chosen is default.calibration.camera
    assert default.difference is not None and default.difference.worst < 1e-9
    other = compare_methods(VIEWS, VGA, EXACT.camera, folds=2)
    difference = other.trials["bouguet"].difference
    assert other.chosen is EXACT.camera
    assert difference is not None and 0 < difference.rms < 0.1
    lines = other.lines["devernay-faugeras"]
    assert lines.difference_rms < lines.worst < 1
    assert lines.region.any() and not lines.region.all()


def test_known_poses_allow_the_dlt_also_on_a_part_of_the_views(compared: MethodComparison) -> None:
    dlt = compared.trials["dlt"]
    assert dlt.held_out > 0.1 and dlt.remarks == ()
    assert np.isnan(dlt.distortion.shift), "it estimates none"
    unknown = compare_methods(VIEWS, VGA, folds=2)
    assert "not known to each other" in unknown.refused["dlt"]
    assert list(unknown.methods) == list(FEW)


def test_few_views_leave_the_error_on_unseen_ones_open() -> None:
    few = compare_methods(VIEWS[:2], VGA, folds=5).trials["bouguet"]
    assert np.isnan(few.held_out)
    assert few.remarks[-1].startswith("Without some of the views it fails: ")


def test_a_lens_without_distortion_is_remarked_on() -> None:
    ideal = replace(brown(), params=np.array([650.0, 650, 303, 243, 0, 0, 0, 0, 0, 0]))
    lines = compare_methods(photograph(scene(ideal, 6, seed=3)), VGA, folds=2).lines
    assert "no distortion" in lines["devernay-faugeras"].remarks[0]


def test_views_without_a_camera_and_a_wish_to_stop_end_it() -> None:
    with pytest.raises(CalibrationError):
        compare_methods(VIEWS[:1], VGA)

    def stop(*_: int) -> None:
        raise Cancelled

    with pytest.raises(Cancelled):
        compare_methods(VIEWS, VGA, progress=stop)
    with pytest.raises(Cancelled):
        compare_methods(VIEWS, VGA, check=stop)


def test_a_comparison_that_is_ended_keeps_what_is_done(compared: MethodComparison) -> None:
    tried: list[int] = []

    def end_in_the_second() -> None:
        if tried[-1] == 1:
            raise Cancelled

    ended = compare_methods(
        VIEWS, VGA, folds=3, progress=lambda done, _: tried.append(done), check=end_in_the_second
    )
    assert list(ended.trials) == ["lucchese"] and not ended.lines
    assert ended.trials["lucchese"].held_out == compared.trials["lucchese"].held_out
    assert {*ended.refused} == {*ended.methods} - {"lucchese"}
