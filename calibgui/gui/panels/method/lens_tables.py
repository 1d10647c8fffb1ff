"""Two tables of lens models: what they leave on the views, and what they say of the image."""

from __future__ import annotations

import math
from collections.abc import Sequence

from calibgui.gui.panels.method.linked_tables import LinkedTables
from calibgui.gui.widgets.tables import Column, with_decimals
from calibgui.report.lens_choice import LensRow, format_px
from calibgui.report.lens_models import get_short_lens_title


class LensTables(LinkedTables):
    """Shows lens models; a row that is selected in one table is selected in the other as well."""

    def __init__(self) -> None:
        super().__init__()
        self.errors = self.add_table(self.tr("Errors"))
        self.image = self.add_table(self.tr("Image"))

    def show_rows(self, rows: Sequence[LensRow]) -> None:
        """Show lens models; those that something speaks against stand out."""
        marked = {k: "; ".join(row.remarks) for k, row in enumerate(rows) if not row.is_eligible}
        self.errors.show_columns(self._make_error_columns(rows), marked)
        self.image.show_columns(self._make_image_columns(rows), marked)

    def _make_error_columns(self, rows: Sequence[LensRow]) -> list[Column]:
        px = with_decimals(3)
        return [
            self._make_name_column(rows),
            Column(
                self.tr("n"), [row.parameters for row in rows], tip=self.tr("Estimated parameters")
            ),
            Column(
                self.tr("RMS"),
                [row.rms for row in rows],
                px,
                self.tr("Residuals of a calibration from all views"),
                unit="px",
            ),
            Column(
                self.tr("σx"),
                [row.sigma_x for row in rows],
                px,
                self.tr("Standard deviation of these residuals across the image"),
                optional=True,
                unit="px",
            ),
            Column(
                self.tr("σy"),
                [row.sigma_y for row in rows],
                px,
                self.tr("Standard deviation of these residuals down the image"),
                optional=True,
                unit="px",
            ),
            Column(
                self.tr("Unseen"),
                [row.unseen_rms for row in rows],
                px,
                self.tr(
                    "RMS of the residuals of views that were left out of the calibration in turn,\n"
                    "with only their poses fitted"
                ),
                unit="px",
            ),
            Column(
                self.tr("Median"),
                [row.unseen_median for row in rows],
                px,
                self.tr("Median length of the residuals of unseen views"),
                optional=True,
                unit="px",
            ),
            Column(
                self.tr("95 %"),
                [row.unseen_p95 for row in rows],
                px,
                self.tr("Length that 95 % of the residuals of unseen views do not exceed"),
                optional=True,
                unit="px",
            ),
            Column(self.tr("Remarks"), ["; ".join(row.remarks) for row in rows], hidden=True),
        ]

    def _make_image_columns(self, rows: Sequence[LensRow]) -> list[Column]:
        fields = zip(*(row.field_of_view for row in rows), strict=True)
        names = (
            (self.tr("Horizontal"), self.tr("H")),
            (self.tr("Vertical"), self.tr("V")),
            (self.tr("Diagonal"), self.tr("D")),
        )
        return [
            self._make_name_column(rows),
            *(
                Column(
                    name,
                    list(angles),
                    _format_degrees,
                    self.tr("Field of view, {0}, degrees").format(name.lower()),
                    optional=name == self.tr("Diagonal"),
                    heading=letter,
                )
                for (name, letter), angles in zip(names, fields, strict=True)
            ),
            Column(
                self.tr("Corners"),
                [row.largest_angle for row in rows],
                _format_degrees,
                self.tr("Largest angle off the axis at which a corner was seen, degrees"),
                optional=True,
            ),
            Column(
                self.tr("BIC"),
                [row.bic for row in rows],
                with_decimals(0),
                self.tr("Bayesian information criterion, less the least one"),
            ),
            Column(
                self.tr("Differs"),
                [row.difference for row in rows],
                format_px,
                self.tr(
                    "Largest distance from the recommended model's map where corners were seen"
                ),
                unit="px",
            ),
            Column(
                self.tr("Valid"),
                [row.valid_share for row in rows],
                lambda share: f"{math.floor(100 * share)} %",
                self.tr("Part of the image on which the map is one-to-one"),
            ),
        ]

    def _make_name_column(self, rows: Sequence[LensRow]) -> Column:
        return Column(self.tr("Lens model"), [get_short_lens_title(row.model) for row in rows])


def _format_degrees(angle: float) -> str:
    """Format an angle in whole degrees; a dash where there is none."""
    return f"{angle:.0f}°" if math.isfinite(angle) else "–"
