"""The tables of a calibration's report: the same in every layout.

A value has its standard uncertainty u and the expanded one U = k u with k = 2, which covers some
95 %; of both two digits are printed.
"""

from __future__ import annotations

import math
from itertools import islice

import numpy as np

from calibgui.dataset import Result
from calibgui.dataset.acceptance import measure_length
from calibgui.dataset.details import Details
from calibgui.dataset.limits import LengthLimit, Limits
from calibgui.engine.assessment import summarise_residuals
from calibgui.engine.camera import PINHOLE
from calibgui.report.boards import describe_board
from calibgui.report.coverage import measure_attitudes
from calibgui.report.document import Block, Facts, Paragraph, Picture, Pictures, Table
from calibgui.report.lens_models import get_lens_title
from calibgui.report.numbers import format_with_sigma

COVERAGE_FACTOR = 2.0
"""k of the expanded uncertainty: some 95 % of errors lie within."""
_MAX_TABULATED = 40
"""Number of parameters up to which all are listed; a splined lens has hundreds of them."""
_MAX_CORRELATED = 14
"""Number of parameters up to which their correlations are a table on one page."""


def tabulate_parameters(result: Result) -> list[Block]:
    """Tabulate the camera's parameters with u and U."""
    calibration = result.calibration
    camera = calibration.camera
    open_names = {each.name for each in calibration.undetermined}
    rows, count = [], _count_tabulated(result)
    values = zip(camera.names, camera.params.tolist(), calibration.sigma.tolist(), strict=True)
    for name, value, sigma in islice(values, count):
        unit = "px" if name in PINHOLE else ""
        if name in open_names or not sigma > 0:
            told = "undetermined" if name in open_names else "held"
            rows.append([name, f"{value:z.6g}", told, "", unit])
            continue
        number, u = _split(format_with_sigma(value, sigma))
        rows.append([name, number, u, _format_alike(COVERAGE_FACTOR * sigma, u), unit])
    freedom = _count_freedom(result)
    note = (
        f"u is one standard deviation and U = k u with k = {COVERAGE_FACTOR:g}, which covers some "
        f"95 %, at {freedom:,} degrees of freedom. Pixels are counted from 0 at the centre of the "
        "upper left one, u to the right and v down."
    )
    if count < len(camera.names):
        note += f" The other {len(camera.names) - count:,} parameters are in result.json."
    title = f"{get_lens_title(camera.model)} ({camera.model})"
    return [
        Paragraph(f"Lens model: {title}."),
        Table(
            ["Parameter", "Value", "u", f"U (k = {COVERAGE_FACTOR:g})", "Unit"], rows, (0, 4), note
        ),
    ]


def _count_tabulated(result: Result) -> int:
    """Count the parameters that are listed: all of them, or those of the pinhole alone."""
    names = result.calibration.camera.names
    return len(names) if len(names) <= _MAX_TABULATED else len(PINHOLE)


def _split(text: str) -> tuple[str, str]:
    """Return a value and its standard deviation as texts, each with the power of ten if any."""
    value, sigma = text.removeprefix("(").split(" ± ")
    if ")" not in sigma:
        return value, sigma
    sigma, power = sigma.split(")")
    return value + power, sigma + power


def _format_alike(value: float, text: str) -> str:
    """Format a value with the decimals and the power of ten of another one's text."""
    digits, _, power = text.partition("e")
    decimals = len(digits.partition(".")[2])
    scaled = value / 10.0 ** int(power or 0)
    return f"{scaled:.{decimals}f}{'e' + power if power else ''}"


def _count_freedom(result: Result) -> int:
    """Count the degrees of freedom: coordinates of corners less the parameters and the poses."""
    calibration = result.calibration
    coordinates = 2 * sum(len(view.image) for view in calibration.residuals)
    free = len(calibration.camera.params) - len(calibration.fixed)
    return coordinates - free - 6 * len(calibration.poses)


def state_uncertainty(result: Result) -> str:
    """State what U is, as a certificate has to."""
    return (
        "The reported expanded uncertainty U is the standard uncertainty u multiplied by the "
        f"coverage factor k = {COVERAGE_FACTOR:g}, which for a normal distribution corresponds to "
        "a coverage probability of approximately 95 %. The standard uncertainty was evaluated by "
        "statistical analysis (type A) of the corners' scatter and of the views' disagreement, "
        f"with {_count_freedom(result):,} degrees of freedom, and by other means (type B) for the "
        "board's shape and scale."
    )


def tabulate_budget(result: Result) -> list[Block]:
    """Tabulate what the standard uncertainty of each parameter consists of."""
    calibration = result.calibration
    rows = []
    values = zip(
        calibration.camera.names,
        calibration.sigma.tolist(),
        calibration.sigma_by_noise.tolist(),
        strict=True,
    )
    for name, sigma, noise in islice(values, _count_tabulated(result)):
        if sigma > 0:
            others = math.sqrt(max(sigma**2 - noise**2, 0.0))
            share = min(noise**2 / sigma**2, 1.0)
            parts = [f"{part:.2g}".replace("e-0", "e-") for part in (noise, others, sigma)]
            rows.append([name, *parts, f"{share:.0%}"])
    scale = result.scale_sigma
    board = result.board
    note = (
        "Board, lens and views: the board's shape as far as it is not known, the lens model's "
        "error, and what views disagree by beyond noise. "
    ) + (
        "The board's scale enters no parameter here, and every length: "
        + (
            f"{board.square:g} mm with u = {board.square_sigma:.2g} mm, {100 * scale:.2g} %."
            if board is not None and scale
            else "it counts as exact."
        )
    )
    head = ["Parameter", "Corners' noise", "Board, lens and views", "u", "Share of noise in u²"]
    return [Table(head, rows, (0,), note)] if rows else []


