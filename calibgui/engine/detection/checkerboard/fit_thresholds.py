"""The thresholds of refinement and of the edge fit, in one record.

They follow the search (`thresholds`): the typical corner of a board, its saddle points, the
profiles across its edges, what is taken from the board as a whole, and the fit of two crossing
edges at every corner. Lengths on the board are in squares. Unless a field says otherwise its value
is a plausibility limit. The benchmark that exercises them all is

    python -m tests.benchmarks.corners

It is run with the values as they are; which other values would do as well is not recorded.
"""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(frozen=True, slots=True, kw_only=True)
class TemplateThresholds:
    """Thresholds of what a corner looks like (`corner_template`)."""

    min_sector_gap: float = 0.25
    """Least gap between the dark and the bright sectors, over their mean difference."""
    min_relative_contrast: float = 0.2
    """Least contrast of a corner, over the median of its lattice; less as its light is less."""
    max_template_corners: int = 400
    """Number of corners, spread over the lattice, that the typical corner is taken from."""
    max_dissimilarity: float = 0.05
    """Greatest lack of correlation with the typical corner ..."""
    max_relative_dissimilarity: float = 4.0
    """... or over the median lack, whichever is more."""
    max_dissimilarity_near: float = 0.18
    """... or, near the corners of a board most of whose corners are alike, whatever shadow or dead
    pixel is seen there. Those have up to 0.16; what is behind a finger 0.2 and more, or colours
    that do not alternate. Fixed by the troubles "shadow", "dead pixels", "hand" and "object" of
    `tests.benchmarks.corner_troubles`."""
    max_unevenness: float = 0.3
    """Greatest difference of grey levels within a square that counts as evenly filled, over the
    board's contrast."""
    max_crossing_dissimilarity: float = 0.011
    """Greatest lack of correlation of the typical corner with the nearest of the modelled
    crossings of two edges ..."""
    max_printed_dissimilarity: float = 0.005
    """... and, where things are printed in the squares, of what is near the corner with those
    crossings that neither overlap nor part."""
    max_dissimilarity_alone: float = 0.02
    """... or, of a lattice that stands alone with straight edges, whatever is farther away. Boards
    in interlaced frames, or sharpened to one side, have up to 0.017, discs 0.024 and more."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SaddleThresholds:
    """Thresholds of saddle points (`saddle`)."""

    min_step: float = 1e-4
    """Length of a step at which an estimate has converged, px."""
    max_iterations: int = 20
    """Number of steps after which an estimate has failed."""
    max_off_middle: float = 0.42
    """Greatest median distance of the grey level at the corners from the middle of their squares',
    over the contrast: beyond it the squares overlap or part and have no saddle point."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ProfileThresholds:
    """Thresholds of profiles across edges (`edge_profiles`)."""

    min_relative_rise: float = 0.5
    """Least rise of a profile that is measured, over the median."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PriorThresholds:
    """Thresholds of what is taken from the board as a whole (`board_priors`)."""

    max_degree: int = 7
    """Highest degree of the polynomials tried."""
    many_corners: int = 40
    """Number of corners from which on they tell how edges bend, without their directions."""
    max_told_misfit: float = 1.2
    """Greatest rms miss, over the corners' standard deviation, up to which what many corners tell
    is believed, or what a lens does."""
    min_edge_degree: int = 3
    """Lowest degree of the polynomials tried that follow edges, too, beside none: a lens and a
    homography come before."""
    max_edge_degree: int = 5
    """The highest degree of those."""
    term_cost: float = 1.4
    """Cost of a term in the cross-validation, as Kim and Gu (2004) advise: with 1 it takes too high
    a degree by chance now and then."""
    min_edge_independence: float = 0.02
    """The same as `min_independence` of terms that follow edges, too: what depends on less of a
    term is noise."""
    min_independence: float = 1e-6
    """Least part of a term that those of lower degree do not have in common with it."""
    max_relative_misfit: float = 3.0
    """Greatest rms miss of a polynomial, over the noise of the values' second differences; beyond
    it the values break, as light does at the edge of a shadow."""


@dataclass(frozen=True, slots=True, kw_only=True)
class EdgeFitThresholds:
    """Thresholds of the fit of two crossing edges (`x_corner_fit`)."""

    min_arm: float = 8.0
    """Length up to which arms are read even where something was printed on them, px."""
    max_near_arm: float = 9.0
    """Longest arm that is read for the first approximation, px. The last one reads all of the
    arms: with 18 to 74 px of them corners in 12 megapixels lay 1.2 to 1.6 times off the bound."""
    max_arm_growth: float = 6.0
    """Greatest factor by which arms grow from one approximation to the next before that."""
    max_short_arm: float = 25.0
    """Length of the arms up to which many corners tell enough of how edges bend, unless the image
    cuts these, px. To follow the edges takes up to a third of the search's time."""
    min_ink_spread: float = 0.002
    """Spread of the dark squares below which it counts as none, squares."""
    max_ink_spread: float = 0.2
    """Spread of the dark squares beyond which it is not believed, squares."""
    max_rho: float = 0.95
    """Largest correlation rho of the two edges."""
    rho_sigma: float = 0.3
    """Standard deviation of rho around that of a blur alike in all directions."""
    blur_difference_sigma: float = 0.03
    """Standard deviation of the difference of a corner's two blurs around what the board shows,
    blurs."""
    blur_reach: float = 2.0
    """Distance, in blurs, over which the blur of what follows a square's colour is felt. With 1.5
    the covariances of corners between markers were 1.2 to 1.4 times too large."""
    max_open_light: float = 0.02
    """Greatest growth of a corner's variance by what the board leaves open of the light, at which
    that is not looked up between the edges; it saves a tenth of the time."""
    spread_blur_reach: float = 3.0
    """Distance, in blurs, over which the blur of what follows the ink's spread is felt; the spread
    is far smaller than a blur."""
    min_spread_blurs: float = 2.0
    """Least width, in blurs, on either side of an edge that the spread is measured over."""


