"""Tables that set the numbers printed in the paper beside ours."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from calibgui.dataset import Result
from calibgui.engine.arrays import Array
from calibgui.engine.assessment import summarise_residuals
from calibgui.engine.calibration import Calibration, make_paper_table
from calibgui.engine.geometry import PAPER_NAMES
from calibgui.report import printed_values
from calibgui.report.document import Table
from calibgui.report.figures import EXTRINSIC_NAMES, LOCATED_BY
from calibgui.report.numbers import format_with_sigma
from calibgui.report.paper_stage_one import StageOneEvidence

_UNITS = ("px", "px", "px⁻²", "px⁻⁴", "px⁻⁶", "px⁻¹", "px⁻¹", "px⁻²", "px", "px")
_STAGE_ONE_UNITS = np.array([1.0, 1.0, 1e-7])
"""Units of xp, yp and k1 in Table 1: px, px and 1e-7 px^-2."""


@dataclass(frozen=True, eq=False, slots=True)
class Reproduction:
    """The calibrations from the paper's photographs that are set beside it."""

    by_method: Mapping[str, Result]
    """Calibrations by the printed method (`Cost.PAPER`), by how their corners were located."""
    method: str
    """The one of them that the other fields, and all but Table 1, come from."""
    image_cost: Result
    """Calibration with the default cost."""
    synthetic: Result
    """Calibration by the printed method from synthetic versions of the photographs (5.2)."""
    extrinsic_errors: Array
    """(K, 6) relative errors of eq. 51, a row for each usable view of `synthetic`."""

    @property
    def real(self) -> Result:
        """The calibration by the printed method that Tables 2 and 3 and the figures show."""
        return self.by_method[self.method]


def make_table_1(results: Mapping[str, Result], evidence: StageOneEvidence) -> Table:
    """Make table 1: xp, yp and k1 of every view after Stage I.

    Args:
        results: calibrations, by how their corners were located.
        evidence: what the first of them says with the printed values held.
    """
    printed = np.array(printed_values.TABLE_1) / _STAGE_ONE_UNITS
    sources = [printed, *(stack_stage_one(r) / _STAGE_ONE_UNITS for r in results.values())]
    sd, first = evidence.sd / _STAGE_ONE_UNITS, next(iter(results.values()))
    own_rms = [row.rms for row in first.calibration.stage_one]
    rows = [
        [
            str(k + 1),
            *_list_stage_one([source[k] for source in sources], sd[k]),
            f"{own_rms[k]:.4f}",
            f"{evidence.held_rms[k]:.4f}",
        ]
        for k in range(len(printed))
    ]
    stage_two = [np.array(printed_values.TABLE_2), *map(_get_intrinsics, results.values())]
    ends = {
        "mean": [source.mean(axis=0) for source in sources],
        "scatter (SD of the views)": [source.std(axis=0, ddof=1) for source in sources],
        "all views together (Table 2)": [values[:3] / _STAGE_ONE_UNITS for values in stage_two],
    }
    rows += [[name, *_list_stage_one(values), "", ""] for name, values in ends.items()]
    names = [LOCATED_BY[method] for method in results]
    header = ["view"]
    for name in ("xp, px", "yp, px", "k1, 1e-7 px⁻²"):
        header += [f"{name}: printed", *(f"{names[0]} ± SD", *names[1:])]
    return Table([*header, f"rms e′, {names[0]}", "the same, printed values held"], rows)


def stack_stage_one(result: Result) -> Array:
    """Return (K, 3) xp, yp (px) and k1 (px^-2) of every view after Stage I."""
    return np.array([(row.xp, row.yp, row.k1) for row in result.calibration.stage_one])


def _list_stage_one(values: Sequence[Array], sd: Array | None = None) -> list[str]:
    """List xp, then yp, then k1 of each source; the second one's with `sd` (3,)."""
    cells = [[f"{value:z.4f}" for value in source] for source in values]
    if sd is not None:
        cells[1] = [f"{v:z.4f} ± {s:.2f}" for v, s in zip(values[1], sd, strict=True)]
    return [cell for parameter in zip(*cells, strict=True) for cell in parameter]


def _get_intrinsics(result: Result) -> Array:
    """Return (10,) the intrinsics in the paper's units and order."""
    return make_paper_table(result.calibration)[0]


def make_intrinsics_table(
    ours: Calibration, theirs: Sequence[float], their_sd: Sequence[float]
) -> Table:
    """Make table 2 or 3: the intrinsics with their standard deviations."""
    values, honest, sd = make_paper_table(ours)
    rows = [
        [
            f"{name}, {unit}",
            f"{t:.6g}",
            f"{v:.6g}",
            f"{(v - t) / ts:+z.2f}",
            f"{ts:.3g}",
            f"{s:.3g}",
            f"{h:.3g}",
        ]
        for name, unit, t, v, ts, s, h in zip(
            PAPER_NAMES, _UNITS, theirs, values, their_sd, sd, honest, strict=True
        )
    ]
    header = ("", "printed", "ours", "difference / SD", "SD printed", "SD ours", "1σ ours")
    return Table(header, rows)


