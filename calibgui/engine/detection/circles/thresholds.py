"""The numbers by which the detector of circle grids accepts and rejects, in one record.

They are plausibility limits: no benchmark has fixed them. ``tests/engine/detection/circles``
exercises the detector.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class CircleThresholds:
    """The thresholds of the detector of circle grids."""

    min_blob_area: int = 12
    """Least area of a dark part that may be a disc, px."""
    min_blob_fill: float = 0.85
    """Least ratio of a part's area to that of the ellipse of its covariance; pixels count as
    squares."""
    max_blob_fill: float = 1.1
    """Greatest such ratio."""
    max_ink_share: float = 0.6
    """Greatest level of ink over that of the paper beside it, where shadows lie on the board."""
    max_area_ratio: float = 8.0
    """Greatest ratio of the areas of those discs of a grid that are looked for first: what tilt and
    most lenses may cause."""
    max_neighbour_area_ratio: float = 2.0
    """Greatest ratio of the areas of two discs beside each other: what a fisheye may cause."""
    min_box_fill: float = 0.1
    """Least share of its upright bounding box that a disc fills: that of an ellipse ten times as
    long as wide and askew is 0.16."""
    max_mark_area_ratio: float = 16.0
    """Greatest ratio of the area of a mark, a larger disc in its place on the grid, to the others'
    median."""
    max_blobs: int = 400
    """Number of parts examined where the number of circles is not stated."""
    min_grid_circles: int = 12
    """Least number of circles of a grid whose size is not stated."""
    min_grid_lines: int = 3
    """Least number of rows and of columns of such a grid."""
    min_seed_sine: float = 0.25
    """Least sine of the angle between the first two steps of a lattice."""
    max_prediction_error: float = 0.3
    """Greatest distance of a point from where its neighbours predict it, shorter steps."""
    min_border_share: float = 0.5
    """Least share of a border line that must be present for its points to belong to the grid."""
    max_continued_share: float = 0.1
    """Greatest number of other discs that continue a grid whose size is not stated, over that of
    its own: with more it is a part of a larger one."""
    continued_lines: int = 4
    """Number of lines beyond a grid's borders on which such discs are looked for."""
    max_continuation_error: float = 0.15
    """Greatest distance of these from their places, along either diagonal, over the distance of
    neighbours there."""
    min_relative_contrast: float = 0.3
    """Least contrast of a circle over the median, or of its contrast over its light: a shadow takes
    as much of both."""
    max_misfit: float = 0.12
    """Greatest misfit of a fitted ellipse ..."""
    max_misfit_over_median: float = 4.0
    """... or over the median misfit, whichever is more."""
    max_noise_share: float = 0.25
    """Greatest noise that counts as such, over the contrast."""
    max_blur_over_axis: float = 0.6
    """Greatest blur of a circle over the shorter semi-axis of its ellipse. Beyond it blur, contrast
    and size are not told apart, and fits run away: they had ratios of 5, centres off by 1 to 2 px.
    Sound ones had 0.5 at most where circles of 3 px were blurred by 1.2 to 1.7 px."""
    max_misplacement: float = 0.1
    """Greatest distance of a circle from where the others predict it, pitches."""
    max_shape_difference: float = 0.2
    """Greatest difference of an ellipse from the one predicted by the others, over its size."""
    min_arc_contrast: float = 0.05
    """Least contrast of a way across a circle's edge, over the greatest of that circle: in a shadow
    it is an eighth, and less of ink in it beside paper in the light."""
    min_arc_share: float = 0.6
    """Least share of a circle's edge that must be seen where the rest is disturbed."""
    max_rejected_share: float = 0.25
    """Share of circles, rejected or not seen, beyond which the grid itself is rejected."""
    min_mark_radius_difference: float = 0.15
    """Least difference of a mark's radius from the others', over the latter; the radius of a disc
    is measured to a few per cent in any image that passes."""
    max_marked_share: float = 0.25
    """Greatest share of a grid's discs that are of another size."""
    max_diameter_difference: float = 0.05
    """Greatest difference of the measured diameter from the stated one, pitches."""


CIRCLE_THRESHOLDS = CircleThresholds()
"""The thresholds in use."""