@dataclass(frozen=True, slots=True, kw_only=True)
class NoiseThresholds:
    """Thresholds of the noise near the corners (`corner_noise`)."""

    min_opposite_pixels: int = 20
    """Number of pairs of opposite pixels from which on their differences give the noise."""
    min_freedom: int = 20
    """Number of pixels beyond that of unknowns from which on a corner tells the noise by itself."""
    min_relative_noise: float = 0.25
    """Least square of a corner's noise, over the board's median. 30 pairs of pixels tell less
    by chance at one of 100,000 corners. Without it corners of the troubles "two levels" and
    "repeated pixels" claimed to be 100 times surer than their neighbours, and were no better."""
    min_correlation_reach: float = 8.0
    """Distance of lines of pixels up to which their errors may be in common at least, px. With 5
    chi2 of corners was 1.1 to 1.2 in images enlarged by 3 or smoothed by 1 px ..."""
    correlation_reach: float = 1 / 3
    """... and over the arms: many pixels of an edge tell what few have in common at distances that
    images enlarged by 5 and phones have. With 8 px chi2 was 1.5 and 2.3 there, not 1.2 and 1.4."""
    min_corners: int = 6
    """Number of corners from which on a board tells what neighbouring pixels have in common."""
    read_corners: float = 264.0
    """Number of corners that are looked at for that, times the root of their arms' length in px:
    a longer one tells more, but no single one tells it. Of 54 corners with 15 px each way a growth
    by 1.25 is clear. It takes 3 to 10 % of the time of finding corners."""
    max_relative_growth: float = 4.0
    """Greatest growth of the covariance that one corner counts with, over the board's median; of
    independent noise one in a thousand has more."""
    min_growth_sigmas: float = 3.0
    """Least excess of the growth over 1 that is believed, over its standard deviation ..."""
    min_edge_growth_sigmas: float = 4.0
    """... or of that by errors greater at edges than beside them, whose deviation is smaller. On
    200 boards with independent noise the excesses were at most 2.5 and 2.8."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LightThresholds:
    """Thresholds of corners whose light is their own (`local_light`). The troubles "blinds",
    "flicker" and "shadow" of `tests.benchmarks.corner_troubles` fixed them, and "video" and
    "mosaic", whose corners gain nothing."""

    min_gain: float = 8.0
    """Least F of the light's gradients with which a corner has its own, also over the board's
    median. Sums of many pixels make it 6 by chance at one of 20 corners of "video"; with 4 its
    errors grew by a fifth."""
    min_relative_residual: float = 1.5
    """Least residual of such a corner, over the board's median, where squares are plain or its F
    does not stand out ..."""
    min_median_share: float = 0.3
    """... unless that share of the squares of the residuals, or more, is explained by gradients at
    half of the corners."""
    max_distance: float = 2.0
    """Greatest square of the distance between a corner fitted to its whole edges and to their
    nearer half, over the sum of the latter's variances."""
    min_arm: float = 2.0
    """Least length of a half, px; see `near_fit`."""