def make_bouguet_table(reproduction: Reproduction) -> Table:
    """Make the table of section 5.1: what Bouguet's toolbox and the paper's method estimate."""
    ours = {f"ours, {LOCATED_BY[m]}": r for m, r in reproduction.by_method.items()}
    ours[f"ours, {LOCATED_BY[reproduction.method]}, image cost"] = reproduction.image_cost
    tables = [make_paper_table(result.calibration) for result in ours.values()]
    rows = []
    for name, (value, three_sigmas) in printed_values.BOUGUET.items():
        k = PAPER_NAMES.index(name)
        shifted = value + printed_values.BOUGUET_SHIFT.get(name, 0.0)
        rows.append(
            [
                f"{name}, px",
                f"{printed_values.TABLE_2[k]:.2f} ({printed_values.TABLE_2_SD[k]:.2f})",
                f"{value:.2f} ({three_sigmas:.2f})",
                format_with_sigma(shifted, three_sigmas / 3),
                *(format_with_sigma(values[k], honest[k]) for values, honest, _ in tables),
            ]
        )
    summaries = [summarise_residuals(result.calibration.residuals) for result in ours.values()]
    bouguets = _format_pair(*printed_values.BOUGUET_SIGMA, 3, ", ")
    rows.append(
        [
            "σ of the reprojection residuals x, y, px",
            _format_pair(*printed_values.IMAGE_SIGMA, 3, ", "),
            bouguets,
            bouguets,
            *(_format_pair(s.sigma_x, s.sigma_y, 3, ", ") for s in summaries),
        ]
    )
    header = ("", "the paper's, as printed", "Bouguet's, as printed", "Bouguet's, 1σ, our frame")
    return Table((*header, *ours), rows)


def make_table_of_others(reproduction: Reproduction) -> Table:
    """Make the table of the numbers in the text."""
    real = reproduction.real.calibration
    on_plane, made, image = (
        summarise_residuals(result.calibration.residuals)
        for result in (reproduction.real, reproduction.synthetic, reproduction.image_cost)
    )
    shown = real.stage_one[printed_values.SHOWN_VIEW - 1]
    largest, most = (100 * bound for bound in printed_values.EXTRINSIC_ERROR)
    below = 100 * float(np.mean(100 * reproduction.extrinsic_errors < most))
    rows = [
        (
            f"pixel aspect ratio from view {printed_values.SHOWN_VIEW}",
            f"{printed_values.ASPECT_OF_VIEW_13}",
            f"{shown.aspect:.4f}",
        ),
        ("iterations of Stage II", printed_values.STAGE_TWO_ITERATIONS, str(len(real.history) - 1)),
        (
            "residual e′ on the reference plane, reference px",
            _format_pair(*printed_values.REFERENCE_RESIDUAL, 1),
            _format_pair(on_plane.reference_mean, on_plane.reference_sd, 3),
        ),
        (
            "σ of the reprojection residuals x, y, px (ours exact)",
            _format_pair(*printed_values.IMAGE_SIGMA, 3, ", "),
            _format_pair(on_plane.sigma_x, on_plane.sigma_y, 4, ", "),
        ),
        (
            "the same with the image cost (isotropic board, p3 = 0)",
            "",
            _format_pair(image.sigma_x, image.sigma_y, 4, ", "),
        ),
        (
            "residual e′, synthetic images, reference px",
            _format_pair(*printed_values.SYNTHETIC_RESIDUAL, 3),
            _format_pair(made.reference_mean, made.reference_sd, 4),
        ),
        (
            "largest relative error of the extrinsics",
            f"about {largest:.1f} %",
            _describe_largest_error(reproduction),
        ),
        (f"extrinsics within {most:.2f} %", "most", f"{below:.0f} %"),
        ("corners", "3900", str(on_plane.count)),
    ]
    return Table(("", "printed", "ours"), rows)


def _describe_largest_error(reproduction: Reproduction) -> str:
    """Describe the largest relative error of eq. 51, and of what value it is."""
    errors = reproduction.extrinsic_errors
    row, column = np.unravel_index(int(np.argmax(errors)), errors.shape)
    k = reproduction.synthetic.places[row]
    value = reproduction.real.paper_poses()[k].vector[column]
    unit = " rad" if column < 3 else ""
    return (
        f"{100 * errors[row, column]:.3f} % ({EXTRINSIC_NAMES[column]} of view {k + 1}, "
        f"which is {value:.2g}{unit})"
    )


def _format_pair(a: float, b: float, digits: int, join: str = " ± ") -> str:
    return f"{a:.{digits}f}{join}{b:.{digits}f}"
