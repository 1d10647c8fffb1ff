"""Tables that fit a terminal, name their units and hide nothing."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from calibgui import engine
from calibgui.app.calibrating.calibration import calibrate_views
from calibgui.app.calibrating.settings import Settings
from calibgui.dataset import CornerSet, Result, View, ViewStatus
from calibgui.engine.assessment import summarise_residuals
from calibgui.engine.boards import BoardShape, BoardShapeModel, Circles
from calibgui.engine.boards.board import Board
from calibgui.engine.boards.pattern import Symmetry
from calibgui.engine.calibration.result import Cost, Undetermined
from calibgui.engine.features.corners import Corners, OtherBoard
from calibgui.report import tables
from calibgui.report.summary import describe_calibration
from calibgui.report.verdict import describe_fit
from tests.engine import scenes

BOARD = Board(rows=8, cols=11, square=30.0)


def calibrated(ambiguity: Symmetry = Symmetry.NONE, cost: Cost = Cost.IMAGE) -> Result:
    """Eight views with noise, one image switched off and one without a board."""
    rng = np.random.default_rng(2)
    camera = scenes.barrel()
    poses = [scenes.looking(camera, rng, board=BOARD) for _ in range(8)]
    views = []
    for k, seen in enumerate(scenes.seen(camera, poses, BOARD).noisy(0.1, rng)):
        grid = np.rint(seen.xy[:, ::-1] / BOARD.square)
        found = Corners((8, 11), grid, seen.uv, seen.uv, ambiguity=ambiguity)
        views.append(View(f"folder/view{k}.png", ViewStatus.FOUND, corners=found))
    views[2] = replace(views[2], enabled=False)
    blank = View("folder/blank.png", ViewStatus.NO_BOARD, "No checkerboard was found. " * 5)
    return calibrate_views(CornerSet(camera.size, (*views, blank), BOARD), Settings(cost=cost))


@pytest.fixture(scope="module")
def result() -> Result:
    return calibrated()


def lines(table: str) -> list[str]:
    found = table.splitlines()
    assert max(map(len, found)) <= tables.WIDTH_CHARACTERS
    assert not any(line != line.rstrip() for line in found)
    return found


@pytest.mark.parametrize("cost", list(Cost))
def test_everything_fits_the_terminal(cost: Cost) -> None:
    report = tables.format_report(calibrated(cost=cost), verbose=True)
    assert max(map(len, report.splitlines())) <= tables.WIDTH_CHARACTERS
    assert ("its own SD" in report) == (cost is Cost.PAPER)


def test_table_1_counts_views_as_they_are_listed(result: Result) -> None:
    title, head, units, *rows = lines(tables.tabulate_stage_one(result))
    assert "Table 1" in title
    assert head.split()[:4] == ["view", "xp", "yp", "k1"]
    assert "px^-2" in units
    assert [row.split()[0] for row in rows] == ["1", "2", "4", "5", "6", "7", "8", "mean"]
    stage_one = result.calibration.stage_one
    assert float(rows[0].split()[1]) == pytest.approx(stage_one[0].xp, abs=1e-4)
    mean = np.mean([row.k1 for row in stage_one]) * 1e7
    assert float(rows[-1].split()[3]) == pytest.approx(mean, abs=1e-4)


def test_what_a_view_does_not_determine_is_not_printed_as_a_number(result: Result) -> None:
    rows = list(result.calibration.stage_one)
    rows[0] = replace(rows[0], aspect=np.nan, fx=np.nan, fy=np.nan)
    calibration = replace(result.calibration, stage_one=tuple(rows))
    table = tables.tabulate_stage_one(replace(result, calibration=calibration))
    assert table.splitlines()[3].split()[4:7] == ["-", "-", "-"]
    assert "nan" not in table


def test_views_show_fit_and_attitude(result: Result) -> None:
    _, _, units, *rows = lines(tables.tabulate_views(result))
    assert units.split() == ["px", "mm", "deg"]
    number, image, corners, rms, *_ = rows[2].split()
    assert (number, image, corners) == ("4", "view3.png", "88")
    assert float(rms) == pytest.approx(result.calibration.residuals[2].rms, abs=1e-3)


def test_a_long_name_is_shortened_in_its_middle(result: Result) -> None:
    views = list(result.views)
    views[0] = replace(views[0], image="a" * 40 + "b" * 40 + ".png")
    row = lines(tables.tabulate_views(replace(result, views=tuple(views))))[3]
    assert "aa..bb" in row and ".png" in row


def test_every_image_left_out_has_its_reason(result: Result) -> None:
    text = " ".join(" ".join(lines(tables.list_unused_views(result.views))).split())
    assert "view2.png: By choice." in text
    assert "blank.png: No checkerboard was found. No checkerboard" in text
    assert tables.list_unused_views([view for view in result.views if view.usable]) == ""


def test_images_left_out_for_the_same_reason_share_it() -> None:
    reason = "This board has 7 x 10 inner corners, not 6 x 9."
    views = [View(f"a/{k}.png", ViewStatus.NO_BOARD, reason) for k in range(14)]
    views.append(View("a/dark.png", ViewStatus.NO_BOARD, "Too dark."))
    views.append(View("a/bent.png", ViewStatus.FOUND, "Left out: it does not fit.", enabled=False))
    assert lines(tables.list_unused_views(views)) == [
        "Left out",
        "  0.png, 1.png, 2.png, 3.png, 4.png, 5.png, and 8 more: This board has 7 x 10",
        "    inner corners, not 6 x 9.",
        "  dark.png: Too dark.",
        "  bent.png: it does not fit.",
    ]


def test_the_report_is_short_and_begins_with_the_verdict(result: Result) -> None:
    report = lines(tables.format_report(result))
    verdict = describe_calibration(result)[0].text
    assert report[0] == verdict
    camera = report.index(next(line for line in report if line.startswith("Camera, ")))
    rms = report.index(next(line for line in report if line.startswith("RMS 0.")))
    assert camera < rms == len(report) - 1 <= 25
    names = ["fx", "fy", "cx", "cy"]
    assert [line.split()[0] for line in report[camera + 1 : camera + 5]] == names
    fit = summarise_residuals(result.calibration.residuals)
    assert f"px, σx {fit.sigma_x:.3f}, σy {fit.sigma_y:.3f} px; " in report[rms]
    assert "88" not in report[rms] and "616 corners, 7 of 9 images" in report[rms]
    long = tables.format_report(result, verbose=True)
    assert long.startswith(verdict)
    for title in ("Views\n", "Stage I, each view", "Residuals of", "paper's frame"):
        assert title in long and title not in "\n".join(report)


def test_circles_are_called_circles(result: Result) -> None:
    assert result.board is not None
    circles = replace(result, board=replace(result.board, pattern=Circles(False, 0.5)))
    assert "616 circles, 7 of 9 images" in tables.describe_rms(circles)
    assert "Residuals of 616 circles" in tables.describe_residuals(circles)
    assert "circles" in tables.tabulate_views(circles) and "corners" in tables.tabulate_views(
        result
    )
    assert describe_fit(circles).endswith("px of 616 circles")
    assert any("7 views with 616 circles" in said.text for said in describe_calibration(circles))


def test_the_report_says_what_was_left_out_and_done_with_the_board(result: Result) -> None:
    assert "outlier" not in tables.describe_rms(result) and "board" not in tables.describe_rms(
        result
    )
    points = BOARD.points()
    deviation = np.full((len(points), 3), 0.1)
    shape = BoardShape(BoardShapeModel.FREE, points, deviation, np.zeros_like(deviation))
    told = []
    for outliers, is_held in ((0, False), (12, True)):
        stated = result.calibration.settings
        settings = replace(stated, outliers=outliers, is_board_shape_held=is_held)
        calibration = replace(result.calibration, board_shape=shape, settings=settings)
        changed = replace(result, calibration=calibration)
        told.append(tables.describe_rms(changed))
        words = " ".join(said.text for said in describe_calibration(changed))
        assert ("shape is held as it was given" in words) == is_held
        assert ("12 corners left out as outliers" in words) == (outliers == 12)
    assert told[0].endswith(
        "board shape estimated (free), 0.17 mm rms off the drawing; no outliers to leave out"
    )
    assert "board shape held as given (free)" in told[1]
    assert told[1].endswith("; 12 corners left out as outliers")


def test_the_hundreds_of_parameters_of_a_spline_are_counted(
    result: Result, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert "k2  " in tables.tabulate_camera(result.calibration)
    monkeypatch.setattr(tables, "_MAX_COEFFICIENTS", 5)
    table = tables.tabulate_camera(result.calibration)
    assert "fx  " in table and "and 6 parameters of the lens model lucchese" in table
    assert "k2  " not in table


def test_no_number_is_minus_zero(result: Result) -> None:
    rows = [replace(row, xp=-1e-9) for row in result.calibration.stage_one]
    calibration = replace(result.calibration, stage_one=tuple(rows))
    assert "-0.0000" not in tables.tabulate_stage_one(replace(result, calibration=calibration))


def test_a_long_path_can_be_copied() -> None:
    path = "/a" + 50 * "/b" + "/view.png"
    view = View(path, ViewStatus.UNREADABLE, f"{path} is not an image.")
    assert f"{path} is not" in " ".join(tables.list_unused_views([view]).split())


def test_intrinsics_have_their_uncertainty_in_both_frames(result: Result) -> None:
    calibration = result.calibration
    _, head, *rows = lines(tables.tabulate_intrinsics(calibration))
    assert "OpenCV's frame" in head and "paper's frame" in head
    fx = rows[0].split()
    assert float(fx[1]) == pytest.approx(calibration.camera.params[0], abs=0.01)
    assert fx[2] == "±" and fx[4] == "px" and fx[5] == "fx" and fx[9] == "px"
    names = [row.split()[0] for row in rows]
    assert names == ["fx", "fy", "cx", "cy", "k1", "k2", "k3", "p1", "p2", "p3"]
    # The principal point stands beside the paper's.
    assert rows[2].split()[5] == "xp" and rows[3].split()[5] == "yp"
    assert "0 (held)" in rows[-1]


def test_an_undetermined_parameter_shows_no_number(result: Result) -> None:
    calibration = result.calibration
    sigma = np.array(calibration.sigma)
    sigma[6] = np.nan
    lost = (Undetermined("k3", "it can be traded for the boards' poses"),)
    table = tables.tabulate_intrinsics(replace(calibration, sigma=sigma, undetermined=lost))
    assert table.splitlines()[8].split() == ["k3", "not", "determined", "k3", "not", "determined",
                                             "px^-6"]  # fmt: skip


def test_another_lens_model_has_no_paper_column() -> None:
    rng = np.random.default_rng(3)
    scene = scenes.scene(scenes.brown(), 6)
    views = tuple(
        View(f"{k}.png", ViewStatus.FOUND, points=seen)
        for k, seen in enumerate(scene.noisy(0.1, rng))
    )
    calibration = engine.calibrate(scene.noisy(0.1, rng), scene.size, model="brown-conrady")
    assert "paper" not in tables.tabulate_intrinsics(calibration)
    assert (
        max(map(len, tables.format_report(Result(calibration, views)).splitlines()))
        <= tables.WIDTH_CHARACTERS
    )


def test_rms_comes_with_sigma_and_count(result: Result) -> None:
    text = "\n".join(lines(tables.describe_residuals(result)))
    for words in ("616 corners in 7 views", "rms 0.1", "sigma_x 0.", "sigma_y 0.", "mean e' 0."):
        assert words in text
    assert "converged after" in text


def test_a_symmetric_board_is_explained() -> None:
    assert tables.describe_symmetry(calibrated().used) == []
    (text,) = tables.describe_symmetry(calibrated(Symmetry.HALF_TURN).used)
    assert "half turn" in text
    (text,) = tables.describe_symmetry(calibrated(Symmetry.QUARTER_TURN).used)
    assert "quarter turn" in text


def test_the_truth_stands_beside_what_was_found(result: Result) -> None:
    calibration = result.calibration
    names = ("fx", "fy", "cx", "cy", "k1", "k2", "k3", "p1", "p2", "p3")
    truth = dict(zip(names, map(float, scenes.barrel().params), strict=True))
    _, _, *rows = lines(tables.tabulate_errors(calibration, truth))
    error = (calibration.camera.params[0] - truth["fx"]) / calibration.sigma[0]
    assert float(rows[0].split()[-1]) == pytest.approx(error, abs=0.06)


def test_detection_lists_every_image(result: Result) -> None:
    table = tables.tabulate_detection(result.views)
    assert "no-board" in table and "8 x 11" in table
    assert "The board was found in 8 of 9 images." in table
    assert max(map(len, table.splitlines())) <= tables.WIDTH_CHARACTERS


def test_a_search_for_circles_counts_circles(result: Result) -> None:
    table = tables.tabulate_detection(result.views, Board(8, 11, 20.0, Circles()))
    assert "circles" in table and "corners" not in table


def test_a_chosen_lens_model_is_named_as_options(result: Result) -> None:
    calibration = replace(
        result.calibration,
        settings=replace(result.calibration.settings, model_reason="It is wanted."),
        fixed=(*result.calibration.fixed, "k3"),
    )
    text = " ".join(tables.tabulate_camera(calibration).split())
    value = calibration.camera.params[calibration.camera.names.index("k3")]
    assert f"It is wanted. That is --model lucchese --fix k3={value:g}." in text


def test_detection_tells_further_boards() -> None:
    outline = np.array([[100.0, 50], [180, 50], [180, 110], [100, 110]])
    uv = np.zeros((2, 2))
    corners = Corners((6, 9), [[0, 0], [0, 1]], uv, uv, others=(OtherBoard((4, 5), outline),))
    table = tables.tabulate_detection([View("a.png", ViewStatus.FOUND, corners=corners)])
    assert "a.png shows further boards: 4 x 5 inner corners around (140, 80)." in " ".join(
        table.split()
    )