@dataclass(frozen=True, slots=True, kw_only=True)
class StrayLightThresholds:
    """Thresholds of light that strays (`stray_light`)."""

    min_corners: int = 16
    """Least number of corners that tell it."""
    least_loss: float = 1e-3
    """Least variance in a direction by which gradients cost corners, over that in all."""
    min_sigmas: float = 3.0
    """Least excess of H over 1 that is believed, standard deviations."""
    max_shift: float = 0.05
    """Greatest median of v, px: more is no light. Photographs of small, dense squares under a
    fisheye had more, and three in a hundred of their corners were drawn 0.3 px aside."""
    max_below_clipping: float = 0.01
    """Greatest distance of clipped paper from the image's greatest level, over that."""
    clipped_share: float = 0.45
    """Share of D that is true beside clipped paper: without stray light H was 0.1 to 0.7 on
    rendered boards, 0.42 on average."""
    unseen_share: float = 0.5
    """Share of (H - 1) D that is added there. On four kinds of boards rendered with 15 % of the
    light strayed over 6 to 12 px chi2 was 1.2 to 1.7 without, and on others is 0.9 to 1.6."""


@dataclass(frozen=True, slots=True, kw_only=True)
class HardEdgeThresholds:
    """Thresholds of edges without a grey pixel (`hard_edges`)."""

    read_corners: int = 16
    """Number of corners that are looked at."""
    min_distance: int = 2
    """Least distance from the corner of what is looked at along the edges, px ..."""
    max_distance: int = 8
    """... and the greatest."""
    reach_across: int = 3
    """Number of pixels to either side of an edge that are looked at, for ink spreads."""
    max_grey_level: float = 0.8
    """Greatest distance of a grey pixel's level from the middle one, half contrasts."""
    min_crossing_share: float = 0.5
    """Share of the places at which a dark and a bright pixel are seen, below which edges are too
    wide, or too far away, to tell."""
    max_grey_share: float = 0.3
    """Share of those with a grey pixel below which edges are hard. Of boards under all of the
    troubles it is 0.8 and more, but for "two levels", where it is 0."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FitThresholds:
    """Every threshold from a lattice of corners to their fit, by its stage."""

    template: TemplateThresholds = field(default_factory=TemplateThresholds)
    saddle: SaddleThresholds = field(default_factory=SaddleThresholds)
    profiles: ProfileThresholds = field(default_factory=ProfileThresholds)
    priors: PriorThresholds = field(default_factory=PriorThresholds)
    edges: EdgeFitThresholds = field(default_factory=EdgeFitThresholds)
    noise: NoiseThresholds = field(default_factory=NoiseThresholds)
    light: LightThresholds = field(default_factory=LightThresholds)
    stray_light: StrayLightThresholds = field(default_factory=StrayLightThresholds)
    hard_edges: HardEdgeThresholds = field(default_factory=HardEdgeThresholds)


FIT_THRESHOLDS = FitThresholds()
"""The thresholds in use."""