def tabulate_lengths(result: Result) -> list[Block]:
    """Tabulate how certain a length is: that of the limits, or 100 mm at the boards' distance."""
    limits = result.limits
    if limits is None or limits.length is None:
        distance = float(
            np.median(measure_attitudes(result.calibration, result.observations()).distance)
        )
        limits = Limits(length=LengthLimit(math.inf, 100.0, float(f"{distance:.2g}")))
    found = measure_length(result, limits)
    if found is None:
        return []
    k = found.worst
    parts = [found.by_calibration[k], found.by_noise[k], found.by_scale, found.sigma[k]]
    condition = f", {result.condition}" if result.condition else ""
    note = (
        f"A length of {found.length:g} mm, measured by its two ends {found.depth:g} mm away in a "
        f"plane across the axis, where it is known worst{condition}. The distance counts as known."
    )
    head = ["Length", "Calibration", "Two corners", "Board's scale", "u", "U (k = 2)"]
    cells = [f"{part:.2g} mm" for part in parts]
    cells.append(f"{COVERAGE_FACTOR * parts[-1]:.2g} mm")
    return [Table(head, [[f"{found.length:g} mm at {found.depth:g} mm", *cells]], (0,), note)]


def tabulate_board(result: Result, details: Details) -> Facts:
    """List what is known of the board, with its own certificate."""
    board = result.board
    rows = []
    if board is not None:
        scale = f"{board.square:g} mm"
        if board.square_sigma:
            scale = f"{format_with_sigma(board.square, board.square_sigma)} mm (one sigma)"
        else:
            scale += ", counted as exact"
        if not result.lengths_confirmed:
            scale += ", not confirmed"
        rows = [("Board", describe_board(board)), ("Square or distance", scale)]
    shape = result.calibration.board_shape
    if shape is None:
        error = result.calibration.board_shape_error
        rows.append(
            ("Shape", f"as drawn{f', to {error:.2g} mm rms by the residuals' if error else ''}")
        )
    else:
        rows.append(("Shape", f"{shape.model}, deviates by {shape.rms:.2g} mm rms"))
    rows.append(("Identification", details.board or "not stated"))
    rows.append(("Its own certificate", details.board_certificate or "not stated"))
    return Facts(rows)


def describe_method(result: Result) -> list[Block]:
    """Say how the calibration was made."""
    calibration = result.calibration
    settings = calibration.settings
    facts = [
        (
            "Procedure",
            "Photographs of a flat board in several attitudes; all corners adjusted "
            "together (bundle adjustment) after Lucchese 2005",
        ),
        ("Method", str(settings.method)),
        ("Cost", str(calibration.cost)),
        ("Lens model", get_lens_title(calibration.camera.model)),
        ("Why this lens model", settings.model_reason or ""),
        ("Held", ", ".join(calibration.fixed) or "nothing"),
        ("End of the adjustment", f"{calibration.status}, {len(calibration.history)} iterations"),
        ("Program", ", ".join(f"{name} {text}" for name, text in result.versions.items())),
    ]
    return [Facts([fact for fact in facts if fact[1]])]


def tabulate_residuals(result: Result, figure: Picture | None) -> list[Block]:
    """Tabulate what is left between corners and their predictions, with a figure of the views."""
    fit = summarise_residuals(result.calibration.residuals)
    facts = Facts(
        [
            ("RMS", f"{fit.rms:.4f} px"),
            ("σ along u, along v", f"{fit.sigma_x:.4f}, {fit.sigma_y:.4f} px"),
            (
                "σ of the median view",
                f"{fit.median_sigma_x:.4f}, {fit.median_sigma_y:.4f} px",
            ),
            ("Number of corners", f"{fit.count:,}"),
        ]
    )
    return [facts] if figure is None else [facts, Pictures([figure], columns=1)]


def tabulate_correlations(result: Result) -> list[Block]:
    """Tabulate the correlations of the parameters that were estimated."""
    calibration = result.calibration
    free = [k for k, sigma in enumerate(calibration.sigma.tolist()) if sigma > 0]
    names = [calibration.camera.names[k] for k in free]
    if not free or len(free) > _MAX_CORRELATED:
        return [Paragraph("There are too many parameters for a table: they are in result.json.")]
    covariance = calibration.covariance[np.ix_(free, free)]
    sigma = np.sqrt(np.diag(covariance))
    values = covariance / np.outer(sigma, sigma)
    rows = [
        [name, *(f"{value:z.2f}" for value in row[: k + 1]), *[""] * (len(free) - k - 1)]
        for k, (name, row) in enumerate(zip(names, values.tolist(), strict=True))
    ]
    return [Table(["", *names], rows, is_fine=True)]


def tabulate_poses(result: Result) -> Table:
    """Tabulate where the board was, with one standard deviation."""
    rows = []
    numbers = [k + 1 for k in result.places]
    for number, pose, covariance in zip(
        numbers, result.calibration.poses, result.pose_covariances, strict=True
    ):
        sigma = np.sqrt(np.diag(covariance))
        place = map(format_with_sigma, pose.tvec.tolist(), sigma[3:].tolist())
        turn = map(
            format_with_sigma, np.degrees(pose.rvec).tolist(), np.degrees(sigma[:3]).tolist()
        )
        rows.append([str(number), *place, *turn])
    head = ["No.", "X, mm", "Y, mm", "Z, mm", "ωX, °", "ωY, °", "ωZ, °"]
    condition = f" Lengths hold {result.condition}." if result.condition else ""
    note = (
        "The board's first corner in the camera's frame (X right, Y down, Z ahead) and the "
        f"rotation vector, ± one standard deviation.{condition}"
    )
    return Table(head, rows, (), note, is_fine=True)
