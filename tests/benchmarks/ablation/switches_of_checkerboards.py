"""What can be switched off of the finder of checkerboards and of the fit of their corners.

First the candidates of earlier ablations, most of them a whole mechanism; then one by one what else
chooses, drops, refuses or doubts, and what corrects a corner; in the end groups.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from calibgui.engine.corner_fit.board_priors import BoardPriors
from tests.benchmarks.ablation.patching import (
    Call,
    Switch,
    combine,
    keeps,
    marks_all,
    marks_none,
    says,
)
from tests.benchmarks.ablation.rules import list_rules

_NEVER, _ALWAYS = says(False), says(True)
_NOTHING = says(None)
_WHOLE = 0.5
"""How far from a corner its squares reach, squares."""


def _fit_all(_: Call, lattice: Any, fit_corners: Any, *__: Any, **___: Any) -> Any:
    """Fit all corners, whatever disturbs them."""
    return fit_corners(lattice)[0], np.zeros(len(lattice))


def _do_not_follow(_: Call, board: Any, edges: Any, *__: Any) -> Any:
    """Take the geometry of edges from the corners alone."""
    return BoardPriors.follow_edges(board, edges, math.inf)


def _choose_strongest(_: Call, __: Any, boards: list[Any], may_be_wanted: Any) -> Any:
    """Choose the board of the strongest edges, be it a floor."""
    boards.sort(key=lambda board: board.edge_strength, reverse=True)
    return next(filter(may_be_wanted, boards), None)


def _match_colours_only(
    _: Call, template: Any, image: Any, uv: Any, right: Any, down: Any, dark: Any, *rest: Any
) -> Any:
    """Match the colours of the squares, but not the picture of a corner."""
    light = rest[1] if len(rest) > 1 else 1.0
    return template.match_colours(image, uv, right, down, dark, light)


def _match_whole_patch(call: Call, _: Any, __: Any, bare_reach: float, *___: Any) -> Any:
    """Match no corner that looks like the others near by only."""
    return call() if bare_reach >= _WHOLE else np.zeros_like(call())


def _read_near_arms(*_: Any) -> Any:
    """Read what is near the corners once, and then whole edges."""
    return np.array([9.0])


def _sort_by_size(_: Call, candidates: list[Any]) -> Any:
    """Keep parts of other candidates."""
    return sorted(candidates, key=lambda each: len(each.lattice), reverse=True)


_CANDIDATES = [
    Switch("creases, piles", {"separate_boards": lambda _, lattice, *__: [lattice]}),
    Switch("dead pixels", {"repair_dead_pixels": _NOTHING}),
    Switch("doubtful border lines", {"find_doubtful_lines": marks_none}),
    Switch("stray border lines", {"drop_stray_lines": keeps(0)}),
    Switch("undisturbed fit", {"fit_robustly": _fit_all}),
    Switch("near fit of suspect corners", {"fit_near": keeps(3)}),
    Switch("displaced corners", {"find_displaced_corners": marks_none}),
    Switch("askew edges", {"find_askew_corners": marks_none}),
    Switch("compare residuals by contrast", {"compare_residuals": keeps(0)}),
    Switch("compare light", {"compare_light": marks_all}),
    Switch("near template", {"verification._match_template": _match_whole_patch}),
    Switch(
        "off-map second opinion",
        {
            "_measure_off_map": lambda call, *_: np.full_like(call(), np.inf),
        },
    ),
    Switch("gaps tried again", numbers={"_MAX_GAP_ROUNDS": 1}),
    Switch(
        "prefilter",
        {
            "find_objection": says(""),
            "find_early_objection": says(""),
            "prefilter.is_hopeless": _NEVER,
        },
    ),
    Switch("prefilter: beyond doubt", {"_is_beyond_doubt": _NEVER}),
    Switch("prefilter: bulge", {"_do_edges_bulge": _NEVER}),
    Switch("prefilter: spreads", {"_measure_deviation": says(0.0)}),
    Switch("stands alone", {"stands_alone": _NEVER}),
    Switch("a contrario: boards", {"is_meaningful": _ALWAYS}),
    Switch("step edges", {"has_step_edges": _ALWAYS}),
    Switch("too wide edges", {"are_edges_too_wide": _NEVER}),
    Switch("parted junctions", numbers={"_MIN_PARTED_LEVEL_SIDE": 10**6}),
    Switch("texture counter", {"_Texture.is_one_too_many": _NEVER}),
    Switch("remember refused candidates", {"find_same": _NOTHING}),
    Switch("small squares wait", {"_is_resolved": _ALWAYS}),
    Switch("whole boards do not grow", {"is_whole": _NEVER}),
    Switch("edges followed", {"LatticePriors.follow_edges": _do_not_follow}),
    Switch("edges followed: lens", {"fit_lenses_to_edges": lambda call, *_: call()[:1]}),
    Switch("hard edges", {"has_hard_edges": _NEVER}),
    Switch(
        "stray light",
        {"estimate_stray_light": lambda _, shift, *__: (0.0, np.zeros(len(shift)))},
    ),
    Switch("local light", {"find_uneven_light": marks_none}),
    Switch("light between edges", {"read_between_edges": marks_none}),
    Switch("noise in common", {"estimate_growth": says(1.0)}),
    Switch("noise pooled over the board", {"pool_noise": keeps(0)}),
    Switch("light moves corners", {"correct_for_light": keeps(0)}),
    Switch("ink spread", {"_estimate_ink_spread": marks_none}),
    Switch("long arms approached", {"_choose_reaches": _read_near_arms}),
]
"""Those of which earlier ablations told what they are worth."""

_JUNCTIONS = [
    Switch("junctions: asymmetry", numbers={"x_junctions._MAX_ASYMMETRY": math.inf}),
    Switch("junctions: least angle of edges", numbers={"x_junctions._MIN_EDGE_ANGLE": 0.0}),
    Switch("junctions: stay near their pixel", numbers={"x_junctions._MAX_SHIFT": math.inf}),
    Switch("junctions: at most 3,000", numbers={"MAX_CANDIDATES": 10**6}),
    Switch("graph: edges that close cells first", {"_find_closing_edges": marks_all}),
    Switch("graph: joined blocks", numbers={"neighbour_graph._MAX_JOINED_BLOCK": 10**9}),
    Switch("graph: too sparse", numbers={"neighbour_graph._MAX_CELLS_PER_JUNCTION": 10**6}),
    Switch("graph: edge between neighbours", numbers={"neighbour_graph._MIN_EDGE_STEP": -1e9}),
    Switch("lattice: strays", {"_find_strays": marks_none}),
    Switch("lattice: isolated corners", {"drop_isolated": keeps(0)}),
    Switch("lattice: scattered", {"is_scattered": _NEVER}),
    Switch("lattice: full block of few corners", {"_has_full_block": _ALWAYS}),
]
_SEARCH = [
    Switch("search: lattices refused at once", {"pyramid_search._refuse": _NEVER}),
    Switch("search: refused before growth", {"_drop_refused": keeps(0)}),
    Switch("search: texture, ragged growth", {"_Texture.takes": lambda _, __, each: each is None}),
    Switch("search: parts of others", {"_drop_parts": _sort_by_size}),
    Switch("search: surely complete", {"_is_surely_complete": _NEVER}),
    Switch("search: judge before growth", numbers={"MIN_JUDGED_CORNERS": 10**9}),
    Switch("search: grown lattices", numbers={"pyramid_search._MAX_GROWN_LATTICES": 10**6}),
    Switch("growth", {"pyramid_search.grow_lattice": keeps(0)}),
    Switch(
        "growth: over gaps", {"_predict_by_grid_map": lambda call, *_: np.full_like(call(), np.nan)}
    ),
    Switch("growth: hopeless", {"prefilter.is_hopeless": _NEVER}),
    Switch("growth: free points", {"_are_free": marks_all}),
    Switch("growth: slow rounds", numbers={"lattice_growth._MAX_SLOW_ROUNDS": 10**6}),
    Switch("growth: ragged rounds", numbers={"lattice_growth._MAX_RAGGED_ROUNDS": 10**6}),
    Switch("template: picture of a corner", {"CornerTemplate.match": _match_colours_only}),
    Switch("template: light", {"measure_light": marks_all}),
    Switch("template: nearer at the border", {"_shorten_at_border": marks_all}),
]
_PREFILTER = [
    Switch("prefilter: early", {"find_early_objection": says("")}),
    Switch("prefilter: crossing", {"check_crossing": says((True, True))}),
    Switch("prefilter: width", {"prefilter._measure_width": says(0.0)}),
    Switch("prefilter: pattern goes on", {"does_pattern_continue": _NEVER}),
    Switch("prefilter: plain crossing", {"is_plain_crossing": _NEVER}),
    Switch("prefilter: spread of ink", {"_is_spread_of_ink": _NEVER}),
    Switch("prefilter: unevenness alone", {"_measure_unevenness": says(0.0)}),
    Switch(
        "prefilter: directions differ",
        numbers={"prefilter._MAX_DIRECTION_DIFFERENCE": math.inf},
    ),
]
_SEPARATION = [
    Switch("separation: creases", {"_cut_at_crease": _NOTHING}),
    Switch("separation: even corners", {"_find_even_corners": marks_none}),
]
_ENDS = [
    Switch("ends", {"find_ends": says((False,) * 4)}),
    Switch("ends: beyond an empty line", {"_drop_beyond_ends": keeps(0)}),
    Switch("ends: sparse first row", {"_is_first_row_sparse": _NEVER}),
    Switch("ends: lies around", {"lies_around": _NEVER}),
    Switch("ends: board on a floor", {"_choose_board": _choose_strongest}),
    Switch("ends: alternates above", {"_does_alternate_above": _NEVER}),
]
_VERIFICATION = [
    Switch("verification: sound corners", {"find_sound_corners": lambda _, each, *__: each.found}),
    Switch("verification: template", {"verification._match_template": marks_all}),
    Switch("verification: too many fail", {"is_credible": _ALWAYS}),
    Switch("verification: described corners", {"find_described_corners": marks_all}),
    Switch("verification: suspect corners", {"find_suspect_corners": marks_none}),
    Switch("verification: tolerable displacement", {"find_tolerable_displacements": marks_all}),
    Switch("verification: shift of the fit", {"limit_fit_shift": says(np.inf)}),
    Switch("verification: usable covariances", {"find_usable_covariances": marks_all}),
    Switch("verification: gaps filled", {"fill_gaps": keeps(0)}),
    Switch("verification: noise of pixels", {"estimate_pixel_noise": says(0.0)}),
    Switch("verification: rounds", numbers={"board_refinement._MAX_ROUNDS": 1}),
    Switch("verification: lone corners", {"find_closed_corners": marks_all}),
    Switch("verification: rounds of the rest", numbers={"robust_fit._MAX_ROUNDS": 1}),
    Switch("saddle: overlap or part", {"_do_squares_overlap_or_part": _NEVER}),
    Switch(
        "verification: contrast",
        numbers={"corner_template.MIN_RELATIVE_CONTRAST": -math.inf},
    ),
    Switch(
        "verification: residual",
        numbers={"verification._MAX_RELATIVE_RESIDUAL": math.inf},
    ),
    Switch(
        "verification: grid map",
        numbers={"verification._MAX_GRID_MAP_RMS": math.inf},
    ),
]
_FIT = [
    Switch("fit: gradients of the light", {"BoardPriors.estimate_gradients": marks_none}),
    Switch("fit: broken gradients", {"_find_broken": marks_none}),
    Switch(
        "fit: covariance of gradients", {"LatticePriors.estimate_gradient_covariances": marks_none}
    ),
    Switch("fit: gradients as unknowns", {"add_gradients": keeps(4)}),
    Switch("fit: covariance of bends", {"_compute_bend_covariance": marks_none}),
    Switch("fit: bend", {"_correct_for_bend": lambda _, model, *__: model}),
    Switch("fit: light of whole arms", {"correct_for_light_told": keeps(0)}),
    Switch("fit: odd noise", {"corner_noise.estimate_noise": keeps(0)}),
    Switch("fit: least noise", numbers={"ROUNDING_VARIANCE": 0.0}),
    Switch("fit: pull of local light", {"_estimate_pull": marks_none}),
    Switch("fit: clipped corners", {"find_clipped_corners": marks_none}),
    Switch("fit: stray light taken", {"go_to_own_light": keeps(0)}),
    Switch("fit: blurs of one anisotropy", {"estimate_blur_difference": marks_none}),
    Switch("fit: limited steps", {"x_corner_step._limit_step": keeps(0)}),
    Switch(
        "fit: edges followed along lines",
        {"_follow_lines": lambda call, *_: call()._replace(misfit=math.inf)},
    ),
    Switch("fit: weak lens of edges", {"edge_lens_fit._fit_lenses": says([])}),
    Switch("fit: what edges lack of the map", numbers={"edge_lens_fit.MIN_CORNERS": 10**6}),
]

_WORTHLESS_BEFORE = [
    "doubtful border lines",
    "stray border lines",
    "off-map second opinion",
    "prefilter: bulge",
    "a contrario: boards",
    "texture counter",
    "remember refused candidates",
]
"""What an earlier ablation found to change nothing."""
_BY_NAME = {switch.name: switch for switch in _CANDIDATES}
_GROUPS = [
    combine("ALL that changed nothing before", [_BY_NAME[name] for name in _WORTHLESS_BEFORE]),
    combine(
        "ALL of stray, local and flat light",
        [_BY_NAME[name] for name in ("stray light", "local light", "light between edges")],
    ),
    combine("ALL of the ends but where boards end", [*_ENDS[1:5], _BY_NAME["stands alone"]]),
    combine(
        "ALL of disturbed corners",
        [_BY_NAME[n] for n in ("undisturbed fit", "near fit of suspect corners")],
    ),
]
_BY_HAND = [
    *_CANDIDATES,
    _GROUPS[0],
    *_VERIFICATION,
    *_PREFILTER,
    *_SEARCH,
    *_JUNCTIONS,
    *_SEPARATION,
    *_ENDS,
    *_FIT,
    *_GROUPS[1:],
]
_ROOMS = ("checkerboard", "features", "lattices", "corner_fit", "lattice", "grid_map")
"""The rooms and files of the finder, those that are to come among them."""
CHECKERBOARD = [*_BY_HAND, *list_rules(_ROOMS, _BY_HAND)]
