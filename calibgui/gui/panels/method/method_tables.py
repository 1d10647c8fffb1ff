"""Two tables of methods of calibration: how well they predict, and what they say of the camera."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from calibgui.gui.panels.method.linked_tables import LinkedTables
from calibgui.gui.widgets.tables import Column, format_seconds, with_decimals
from calibgui.report.lens_choice import format_px
from calibgui.report.methods import MethodRow

_NAN = math.nan


class MethodTables(LinkedTables):
    """Shows methods; the tooltip of a dash says why there is no value."""

    def __init__(self) -> None:
        super().__init__()
        self.errors = self.add_table(self.tr("Errors"))
        self.camera = self.add_table(self.tr("Camera"))

    def show_rows(self, rows: Sequence[MethodRow]) -> None:
        """Show methods; those that gave nothing stand out, with the reason as their tooltip."""
        marked = {k: " ".join(row.remarks) for k, row in enumerate(rows) if row.kind == "refused"}
        self.errors.show_columns(self._make_error_columns(rows), marked)
        self.camera.show_columns(self._make_camera_columns(rows), marked)

    def _make_error_columns(self, rows: Sequence[MethodRow]) -> list[Column]:
        straight = self.tr(
            "It knows no lengths: this is the distance of corners from straight rows and columns.\n"
            "Compare it with methods marked * only."
        )
        tips = [straight if row.kind == "lines" else "" for row in rows]
        return [
            self._make_name_column(rows),
            Column(
                self.tr("RMS"),
                [row.rms for row in rows],
                _format_length,
                self.tr("Residuals of a calibration from all views"),
                tips=tips,
                unit="px",
            ),
            Column(
                self.tr("σ"),
                [row.sigma for row in rows],
                _format_length,
                self.tr("Standard deviation of a coordinate of these residuals"),
                unit="px",
            ),
            Column(
                self.tr("Unseen"),
                [row.unseen for row in rows],
                _format_length,
                self.tr(
                    "RMS of the residuals of views that were left out of the calibration in turn,\n"
                    "with only their poses fitted"
                ),
                tips=tips,
                unit="px",
            ),
            Column(
                self.tr("Differs"),
                [row.difference_worst for row in rows],
                _format_length,
                self.tr(
                    "Largest distance between a point's images by this method and by the chosen\n"
                    "calibration, where corners were seen"
                ),
                unit="px",
            ),
            Column(
                self.tr("in RMS"),
                [row.difference_rms for row in rows],
                _format_length,
                self.tr("Root mean square of these distances"),
                optional=True,
                unit="px",
            ),
            Column(
                self.tr("Steps"),
                [_NAN if row.iterations is None else float(row.iterations) for row in rows],
                with_decimals(0),
                self.tr("Iterations of the refinement; a dash where there are none, or not told"),
                optional=True,
            ),
            Column(
                self.tr("Time [s]"),
                [row.seconds for row in rows],
                format_seconds,
                self.tr("Time of initialisation and refinement from all views"),
                optional=True,
                heading=self.tr("Time"),
            ),
            Column(self.tr("Remarks"), [" ".join(row.remarks) for row in rows], hidden=True),
        ]

    def _make_camera_columns(self, rows: Sequence[MethodRow]) -> list[Column]:
        px = with_decimals(2)
        unknown = (_NAN, _NAN)
        radius = next((row.radius for row in rows if math.isfinite(row.radius)), _NAN)
        centre = self.tr("Principal point; of methods marked * the distortion's centre")
        columns = [self._make_name_column(rows)]
        for name, text, tip in (
            ("fx", px, self.tr("Focal length across the image")),
            ("fy", px, self.tr("Focal length down the image")),
            ("cx", px, centre),
            ("cy", px, centre),
            (
                "skew",
                with_decimals(3),
                self.tr("Shift across the image over a length of fy down it"),
            ),
        ):
            estimates = [row.values.get(name, unknown) for row in rows]
            columns += self._make_estimate_columns(name, rows, estimates, text, tip)
        shifts = [row.shift or unknown for row in rows]
        moves = self.tr(
            "How far the distortion moves points that are measured {0:.0f} px from the centre,\n"
            "where the outermost corner lies; negative towards it"
        ).format(radius)
        columns += self._make_estimate_columns(self.tr("Shift"), rows, shifts, px, moves)
        coefficients = [row.coefficients for row in rows]
        return [*columns, Column(self.tr("Coefficients"), coefficients, hidden=True)]

    def _make_estimate_columns(
        self,
        name: str,
        rows: Sequence[MethodRow],
        estimates: Sequence[tuple[float, float]],
        text: Callable[[float], str],
        tip: str,
    ) -> list[Column]:
        """Make a column of values, and one of their standard deviations, shown if there is room."""
        tips = [
            self.tr("{0} ± {1:.2g} px (1σ)").format(tip, sigma)
            if math.isfinite(value)
            else self.tr("It does not estimate this. {0}").format(row.limits)
            for row, (value, sigma) in zip(rows, estimates, strict=True)
        ]
        values, sigmas = ([pair[k] for pair in estimates] for k in (0, 1))
        deviation = self.tr("One standard deviation of {0}").format(name)
        return [
            Column(name, values, text, tip, tips=tips, unit="px"),
            Column(
                self.tr("σ of {0}").format(name),
                sigmas,
                text,
                deviation,
                optional=True,
                heading=f"± {name}",
                unit="px",
            ),
        ]

    def _make_name_column(self, rows: Sequence[MethodRow]) -> Column:
        texts = {row.name: f"{row.label} *" if row.kind == "lines" else row.label for row in rows}
        return Column(
            self.tr("Method"),
            [row.name for row in rows],
            texts.__getitem__,
            tips=[f"{row.title} ({row.name})\n{row.limits}" for row in rows],
        )


def _format_length(length: float) -> str:
    """Format a length in px; a dash where it is not known."""
    return format_px(length) if math.isfinite(length) else "–"
