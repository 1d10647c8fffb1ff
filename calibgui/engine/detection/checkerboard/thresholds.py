"""The thresholds by which checkerboards are searched for and verified, in one record.

They are listed in the order in which an image meets them: the levels of the pyramid, the
X-junctions of one level, the graph of neighbours, the growth of a lattice, the prefilter, taking
joined boards apart, and the verification of what was refined. Lengths on the board are in squares
or, what is the same, in steps of the lattice, so that they do not depend on the size of the board
in the image.

Unless a field says otherwise its value is a plausibility limit. The benchmark

    python -m tests.benchmarks.corners

counts the boards found under each of its conditions and those seen in images without a board; a
field whose value such images fixed names their kind in `tests.scenes.without_board`.

Limits that every kind of board shares (`MIN_CORNERS`, `MIN_LINES`, `MAX_DEVIATION`, `MAX_GAP`) are
in `detection.lattice`; those of the fit of an edge model are beside the fit.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, slots=True, kw_only=True)
class JunctionTolerance:
    """Greatest deviations from an ideal X-junction and from the edge between two of them."""

    off_middle: float
    """Greatest difference of the centre from the mid grey level, over the contrast."""
    along: float
    """Greatest angle between an edge and the line to the neighbour that it leads to, rad."""
    parallel: float
    """Greatest angle between the crossing edges of two neighbours, rad."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SearchThresholds:
    """Thresholds of the search through the levels of an image (`pyramid_search`)."""

    max_top_level_side: int = 180
    """Short side of the coarsest level, px; a larger level is halved."""
    min_parted_level_side: int = 25
    """Short side of a level, px, down to which squares that overlap or part are searched for."""
    min_square: float = 6.0
    """Side of squares, px, from which on a level shows all of a board; boards of smaller ones are
    left to the finer levels."""
    min_square_with_gaps: float = 30.0
    """Side of squares, px, from which on a finer level is not searched either for a board that has
    gaps."""
    min_contrast: float = 0.05
    """Least contrast of a corner, over the range of the image's grey levels."""
    max_shared_corners: float = 0.25
    """Share of its corners that a lattice may have in common with a larger one before it counts as
    part of that: the pattern of a floor that goes on behind a board may catch some of its."""
    max_fragment_share: float = 0.1
    """Share of the corners of what a coarser level shows, below which a part of that is not grown
    in a finer one. The "waves" hold such of 0.03."""
    max_level_shift: float = 2.0
    """Greatest distance of a corner from where the next coarser level shows it, px; a corner
    without a saddle point within keeps its place."""
    min_level_step: float = 0.02
    """Length of a step at which a corner has converged in a level, px: what is left is made up for
    in the next, and in full resolution when the board is refined."""
    max_grown_lattices: int = 8
    """Number of lattices, those with the most junctions, that are grown in a level."""
    max_sparse_lattices: int = 2
    """Number of grown lattices of a level that fill less than the share `min_filled_in_texture` of
    their rows and columns, after which others that do are not grown. The "waves" and the "halftone"
    of `tests.benchmarks.refusals` have up to 8 of a third and less, which take long."""
    min_judged_corners: int = 320
    """Number of corners from which on a lattice is asked whether it is another board before it
    grows, which takes longer."""
    min_filled_in_texture: float = 0.5
    """See `max_sparse_lattices`. Lattices that fill less are given up at once if chance explains
    them: most of those of textures are ragged, and of a board some part is full."""


