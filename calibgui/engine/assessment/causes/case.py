"""The harm that a cause does: the part of the error of pixels that is gone without it.

Of the covariance C of the camera's parameters, C0 is what the corners' noise alone makes of them,
and the rest is there because board and views are not as the model has them. Without a cause that
explains a share s of the squared residuals that rest is gone, and so is this share of the noise;
with J as in ``changes/camera_uncertainty.py`` the cause adds

    cov(q) - (1 - s) cov0(q) = J (C - (1 - s) C0) J^T

to the covariance of a pixel q; blur, which moves nothing, only s cov0(q), and a lack of views
cov(q). Its harm is the root mean square of that over the part of the image that corners cover
(``comparison.find_covered_pixels``), in the direction where it is largest. What wrong values and
corners do is measured on the same pixels (``input_errors.py``). Beyond that part a lens model is
extrapolated, which magnifies any error: this is a lack of coverage, not the fault of the cause, and
the verdict tells it. What the harm does not measure is how far a single value is off: that is its
standard deviation, which includes what the board and the views' disagreement do.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.assessment.causes.mixed_views import Split, find_two_kinds
from calibgui.engine.assessment.causes.rival_lens import Rival, fit_rival
from calibgui.engine.assessment.changes.camera_uncertainty import split_camera_uncertainty
from calibgui.engine.assessment.changes.comparison import find_covered_pixels
from calibgui.engine.assessment.finding import MIN_VIEWS_TO_JUDGE
from calibgui.engine.assessment.residuals.residual_checks import (
    NoiseReport,
    check_residuals,
    find_largest_share,
)
from calibgui.engine.assessment.residuals.residual_statistics import summarise_residuals
from calibgui.engine.assessment.residuals.systematic_errors import prepare_fit
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.images.sampling import make_mesh
from calibgui.engine.numbers import format_two_digits
from calibgui.engine.uncertainty.projection_uncertainty import (
    ProjectionUncertainty,
    compute_worst_sigma,
)


@dataclass(frozen=True, eq=False)
class Case:
    """A calibration whose given values and corners are sound, and what is known of its pixels."""

    calibration: Calibration
    """The calibration."""
    views: Sequence[Observation]
    """The views that it was made from."""
    names: Sequence[str]
    """Their names."""
    numbers: Sequence[int]
    """Their indices among the views of the user."""
    sigma: float
    """One standard deviation of a pixel, median over the image, px."""
    by_noise_alone: float
    """The part of it that the corners' noise explains, median over the image, px."""
    worst: float
    """One standard deviation of the pixel that is known worst, px; the image's size if none is."""
    part: float
    """Share of the image, as far as the lens shows it, that corners cover."""
    total: Array
    """(n, 2, 2) covariance of the pixels where there are corners, px^2."""
    by_noise: Array
    """(n, 2, 2) part of it that the corners' noise explains, px^2."""
    rms: float
    """Root mean square residual, px."""
    shown_rms: float
    """Root mean square residual of the calibration that the user sees, px."""
    check: Callable[[], None]
    """Function that is called now and then, and raises to abandon the work."""
    how_shown: str = ""
    """Words for what makes that calibration another than this one; empty if it is the same."""

    @cached_property
    def report(self) -> NoiseReport:
        """All that the residuals were tested for, once for all who ask."""
        return check_residuals(self.calibration, self.views, self.names, lambda *_: self.check())

    @cached_property
    def rival(self) -> Rival:
        """The views as a lens model of another kind follows them."""
        return fit_rival(self.calibration, self.views)

    @property
    def explained(self) -> float:
        """Share of the squared residuals that the best cause explains, but for a lens of another
        kind."""
        return find_largest_share(self.report.checks)

    @cached_property
    def split(self) -> Split | None:
        """The views parted in two kinds, if they certainly are of two; None if not, or if they are
        too few to tell."""
        if len(self.views) < MIN_VIEWS_TO_JUDGE:
            return None
        self.check()
        return find_two_kinds(prepare_fit(self.calibration, self.views))

    def follow(self, case: Case, how_shown: str) -> Case:
        """Return this case as one that follows from another, told from it by some words."""
        words = " and ".join(filter(None, (case.how_shown, how_shown)))
        return replace(self, shown_rms=case.shown_rms, how_shown=words)

    def describe_rms(self) -> str:
        """Describe the residuals by their RMS, beside that which the user sees if it is another."""
        own, shown = (f"{format_two_digits(rms)} px" for rms in (self.rms, self.shown_rms))
        return f"{own} RMS" if own == shown else f"{own} RMS ({shown} {self.how_shown})"

    def measure_harm(self, share: float = 0.0) -> float:
        """Measure what a cause of a share of the squared residuals does to pixels, px rms.

        It is the image's size where no pixel is known.
        """
        return self._take_rms(self.total - (1 - share) * self.by_noise)

    def measure_noise(self, share: float) -> float:
        """Measure what noise of a share of the squared residuals does to pixels, px rms."""
        return self._take_rms(share * self.by_noise)

    def _take_rms(self, covariance: Array) -> float:
        """Return the root mean square standard deviation, px, of covariances (n, 2, 2), px^2."""
        variance = compute_worst_sigma(covariance) ** 2
        known = variance[np.isfinite(variance)]
        return (
            float(np.sqrt(known.mean())) if known.size else float(max(self.calibration.camera.size))
        )


def prepare_case(
    calibration: Calibration,
    views: Sequence[Observation],
    names: Sequence[str],
    check: Callable[[], None] = lambda: None,
    known: tuple[ProjectionUncertainty, ProjectionUncertainty] | None = None,
) -> Case:
    """Prepare a case: find out how well pixels are known, by everything and by noise alone, unless
    that is already `known`."""
    check()
    total, by_noise = known or split_camera_uncertainty(calibration, views)
    over_image = total.worst_direction
    seen = over_image[np.isfinite(over_image)]  # a lens may image nothing in the corners
    if not seen.size:
        seen = np.array(calibration.camera.size)
    noise = by_noise.worst_direction[np.isfinite(over_image)]
    covered = find_covered_pixels(make_mesh(total.u, total.v), views)
    rms = summarise_residuals(calibration.residuals).rms
    return Case(
        calibration,
        views,
        names,
        range(len(views)),
        sigma=float(np.median(seen)),
        by_noise_alone=float(np.median(noise)) if noise.size else float(seen.max()),
        worst=float(seen.max()),
        part=float(covered[~np.isnan(over_image)].sum() / max(np.sum(~np.isnan(over_image)), 1)),
        total=total.covariance[covered],
        by_noise=by_noise.covariance[covered],
        rms=rms,
        shown_rms=rms,
        check=check,
    )
