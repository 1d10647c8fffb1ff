"""The sentences name what was put into the views, and stay silent about what was not."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from calibgui import engine
from calibgui.dataset import Result, View, ViewStatus
from calibgui.dataset.judging import judge_result
from calibgui.engine.arrays import Size
from calibgui.engine.assessment import Cause
from calibgui.engine.assessment.residuals.error_sources import ErrorSources
from calibgui.engine.boards.shape import BoardShape, BoardShapeModel
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.result import Status, Undetermined
from calibgui.engine.geometry.pose import Pose
from calibgui.report.summary import (
    Tone,
    describe_board_shape,
    describe_calibration,
    describe_error_sources,
    find_outlying_views,
)
from calibgui.report.tables import format_report
from tests.babelcalib import OV_PLANE_SIZE, read_ov_plane
from tests.engine import scenes
from tests.engine.degenerate_scenes import LONG, in_one_spot

CAMERA = scenes.barrel()


def solved(
    views: Sequence[Observation],
    seed: int = 0,
    left_out: int = 0,
    size: Size = CAMERA.size,
    **settings: object,
) -> Result:
    rng = np.random.default_rng(seed)
    noisy = [Observation(v.uv + rng.normal(scale=0.1, size=v.uv.shape), v.xy) for v in views]
    made = [View(f"photographs/{k}.png", ViewStatus.FOUND, points=v) for k, v in enumerate(noisy)]
    made += [View("dark.png", ViewStatus.NO_BOARD, "No board.")] * left_out
    return Result(engine.calibrate(noisy, size, **settings), tuple(made))  # type: ignore[arg-type]


def texts(result: Result, tone: Tone) -> str:
    return "\n".join(s.text for s in describe_calibration(result) if s.tone is tone)


def everywhere(count: int = 20, seed: int = 5) -> list[Observation]:
    """Views whose boards, partly cut off, reach into all parts of the image."""
    rng = np.random.default_rng(seed)
    poses = []
    for k in range(count):
        pose = scenes.looking(CAMERA, rng, fill=(0.5, 0.9))
        aside = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1], [0, 0]][k % 5]) * [0.2, 0.15]
        poses.append(Pose(pose.rvec, pose.tvec + np.append(aside * pose.tvec[2], 0.0)))
    return list(scenes.seen(CAMERA, poses, partial=True).views)


@pytest.fixture(scope="module")
def good() -> Result:
    return solved(everywhere())


def test_a_board_that_noise_bends_is_distinguished_from_a_bent_one() -> None:
    nominal = np.array(scenes.BOARD.points())
    for size, feigned in ((0.02, True), (0.2, False)):
        deviation = np.full((len(nominal), 3), size)
        board_shape = BoardShape(
            BoardShapeModel.FREE, nominal, deviation, np.full_like(deviation, 0.02)
        )
        assert ("it may well be as drawn" in describe_board_shape(board_shape)) is feigned


@pytest.mark.parametrize(("fill", "is_advised"), [((0.15, 0.2), True), ((0.5, 0.9), False)])
def test_boards_far_away_are_to_be_held_nearer(fill: tuple[float, float], is_advised: bool) -> None:
    rng = np.random.default_rng(5)
    poses = [scenes.looking(CAMERA, rng, fill=fill) for _ in range(12)]
    told = texts(solved(scenes.seen(CAMERA, poses).views), Tone.ADVICE)
    assert ("hold the board nearer" in told) is is_advised
    assert ("% of its width or height" in told) is is_advised


def test_a_lens_that_is_not_followed_is_named_and_the_board_is_not(good: Result) -> None:
    wrong = solved(everywhere(), model="pinhole")
    caution = texts(wrong, Tone.CAUTION)
    assert "The lens model Pinhole does not follow this lens" in caution
    assert f"{wrong.calibration.lens_error:.2g} px (rms)" in caution
    assert "Compare the lens models" in caution
    assert "not flat" not in caution
    assert "stands in" not in caution
    assert "as drawn" not in caution
    bowed = solved(everywhere(), model="pinhole", board_shape="bow")
    free = texts(bowed, Tone.CAUTION)
    missed = f"{bowed.calibration.lens_error:.2g} px"
    assert f"with the board as drawn, it leaves a displacement of {missed} (rms)" in free
    finding = next(f for f in judge_result(bowed).findings if f.cause is Cause.LENS)
    assert f"With the board as drawn, it leaves {missed} that all" in finding.evidence
    assert "The board's estimated shape stands in for the lens" in free
    assert "does not follow" not in texts(good, Tone.CAUTION)


def test_a_wrong_lens_is_named_where_the_board_was_not_suspected() -> None:
    wrong = solved(everywhere(), model="pinhole")
    unsuspected = replace(wrong, calibration=replace(wrong.calibration, lens_error=0.0))
    assert "does not follow this lens" in texts(unsuspected, Tone.CAUTION)


def test_the_sources_of_the_residuals_are_given_in_pixels(good: Result) -> None:
    assert "neither lens, board nor single views" in texts(good, Tone.FACT)
    sources = ErrorSources(5.11, 4.2, 0.0, 0.93, 0.3, True)
    assert describe_error_sources(sources) == (
        "Of the 5.1 px RMS, the lens model leaves 4.2 px that it cannot follow, single views add "
        "0.93 px of their own and noise adds 0.3 px (these add up in squares)."
    )


@pytest.mark.data
def test_a_fisheye_is_told_from_a_board_that_is_off(data_dir: Path) -> None:
    views = read_ov_plane(data_dir / "babelcalib_ov_plane", "train")
    made = tuple(View(f"{k}.png", ViewStatus.FOUND, points=v) for k, v in enumerate(views))
    papers, fisheye = (
        Result(engine.calibrate(views[::step], OV_PLANE_SIZE, model=model), made[::step])
        for model, step in (("lucchese", 4), ("kannala-brandt", 1))  # a quarter is enough to see it
    )
    assert "does not follow this lens" in texts(papers, Tone.CAUTION)
    assert "not flat" not in texts(papers, Tone.CAUTION)
    assert "Of the 2.5 px RMS, the lens model leaves 2.4" in texts(papers, Tone.FACT)
    assert "does not follow" not in texts(fisheye, Tone.CAUTION)
    assert "not flat" in texts(fisheye, Tone.CAUTION)
    assert "the board adds 0.43 px" in texts(fisheye, Tone.FACT)


def test_what_would_help_a_lens_model_that_is_to_be_given_up_is_not_advised(good: Result) -> None:
    lacking = Undetermined("cx", "the views leave it open")
    for result, tone in ((good, Tone.CAUTION), (solved(everywhere(), model="pinhole"), Tone.FACT)):
        unfinished = replace(
            result.calibration, status=Status.MAX_ITERATIONS, undetermined=(lacking,)
        )
        told = texts(replace(result, calibration=unfinished), tone)
        is_advised = tone is Tone.CAUTION
        assert "used up its iterations" in told and "cx is not determined" in told
        assert ("Allow more of them" in told) is is_advised
        assert ("Hold it, or add views" in told) is is_advised


def test_an_unfinished_solve_is_not_taken_apart(good: Result) -> None:
    stopped = replace(good, calibration=replace(good.calibration, status=Status.STOPPED))
    assert "looks like noise" not in texts(stopped, Tone.FACT)


def test_corners_in_one_spot_are_named() -> None:
    made = in_one_spot(LONG)
    noisy = made.noisy(0.02, np.random.default_rng(0))
    views = tuple(View(f"{k}.png", ViewStatus.FOUND, points=v) for k, v in enumerate(noisy))
    result = Result(engine.calibrate(noisy, made.size), views)
    assert "All corners lie in one spot" in texts(result, Tone.CAUTION)


def test_the_verdict_comes_first(good: Result) -> None:
    def verdict(result: Result) -> tuple[Tone, str]:
        first = describe_calibration(result)[0]
        return first.tone, first.text

    assert verdict(good) == (Tone.GOOD, "GOOD. The photographs show nothing wrong.")
    wrong = solved(everywhere(), model="pinhole")
    tone, words = verdict(wrong)
    assert tone is Tone.CAUTION and re.fullmatch(r"CAN BE \d+ TIMES BETTER\.", words)
    stopped = replace(good, calibration=replace(good.calibration, status=Status.STOPPED))
    assert verdict(stopped) == (
        Tone.CAUTION,
        "NOT USABLE. The calibration is not finished.",
    )


def test_good_views_ask_for_nothing(good: Result) -> None:
    assert not texts(good, Tone.ADVICE)
    assert "would halve" in texts(good, Tone.GOOD)
    corners = sum(len(v.image) for v in good.calibration.residuals)
    assert f"20 views with {corners:,} corners, every image used." in texts(good, Tone.FACT)


def test_focal_length_is_given_with_its_sigma(good: Result) -> None:
    fx, sigma = good.calibration.camera.params[0], good.calibration.sigma[0]
    assert f"fx = {fx:.2f} ± {sigma:.2f}" in texts(good, Tone.GOOD)


def test_scatter_is_given_along_both_axes(good: Result) -> None:
    fit = engine.summarise_residuals(good.calibration.residuals)
    assert f"σ = {fit.sigma_x:.3f} px across and {fit.sigma_y:.3f} px down" in texts(
        good, Tone.FACT
    )


def test_images_left_out_are_counted(good: Result) -> None:
    lost = View("dark.png", ViewStatus.NO_BOARD, "No board.")
    assert "; 2 images left out." in texts(
        replace(good, views=(*good.views, lost, lost)), Tone.FACT
    )


def test_too_few_views_are_told_what_to_add_once() -> None:
    result = solved(everywhere(2))
    assert Cause.FEW_VIEWS in {finding.cause for finding in judge_result(result).findings}
    assert "Badly determined: fx = " in texts(result, Tone.FACT)
    said = [sentence.text for sentence in describe_calibration(result)]
    assert sum("tilted by" in text for text in said) == 1, said


def test_few_views_are_put_down_to_the_images_that_cannot_be_used() -> None:
    few = solved(everywhere()[:3], left_out=4)
    assert "4 of 7 images cannot be used" in texts(few, Tone.CAUTION)
    copies = [replace(view, enabled=False) for view in few.used] * 2
    assert "cannot be used" not in texts(replace(few, views=(*few.used, *copies)), Tone.CAUTION)


def test_an_empty_part_of_the_image_is_named() -> None:
    views = []
    for uv, xy, _ in everywhere():
        kept = (uv[:, 0] > 250) | (uv[:, 1] > 200)
        if np.count_nonzero(kept) > 12:
            views.append(Observation(uv[kept], xy[kept]))
    assert "image's upper left, where" in texts(solved(views), Tone.ADVICE)


def test_missing_tilt_is_named() -> None:
    rng = np.random.default_rng(1)
    poses = [scenes.looking(CAMERA, rng, tilt=(3.0, 9.0), fill=(0.4, 0.7)) for _ in range(9)]
    advice = texts(solved(scenes.seen(CAMERA, poses).views), Tone.ADVICE)
    assert "tilt the board by 30 to 45 degrees" in advice


def test_tilts_about_one_axis_are_named() -> None:
    rng = np.random.default_rng(1)
    poses = [scenes.looking(CAMERA, rng, towards=180.0 * (k % 2)) for k in range(9)]
    advice = texts(solved(scenes.seen(CAMERA, poses).views), Tone.ADVICE)
    assert "about another axis" in advice


def test_few_views_at_one_distance_are_named() -> None:
    rng = np.random.default_rng(4)
    poses = [scenes.looking(CAMERA, rng, fill=(0.6, 0.62)) for _ in range(5)]
    advice = texts(solved(scenes.seen(CAMERA, poses).views), Tone.ADVICE)
    assert "take more views: 5" in advice
    assert "different distances" in advice


def test_one_bad_view_is_named() -> None:
    views = everywhere(12)
    rng = np.random.default_rng(8)
    views[7] = Observation(views[7].uv + rng.normal(scale=1.0, size=views[7].uv.shape), views[7].xy)
    result = solved(views)
    assert find_outlying_views(result.calibration) == (7,)
    assert texts(result, Tone.CAUTION).count("7.png") == 1
    assert "Corners are not where the others say, in 7.png" in texts(result, Tone.CAUTION)
    assert "does not follow" not in texts(result, Tone.CAUTION)
    assert "/7.png" not in texts(result, Tone.CAUTION)  # its name is enough
    residuals = [replace(fit, image=0.01 * fit.image) for fit in result.calibration.residuals]
    tiny = replace(result.calibration, residuals=tuple(residuals))
    assert find_outlying_views(tiny) == ()


def test_an_unfinished_solve_is_named(good: Result) -> None:
    for status, words in ((Status.STOPPED, "was stopped"), (Status.MAX_ITERATIONS, "used up")):
        unfinished = replace(good, calibration=replace(good.calibration, status=status))
        assert words in texts(unfinished, Tone.CAUTION)


def test_a_coefficient_near_zero_is_named(good: Result) -> None:
    calibration = good.calibration
    params = calibration.camera.params.copy()
    params[6] = 0.5 * calibration.sigma[6]
    near = replace(calibration, camera=replace(calibration.camera, params=params))
    assert "These may be 0: k3 = " in texts(replace(good, calibration=near), Tone.FACT)


@pytest.mark.parametrize("scale", [4 / 3, 0.98])
def test_images_scaled_differently_across_and_down_are_named(scale: float) -> None:
    views = [Observation(view.uv * [1, scale], view.xy) for view in everywhere(10)]
    size = (640, round(480 * scale))
    result = solved(views, size=size)
    said = texts(result, Tone.CAUTION)
    [ratio] = re.findall(r"not square, fy/fx = ([\d.]+) ± ", said)
    assert float(ratio) == pytest.approx(scale, abs=1e-3)
    below = format_report(result).partition("Camera, ")[2]
    assert below.count("not square") == 1
    assert "as the camera writes them" in said
    assert "not square" not in texts(solved(views, size=size, fix=["fx"]), Tone.CAUTION)


def test_a_board_of_unequal_squares_is_no_camera_of_unequal_pixels(good: Result) -> None:
    assert "not square" not in texts(good, Tone.CAUTION)
    views = [Observation(view.uv, view.xy * [1, 1.01]) for view in everywhere(10)]
    result = solved(views)
    assert Cause.BOARD_SHAPE in {finding.cause for finding in judge_result(result).findings}
    assert "not square" not in texts(result, Tone.CAUTION)


def test_views_that_disagree_are_named(good: Result) -> None:
    result = replace(good, calibration=replace(good.calibration, overdispersion=3.0))
    assert "disagree about the camera 3.0 times" in texts(result, Tone.FACT)