@dataclass(frozen=True, slots=True, kw_only=True)
class JunctionThresholds:
    """Thresholds of the X-junctions in one level (`x_junctions`)."""

    max_candidates: int = 3000
    """Number of saddle points, the strongest, that are kept in a level."""
    min_saddle: float = 0.1
    """Least square root of the determinant R of a saddle point, over the least contrast of a
    junction; a sharp crossing smoothed by 1 px has 1 / pi."""
    max_shift: float = 1.5
    """Greatest distance of a saddle point from its pixel along either axis, px."""
    max_asymmetry: float = 0.30
    """Greatest rms difference of opposite samples of a circle, over its contrast."""
    min_edge_angle: float = float(np.radians(12.0))
    """Least angle between the two edges of a junction, rad."""
    crossing: JunctionTolerance = JunctionTolerance(
        off_middle=0.3, along=float(np.radians(20.0)), parallel=float(np.radians(25.0))
    )
    """Tolerance where edges cross."""
    parted: JunctionTolerance = JunctionTolerance(
        off_middle=0.42, along=float(np.radians(26.0)), parallel=float(np.radians(40.0))
    )
    """Tolerance where squares overlap or part: all corners are bright or all dark in the middle,
    and edges pass them by on the one side or, at their neighbours, on the other."""


@dataclass(frozen=True, slots=True, kw_only=True)
class GraphThresholds:
    """Thresholds of the graph of neighbours (`neighbour_graph`)."""

    max_neighbours: int = 12
    """Number of junctions around one, the nearest, that its edges may lead to."""
    min_edge_step: float = 0.25
    """Least step across the edge between two neighbours, over the weaker one's contrast."""
    max_joined_block: int = 8
    """Greatest number of junctions that hang together by edges that close cells to which one that
    closes none may lead."""
    max_cells_per_junction: int = 3
    """Greatest number of a lattice's cells per junction, beyond `max_spare_cells` ..."""
    max_spare_cells: int = 256
    """... from which on it is too sparse for a board: this bounds the memory that it takes."""


