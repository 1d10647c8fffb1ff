"""Page of HTML that sets every number printed in the paper beside ours."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from html import escape

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.assessment import summarise_residuals
from calibgui.engine.calibration import Calibration, make_paper_table
from calibgui.engine.geometry import PAPER_NAMES
from calibgui.report import printed_values

_UNITS = ("px", "px", "px⁻²", "px⁻⁴", "px⁻⁶", "px⁻¹", "px⁻¹", "px⁻²", "px", "px")

_STYLE = """
body { font: 15px/1.5 sans-serif; max-width: 62rem; margin: 2rem auto; padding: 0 1rem }
table { border-collapse: collapse; margin: 1rem 0 }
th, td { padding: .2rem .7rem; text-align: right; border-bottom: 1px solid #ddd }
th:first-child, td:first-child { text-align: left }
figure { margin: 1.5rem 0 } img { max-width: 100% } figcaption { color: #555 }
"""


def make_paper_page(
    real: Calibration,
    synthetic: Calibration,
    image_cost: Calibration,
    extrinsic_errors: Array,
    figures: Mapping[str, str],
) -> str:
    """Make the page, as HTML.

    Args:
        real: calibration by the printed method (`Cost.PAPER`) on the real images.
        synthetic: calibration by the same method on their synthetic versions (5.2).
        image_cost: calibration from the real images with the default cost.
        extrinsic_errors: (K, 6) relative errors of eq. 51.
        figures: file names of the figures, by their captions.
    """
    parts = [
        "<h1>Lucchese 2005, printed and reproduced</h1>",
        "<p>Printed values are the paper's; <i>SD</i> is its sqrt(diag((2 JᵀJ)⁻¹)), which does "
        "not know the residuals; <i>1σ</i> is σ sqrt(diag((JᵀJ)⁻¹)), what the residuals support. "
        "Differences are in units of the printed SD.</p>",
        "<h2>Table 1: Stage I</h2>",
        _make_table_1(real),
        "<h2>Table 2: intrinsics from the real images</h2>",
        _make_intrinsics_table(real, printed_values.TABLE_2, printed_values.TABLE_2_SD),
        "<h2>Table 3: intrinsics from the synthetic images</h2>",
        _make_intrinsics_table(synthetic, printed_values.TABLE_3, printed_values.TABLE_3_SD),
        "<h2>Other figures in the text</h2>",
        _make_table_of_others(real, synthetic, image_cost, extrinsic_errors),
        "<h2>Figures</h2>",
        *(
            f'<figure><img src="{escape(name)}" alt="{escape(caption)}">'
            f"<figcaption>{escape(caption)}</figcaption></figure>"
            for caption, name in figures.items()
        ),
    ]
    return (
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
        f"<title>Lucchese 2005 reproduced</title><style>{_STYLE}</style></head>\n<body>\n"
        + "\n".join(parts)
        + "\n</body></html>\n"
    )


def _make_table(header: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Make an HTML table."""
    head = "".join(f"<th>{escape(cell)}</th>" for cell in header)
    body = "\n".join(
        "<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in row) + "</tr>" for row in rows
    )
    return f"<table>\n<tr>{head}</tr>\n{body}\n</table>"


def _make_table_1(real: Calibration) -> str:
    """Make table 1: xp, yp and k1 of every view after Stage I."""
    ours = np.array([(row.xp, row.yp, 1e7 * row.k1) for row in real.stage_one])
    theirs = np.array(printed_values.TABLE_1) * [1, 1, 1e7]
    rows = [
        [str(k + 1), *(f"{v:.4f}" for pair in zip(theirs[k], ours[k], strict=True) for v in pair)]
        for k in range(min(len(ours), len(theirs)))
    ]
    means = [*printed_values.TABLE_1_MEAN, theirs[:, 2].mean()]
    rows.append(
        ["mean", *(f"{v:.4f}" for pair in zip(means, ours.mean(axis=0), strict=True) for v in pair)]
    )
    header = ["view"]
    for name in ("xp, px", "yp, px", "k1, 1e-7 px⁻²"):
        header += [f"{name}: printed", "ours"]
    return _make_table(header, rows)


def _make_intrinsics_table(
    ours: Calibration, theirs: Sequence[float], their_sd: Sequence[float]
) -> str:
    """Make table 2 or 3: the intrinsics with their standard deviations."""
    values, honest, sd = make_paper_table(ours)
    rows = [
        [
            f"{name}, {unit}",
            f"{t:.6g}",
            f"{v:.6g}",
            f"{(v - t) / ts:+.2f}",
            f"{ts:.3g}",
            f"{s:.3g}",
            f"{h:.3g}",
        ]
        for name, unit, t, v, ts, s, h in zip(
            PAPER_NAMES, _UNITS, theirs, values, their_sd, sd, honest, strict=True
        )
    ]
    header = ("", "printed", "ours", "difference / SD", "SD printed", "SD ours", "1σ ours")
    return _make_table(header, rows)


def _make_table_of_others(
    real: Calibration, synthetic: Calibration, image_cost: Calibration, errors: Array
) -> str:
    """Make the table of the numbers in the text."""
    on_plane, made, image = (
        summarise_residuals(c.residuals) for c in (real, synthetic, image_cost)
    )
    shown = real.stage_one[printed_values.SHOWN_VIEW - 1]

    def pair(a: float, b: float, digits: int, join: str = " ± ") -> str:
        return f"{a:.{digits}f}{join}{b:.{digits}f}"

    rows = [
        (
            "pixel aspect ratio from view 13",
            f"{printed_values.ASPECT_OF_VIEW_13}",
            f"{shown.aspect:.4f}",
        ),
        ("iterations of Stage II", printed_values.STAGE_TWO_ITERATIONS, str(len(real.history) - 1)),
        (
            "residual e′ on the reference plane, reference px",
            pair(*printed_values.REFERENCE_RESIDUAL, 1),
            pair(on_plane.reference_mean, on_plane.reference_sd, 3),
        ),
        (
            "σ of the reprojection residuals x, y, px (ours exact)",
            pair(*printed_values.IMAGE_SIGMA, 3, ", "),
            pair(on_plane.sigma_x, on_plane.sigma_y, 4, ", "),
        ),
        (
            "the same with the image cost (isotropic board, p3 = 0)",
            "",
            pair(image.sigma_x, image.sigma_y, 4, ", "),
        ),
        (
            "residual e′, synthetic images, reference px",
            pair(*printed_values.SYNTHETIC_RESIDUAL, 3),
            pair(made.reference_mean, made.reference_sd, 4),
        ),
        (
            "largest relative error of the extrinsics",
            f"about {100 * printed_values.EXTRINSIC_ERROR[0]:.1f} %",
            f"{100 * float(errors.max()):.3f} %",
        ),
        (
            f"extrinsics within {100 * printed_values.EXTRINSIC_ERROR[1]:.2f} %",
            "most",
            f"{100 * float(np.mean(errors < printed_values.EXTRINSIC_ERROR[1])):.0f} %",
        ),
    ]
    rows.append(("corners", "3900", str(on_plane.count)))
    return _make_table(("", "printed", "ours"), rows)
