"""A rig in words for a terminal of 80 columns."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import assert_never

import numpy as np

from calibgui.dataset import RigPairing, RigResult, relate_cameras
from calibgui.engine.arrays import Array
from calibgui.engine.camera import find_model
from calibgui.engine.geometry import Pose
from calibgui.engine.rig import (
    Mistake,
    PointUncertainty,
    Rig,
    RigMistake,
    StereoPair,
    TriangulatedPoints,
    estimate_point_uncertainty,
    rectify_pair,
)
from calibgui.report.names import shorten_name
from calibgui.report.numbers import format_count, format_with_sigma
from calibgui.report.tables import align_columns, fill_lines, format_bullet

_MAX_NAMES = 8
"""Number of photographs that are named, at most, of those that are left over."""


_MAX_POINTS = 30
"""Number of points in space, at most, that are printed."""


def describe_pairing(pairing: RigPairing) -> str:
    """Describe which photographs are of which camera, and how many instants they share."""
    counts = ", ".join(f"{camera.name} ({len(camera.files)})" for camera in pairing.cameras)
    first = pairing.shared[0]
    example = ", ".join(
        camera.files[first].name for camera in pairing.cameras if first in camera.files
    )
    text = (
        f"Photographs of {len(pairing.cameras)} cameras: {counts}. Paired by their {pairing.how}: "
        f"{format_count(len(pairing.shared), 'instant')} of several cameras, the first {example}."
    )
    if left := pairing.left_over:
        text += f" Without a partner: {list_names([file.name for file in left])}."
    return text


def list_names(names: Sequence[str]) -> str:
    """List names, the first of many only."""
    shown = ", ".join(map(shorten_name, names[:_MAX_NAMES]))
    more = len(names) - _MAX_NAMES
    return shown + (f" and {more} more" if more > 0 else "")


def format_rig(result: RigResult) -> str:
    """Format a rig: how well the cameras agree, how they stand, and how well points are located."""
    remarks = [
        *describe_offsets(result.rig),
        *describe_disagreement(result),
        *(describe_mistake(result, mistake) for mistake in result.rig.mistakes),
        *describe_turned(result),
        *result.remarks,
    ]
    parts = [
        fill_lines(describe_fit(result.rig), "", "  "),
        "\n".join(map(format_bullet, remarks)),
        tabulate_cameras(result.rig),
        tabulate_poses(result),
        tabulate_boards(result),
        tabulate_points(result.rig),
    ]
    return "\n\n".join(filter(None, parts))


def describe_fit(rig: Rig) -> str:
    """Describe in a sentence how well the cameras agree."""
    instants = len({view.instant for view in rig.views})
    start = (
        f"{len(rig.cameras)} cameras at {format_count(instants, 'instant')}: together they leave "
        f"{rig.rms:.3g} px, each alone {rig.rms_alone:.3g} px"
    )
    if not rig.disagreement:
        return f"{start}. They agree."
    return f"{start}, {rig.rms / max(rig.rms_alone, 1e-300):.2g} times less. The instants disagree."


def describe_disagreement(result: RigResult) -> list[str]:
    """Say by how many mm single instants disagree about where the cameras stand."""
    rig = result.rig
    if not rig.disagreement:
        return []
    sentences = [
        f"Single instants have {rig.names[pair.second]} {pair.scatter:.2g} mm from where most have "
        f"it beside {rig.names[pair.first]}; the corners' noise explains {pair.noise_scatter:.2g} "
        "mm."
        for pair in rig.pairs
    ]
    return [
        *sentences,
        "Photographs of one instant were not taken at quite the same moment, or the board bends in "
        "the hand. Each ± counts it: put the board down for each picture, or trigger the cameras "
        "together.",
    ]


def describe_offsets(rig: Rig) -> list[str]:
    """Say by how much each camera is late, where that was estimated."""
    return [
        describe_offset(rig.names[c], rig.names[0], late, rig.offset_sigma(c))
        for c, late in enumerate(rig.offsets.tolist())
        if rig.offset_sigma(c) > 0
    ]


def describe_offset(name: str, other: str, late: float, sigma: float) -> str:
    """Say by how many s a camera is later than another one, with the standard deviation."""
    amount = format_with_sigma(1000 * abs(late), 1000 * sigma)
    return f"{name} is {amount} ms {'later' if late > 0 else 'earlier'} than {other}."


def describe_mistake(result: RigResult, mistake: RigMistake) -> str:
    """Describe in sentences what is wrong with some views, and what to do about it."""
    rig, value = result.rig, mistake.value
    name, other = rig.names[mistake.camera], rig.names[mistake.other]
    named = list_names([_name_photograph(result, mistake.camera, i) for i in mistake.instants])
    match mistake.kind:
        case Mistake.SHIFTED:
            count, side = abs(int(value)), "earlier" if value < 0 else "later"
            return (
                f"The photographs of {name} belong to those of {other} of "
                f"{format_count(count, 'instant')} {side}: nothing above holds. Pair them so."
            )
        case Mistake.EXCHANGED:
            return (
                f"Exchanged with those of {other}: {named}. They are left out; give them back "
                "their names."
            )
        case Mistake.OTHER_SCALE:
            return (
                f"The squares were counted {value:.3g} times as long as in the others in {named}, "
                f"and the photographs of {other} beside them. They are left out: is that another "
                "board, or another --square?"
            )
        case Mistake.MOVED:
            first = _name_photograph(result, mistake.camera, mistake.instants[0])
            return (
                f"{name} stands {value:.2g} mm otherwise beside {other} from {first} on. "
                "Calibrate the photographs before and after it by themselves."
            )
        case Mistake.BOARDS_MOVED:
            first = _name_photograph(result, mistake.camera, mistake.instants[0])
            return (
                f"The boards stand {value:.2g} mm otherwise to each other from {first} on. Fasten "
                "them, or calibrate the photographs before and after it by themselves."
            )
        case Mistake.REFOCUSED:
            first = _name_photograph(result, mistake.camera, mistake.instants[0])
            return (
                f"The focal length of {name} is {value:.4g} times as long from {first} on: it was "
                "refocused or zoomed. Calibrate the photographs before and after it by themselves."
            )
        case Mistake.OTHER_INSTANT:
            return (
                "Left out, as the board is elsewhere than in the other cameras' photographs of the "
                f"instant: {named}. Were they taken at another instant?"
            )
        case Mistake.LESS_AGREEMENT:
            return f"Those that agree least with the other cameras: {named}."
        case never:
            assert_never(never)


def _name_photograph(result: RigResult, camera: int, instant: int) -> str:
    """Name the photograph of a camera at an instant, or the instant if it has none."""
    image = result.images.get((camera, instant))
    return result.instants[instant] if image is None else Path(image).name


def describe_turned(result: RigResult) -> list[str]:
    """Name the photographs in which the board was counted from another end, and is turned back."""
    turned = [view for view in result.rig.views if view.turned]
    if not turned:
        return []
    named = [Path(result.images[view.camera, view.instant]).name for view in turned]
    return [f"Counted from another end of the board, and turned back: {list_names(named)}."]


def tabulate_cameras(rig: Rig) -> str:
    """Tabulate the cameras, each with its focal length, centre and residuals."""
    rows = [["camera", "fx, px", "cx, px", "cy, px", "rms, px"]]
    lenses = []
    for c, camera in enumerate(rig.cameras):
        sigma = rig.camera_sigma(c)
        values = (format_with_sigma(camera.params[i], sigma[i]) for i in (0, 2, 3))
        rows.append([rig.names[c], *values, f"{rig.camera_rms(c):.3f}"])
        lenses.append(f"{rig.names[c]} {find_model(camera.model).short_title}")
    lens = fill_lines(f"Lens models: {', '.join(lenses)}.", "  ", "    ")
    return f"{align_columns(rows, left=(0,))}\n{lens}"


def tabulate_poses(result: RigResult) -> str:
    """Tabulate how the cameras stand to the first one."""
    rig = result.rig
    rows = [["camera", "", "X", "Y", "Z", "length"]]
    for c in range(1, len(rig.cameras)):
        pose, sigma = rig.poses[c], rig.pose_sigma(c)
        place, turn = _format_pose(pose, sigma)
        rows.append([rig.names[c], "mm", *place, format_with_sigma(*measure_distance(rig, c))])
        rows.append(["", "deg", *turn, format_with_sigma(*measure_turn(rig, c))])
    condition = f", {result.condition}" if result.condition else ""
    title = f"Translation and rotation vector from {rig.names[0]}{condition}"
    return f"{title}\n{align_columns(rows, left=(0, 1))}"


def _format_pose(pose: Pose, sigma: Array) -> tuple[list[str], list[str]]:
    """Format translation, mm, and rotation vector, degrees, with standard deviations (6,)."""
    place = map(format_with_sigma, pose.tvec.tolist(), sigma[3:].tolist())
    turn = map(format_with_sigma, np.degrees(pose.rvec).tolist(), np.degrees(sigma[:3]).tolist())
    return list(place), list(turn)


def tabulate_boards(result: RigResult) -> str:
    """Tabulate how several boards stand to each other, and how far those of unknown shape are from
    their drawings."""
    rig, boards = result.rig, result.rig.placed_boards
    parts = []
    if len(boards) > 1:
        rows = [["board", "beside", "", "X", "Y", "Z"]]
        for b, board in enumerate(boards):
            if board.reference == b:
                continue
            place, turn = _format_pose(board.pose, rig.board_sigma(b))
            rows.append([board.name, boards[board.reference].name, "mm", *place])
            rows.append(["", "", "deg", *turn])
        title = "Translation and rotation vector of boards"
        if len(rows) > 1:
            parts.append(f"{title}\n{align_columns(rows, left=(0, 1, 2))}")
    parts += [fill_lines(sentence, "", "  ") for sentence in describe_boards(rig)]
    return "\n".join(parts)


def describe_boards(rig: Rig) -> list[str]:
    """Say which boards' places are open, and how far those of unknown shape are from their
    drawings."""
    boards = rig.placed_boards
    sentences = []
    if apart := [board.name for b, board in enumerate(boards) if b and board.reference == b]:
        sentences.append(
            f"Where {list_names(apart)} stands beside {boards[0].name} is open: no two cameras "
            "saw them at one instant. Nothing else depends on it."
        )
    return sentences + [
        f"{board.name[:1].upper()}{board.name[1:]} deviates from its drawing by "
        f"{board.shape.rms:.2g} mm rms, at most "
        f"{np.linalg.norm(board.shape.deviation, axis=1).max():.2g} mm."
        for board in boards
        if board.shape is not None
    ]


def measure_distance(rig: Rig, c: int) -> tuple[float, float]:
    """Measure how far camera `c` is from the first one, mm, with its standard deviation."""
    return _measure_length(rig, rig.layout.pose(c).start + 3, rig.poses[c].tvec)


def measure_turn(rig: Rig, c: int) -> tuple[float, float]:
    """Measure the angle of camera `c` to the first one, degrees, with its standard deviation."""
    return _measure_angle(rig, rig.layout.pose(c).start, rig.poses[c].rvec)


def measure_board_distance(rig: Rig, b: int) -> tuple[float, float]:
    """Measure how far board `b` is from the one that it is beside, origin to origin, mm, with its
    standard deviation."""
    return _measure_length(rig, rig.layout.board(b).start + 3, rig.placed_boards[b].pose.tvec)


def measure_board_turn(rig: Rig, b: int) -> tuple[float, float]:
    """Measure the angle of board `b` to the one that it is beside, degrees, with its standard
    deviation."""
    return _measure_angle(rig, rig.layout.board(b).start, rig.placed_boards[b].pose.rvec)


def _measure_angle(rig: Rig, start: int, rvec: Array) -> tuple[float, float]:
    """Return the angle of a rotation, degrees, and its standard deviation."""
    angle, sigma = _measure_length(rig, start, rvec)
    return float(np.degrees(angle)), float(np.degrees(sigma))


def _measure_length(rig: Rig, start: int, vector: Array) -> tuple[float, float]:
    """Return the length of a vector whose parameters begin at `start`, and its standard
    deviation."""
    block = rig.covariance[start : start + 3, start : start + 3]
    length = float(np.linalg.norm(vector))
    return length, float(np.sqrt(vector @ block @ vector)) / length if length else 0.0


def tabulate_points(rig: Rig) -> str:
    """Tabulate how well points ahead of the rig are located."""
    sigma = rig.rms_alone / 2**0.5
    points = [each for each in estimate_point_uncertainty(rig, sigma) if each.cameras > 1]
    if not points:
        return ""
    rows = [["distance, mm", "cameras", "± along, mm", "± across, mm", "by the calibration"]]
    rows += [_format_point(each) for each in points]
    title = f"Points ahead, seen with pixels of ± {sigma:.2g} px"
    return f"{title}\n{align_columns(rows)}"


def _format_point(point: PointUncertainty) -> list[str]:
    return [
        f"{point.distance:.0f}",
        str(point.cameras),
        f"{point.along:.2g}",
        f"{point.across:.2g}",
        f"{100 * point.share_of_calibration:.0f} %",
    ]


def tabulate_space_points(
    names: Sequence[str], found: TriangulatedPoints, result: RigResult, sigma: float
) -> str:
    """Tabulate points in space, with one standard deviation."""
    rows = [["point", "X, mm", "Y, mm", "Z, mm", "rms, px", "by the calibration"]]
    for k, name in enumerate(names[:_MAX_POINTS]):
        if np.isfinite(found.points[k]).all():
            place = map(format_with_sigma, found.points[k].tolist(), found.sigma[k].tolist())
            share = np.trace(found.by_calibration[k]) / np.trace(found.covariance[k])
            rows.append([name, *place, f"{found.rms[k]:.2f}", f"{100 * share:.0f} %"])
        else:
            rows.append([name, *["-"] * 5])
    more = len(names) - _MAX_POINTS
    condition = f", {result.condition}" if result.condition else ""
    title = f"Points in the frame of {result.rig.names[0]}, pixels of ± {sigma:.2g} px{condition}"
    return f"{title}\n{align_columns(rows, left=(0,))}" + (
        f"\n  and {more:,} more" if more > 0 else ""
    )


def describe_stereo(
    pair: StereoPair, error: float | None, depths: Sequence[float] | None = None
) -> str:
    """Describe a rectified pair: how well rows agree, and how far its points move."""
    what = "columns" if pair.is_upright else "rows"
    agreement = "They never see a corner together"
    if error is not None:
        agreement = f"The {what} of the same corners differ by {error:.2g} px rms"
    text = f"{agreement}; the cameras are {pair.baseline:.4g} mm apart."
    if depths is None or pair.ideal[0].is_angular:
        return text
    near, far = sorted(depths)
    least, most = sorted(map(pair.compute_disparity, (far, near)))
    where = f"Points {near:g} to {far:g} mm away"
    return f"{text} {where} have disparities of {least:.1f} to {most:.1f} px."


def measure_row_error(result: RigResult, first: int, second: int) -> float | None:
    """Measure the rms difference, px, of the rows of the same corners in rectified images; None if
    the cameras never see a corner together.

    Raises:
        CalibrationError: if the pair cannot be rectified.
    """
    pair = rectify_pair(*relate_cameras(result.rig, first, second))
    errors = []
    kept = {(view.camera, view.board, view.instant) for view in result.rig.views if not view.turned}
    for camera, board, instant in sorted(kept):
        if camera != first or (second, board, instant) not in kept:
            continue
        a, b = (result.observations[c, board, instant] for c in (first, second))
        place = {tuple(xy): k for k, xy in enumerate(b.xy.round(6).tolist())}
        shared = [
            (k, place[tuple(xy)])
            for k, xy in enumerate(a.xy.round(6).tolist())
            if tuple(xy) in place
        ]
        if shared:
            in_a, in_b = np.array(shared).T
            errors.append(pair.measure_row_errors(a.uv[in_a], b.uv[in_b]))
    if not errors:
        return None
    return float(np.sqrt(np.nanmean(np.concatenate(errors) ** 2)))