@dataclass(frozen=True, slots=True, kw_only=True)
class GrowthThresholds:
    """Thresholds of the growth of a lattice (`lattice_growth`)."""

    max_points_per_place: int = 6
    """Number of saddle points near a predicted corner, the nearest, that are compared with it."""
    min_corners_over_gaps: int = 12
    """Number of corners from which on their grid map is trusted beyond a gap."""
    min_filled_beside_gaps: float = 0.35
    """Share of its rows and columns that a lattice of many corners fills at least if gaps around it
    are bridged: those of boards fill 0.39 or more, through the "waves" one winds from gap to
    gap."""
    max_gap_deviation: float = 0.2
    """Greatest distance of a corner beyond a gap from where the grid map places it, steps."""
    min_growth_for_template: float = 1.2
    """Growth in corners, as a factor, after which the typical corner is taken anew and the
    prefilter is asked again."""
    max_slow_rounds: int = 50
    """Number of rounds, each adding fewer corners than a line of a square board of so many has,
    after which growth ends."""
    max_ragged_rounds: int = 16
    """Number of such rounds after which a sparse lattice is given up. Boards that are partly hidden
    or blinded grow by whole lines all the same, up to 10 slow rounds in 54 growths, and what joins
    two boards fills most of its rows and columns; the "halftone" of `tests.benchmarks.refusals` has
    up to 44."""
    max_lattice_side: int = 200
    """Number of rows or columns beyond which growth ends."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PrefilterThresholds:
    """Thresholds of the test of a lattice's edges before it is refined (`prefilter`)."""

    min_corners_to_tell: int = 12
    """Number of corners from which on a lattice that may still grow is tested."""
    max_tested_corners: int = 64
    """Number of corners, spread over the lattice, whose edges are measured: as many as boards
    have."""
    max_bulge: float = 0.02
    """Greatest median difference of the edge's place away from the corner and near it, squares:
    edges of boards stay below 0.01, those of discs exceed 0.05. Fixed by the "discs"."""
    max_spread: float = 0.018
    """Greatest median deviation of the spreads in one direction from their median, squares, where
    the pattern ends with the lattice. Fixed by the "halftone" and the "stripes" ..."""
    max_spread_inside: float = 0.006
    """... and where the pattern goes on around the lattice in another look, squares. Fixed by the
    "halftone"."""
    max_rising_spread: float = 0.03
    """Greatest median deviation of spreads that rise to one side, squares. Fixed by the
    "halftone" ..."""
    max_unsteady_spread: float = 0.004
    """... and of what is left of them without the steady rise, squares."""
    max_edge_blur_alone: float = 0.23
    """Greatest median blur of the edges of a lattice that stands alone, as no waves do,
    squares ..."""
    max_edge_blur_printed: float = 0.1
    """... and where its edges seem to bulge: those of discs blurred more cross in a point."""
    max_spread_alone: float = 0.06
    """Greatest median deviation of the spreads in either direction of a lattice that stands alone,
    squares: moire and halos cause 0.04, rows that are shifted by a fifth of a square 0.1."""
    spread_error: float = 0.1
    """Deviation of spreads that is not told from the error of measuring them, px: in squares of 8
    to 16 px, noisy, filtered or compressed, that is up to 0.1."""
    max_ink: float = 0.1
    """Greatest median spread of the ink of such a lattice, squares."""
    max_direction_difference: float = 0.06
    """Greatest difference of the median spreads in the two directions, squares: cameras sharpen
    rows otherwise than columns. Fixed by the "stripes"."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SeparationThresholds:
    """Thresholds of taking joined boards apart (`board_separation`). The troubles "crease" and
    "screen" of

        python -m tests.benchmarks.corner_troubles

    fixed them: over a crease corners are 0.07 to 0.2 steps off one map and 0.002 to 0.007 off two;
    of one board they are at most 0.02 off one, and two maps follow it no better than by half."""

    max_joint_misfit: float = 0.03
    """Rms distance of the corners from one smooth grid map up to which they are left as they are,
    steps."""
    max_core_deviation: float = 0.1
    """Greatest distance of a corner from where the rigid map of those beside it expects it, steps.
    The trouble "pile" fixed it: at 0.2 a board took corners of another that lies over it."""
    max_misfit_ratio: float = 0.15
    """Greatest rms distance from the maps of two parts, over that from one map, at which a lattice
    is cut."""
    max_excess_misfit: float = 1.2
    """Rms distance of a cut, over that of the best, up to which the number of corners decides."""
    max_gaps: float = 1 / 3
    """Share of a border line's places without a corner, beyond which the line is ragged."""
    min_seam_corners: float = 0.7
    """Least share of the corners of a line at which the edge model leaves more unexplained than at
    those beside them, if two boards meet in the line ..."""
    min_seam_excess: float = 1.4
    """... and so many times more ..."""
    min_excess_corners: float = 0.5
    """... at such a share of them ..."""
    min_seam_misfit_ratio: float = 3.0
    """... rms distance of all corners from one map, over that from the maps of both boards ..."""
    min_row_misfit_ratio: float = 1.3
    """... and the same with the line taken for one board's. Boards that lie 0.02 to 0.1 squares
    apart have 1.4 to 4, 3.9 to 60 and 1.3 to 24; lines of 250 boards under all of the troubles
    never had all of it."""
    max_lines: int = 20
    """Number of lines along the shorter side beyond which no cut is tried: it bounds the time."""


@dataclass(frozen=True, slots=True, kw_only=True)
class VerificationThresholds:
    """Thresholds of a refined board (`verification`, `board_ends`, `a_contrario`)."""

    max_false_boards: float = 1 / 16
    """Number of boards that may be expected by chance in an image full of squares at random."""
    max_deviation: float = 0.2
    """Greatest distance of a corner from its neighbours' prediction, steps."""
    max_failing_corners: float = 0.25
    """Share of its corners that may fail before the board does."""
    max_grid_map_rms: float = 0.1
    """Greatest rms distance of a board's corners from the smooth grid map through them, steps."""
    max_broken_places: float = 0.1
    """Greatest number of places inside a board that show squares but no corner, over that of its
    corners. Fixed by squares that are dark or bright at random ..."""
    max_broken_places_alone: float = 1 / 6
    """... and of a lattice that stands alone, over a part of which something may lie."""
    min_border_corners: float = 1 / 3
    """Share of a line's places below which corners that are alike only near by are left out."""
    min_full_border: float = 2 / 3
    """Share of a border line's places in the image below which the line is dropped, where the image
    shows that the board ends before it, or where all of its corners are worse described than most.
    Fixed by "no margin" of `tests.benchmarks.corner_troubles`:
    a patterned ground had 3 corners of 5, by chance."""
    max_partial_displacement: float = 0.03
    """Distance of a corner from where the others expect it, squares, beyond which it does not speak
    for a border line that is not full."""
    max_alternating_places: float = 1 / 3
    """Share of the places around a lattice that alternate, beyond which the pattern goes on."""

    max_fit_shift: float = 0.1
    """Greatest distance that the edge fit may move a corner, squares ..."""
    min_fit_shift_limit: float = 1.0
    """... or px, whichever is more."""
    min_relative_contrast: float = 0.2
    """Least contrast of a corner, over the board's median; less as its light is less."""
    max_relative_residual: float = 4.0
    """Greatest residual of the edge fit, over the board's median ..."""
    max_residual_to_contrast: float = 0.15
    """... or over the corner's contrast, whichever is more ..."""
    max_residual_if_widened: float = 0.19
    """... if the covariance does not say how far the corner is drawn aside, or else this. Fixed by
    the trouble "shadow" of `tests.benchmarks.corner_troubles`."""
    max_edge_angle_sine: float = float(np.sin(np.radians(3.0)))
    """Sine of the angle between an edge and the step to its neighbours, beyond which the edge is
    askew ..."""
    max_relative_edge_angle: float = 10.0
    """... or the same sine over the board's median, which distortion raises, whichever is more."""
    max_even_contrast: float = 1.5
    """Contrast of a corner, over the board's median, beyond which its light is another."""
    suspect_relative_residual: float = 2.5
    """Residual of the edge fit, over the board's median, beyond which a corner is dropped if its
    edges are askew or if it lies astray."""
    max_relative_displacement: float = 6.0
    """Greatest distance of a corner of such a residual from where the grid map of the others places
    it, over their own rms distance from there ..."""
    max_displacement: float = 0.03
    """... or in px, whichever is more."""

    max_edge_blur: float = 0.18
    """Greatest median blur of a board's edges, squares: that of a sine wave would be 0.25. Fixed by
    the "waves"."""
    max_median_misfit: float = 0.25
    """Greatest median residual of the edge fit over the contrast. Fixed by the "waves"."""
    max_median_misfit_alone: float = 0.4
    """The same of a lattice that stands alone."""
    max_spread_if_blurred: float = 0.05
    """Greatest spread of the dark squares of such a lattice if its edges are wider than others may
    be, squares: that of discs that blur has joined is 0.08 and more."""

    image_border: float = 4.0
    """Width of the image's border in which no corner is expected to be found, px."""
    end_offset_along: float = 0.25
    """Distance along a line, from the places of the line beyond the board, at which the squares on
    either side of a place are sampled, steps ..."""
    end_offset_across: float = 0.2
    """... and the distance across, to inside and outside, steps."""
    cut_end_offset_across: float = 0.5
    """The distance to inside where the outermost squares may be cut, steps."""
    max_relative_behind: float = 0.15
    """Greatest difference behind the end of a board whose outermost squares may be cut, over that
    of the squares in front. At the dark edge of a fisheye's image it was 0.2 to 0.5 behind a line
    that was no end."""
    min_square_difference: float = 0.4
    """Least difference of neighbouring squares, over the contrast of the board's corners, where
    squares are seen."""
    min_end_places: int = 3
    """Number of places in the image from which on a line can show that the board ends."""
    min_ending_places: float = 0.6
    """Share of a line's places in the image that must show the end."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CheckerboardThresholds:
    """All thresholds of the search for a checkerboard, by step."""

    search: SearchThresholds = SearchThresholds()
    junctions: JunctionThresholds = JunctionThresholds()
    graph: GraphThresholds = GraphThresholds()
    growth: GrowthThresholds = GrowthThresholds()
    prefilter: PrefilterThresholds = PrefilterThresholds()
    separation: SeparationThresholds = SeparationThresholds()
    verification: VerificationThresholds = VerificationThresholds()


THRESHOLDS = CheckerboardThresholds()
"""The thresholds in use."""
