"""Page of HTML that sets every number printed in the paper beside ours."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from calibgui.formats.origin import PAPER_PAGE, make_mark
from calibgui.report import paper_tables, printed_values
from calibgui.report.figures import LOCATED_BY
from calibgui.report.paper_stage_one import StageOneEvidence, examine_stage_one
from calibgui.report.paper_tables import Reproduction
from calibgui.report.rendering import render_page

_PAPERS_METHOD = "saddle"
"""The method by which the paper locates corners."""

_ABOUT_BOUGUET = """\
The paper calls the intervals of Bouguet's result (in brackets) SDs; his toolbox prints three
standard deviations, so that they are divided by 3 in the next column. The paper gives his
principal point from u = W/2, v = H/2 (pixels counted from 0); the centre of the array is half a
pixel before that, which adds 0.5 px to xp and takes 0.5 px from yp. The paper's own SDs do not
know the residuals (see above). ± is one standard deviation, by the noise of corners alone but in
the last column, where it knows also how far board, lens and single views are from what is
assumed; the columns differ by no more than that allows. The residuals are those of each one's own
corners; the paper's are approximated by eq. 50, ours are exact. Bouguet's lens model distorts
ideal points where the paper's corrects measured ones, so that their coefficients cannot be
compared."""


def make_paper_page(reproduction: Reproduction, figures: Mapping[str, str]) -> str:
    """Make the page, as HTML.

    Args:
        reproduction: the calibrations to set beside the paper.
        figures: file names of the figures, by their captions.
    """
    printed = np.array(printed_values.TABLE_1)
    papers = reproduction.by_method[_PAPERS_METHOD]
    evidence = examine_stage_one(papers, printed)
    ours = {_PAPERS_METHOD: papers, **reproduction.by_method}
    tables = [
        (
            "Table 1: Stage I",
            paper_tables.make_table_1(ours, evidence),
            _explain_table_1(reproduction, evidence),
        ),
        (
            "Table 2: intrinsics from the real images",
            paper_tables.make_intrinsics_table(
                reproduction.real.calibration, printed_values.TABLE_2, printed_values.TABLE_2_SD
            ),
            "",
        ),
        (
            "Section 5.1: Bouguet's result on the same images",
            paper_tables.make_bouguet_table(reproduction),
            _ABOUT_BOUGUET,
        ),
        (
            "Table 3: intrinsics from the synthetic images",
            paper_tables.make_intrinsics_table(
                reproduction.synthetic.calibration,
                printed_values.TABLE_3,
                printed_values.TABLE_3_SD,
            ),
            "",
        ),
        ("Other figures in the text", paper_tables.make_table_of_others(reproduction), ""),
    ]
    return render_page(
        "paper.html",
        make_mark(PAPER_PAGE),
        located_by=LOCATED_BY[reproduction.method],
        tables=tables,
        figures=figures,
    )


def _explain_table_1(reproduction: Reproduction, evidence: StageOneEvidence) -> str:
    """Explain why xp and yp of single views differ from the printed ones, with the evidence."""
    printed = np.array(printed_values.TABLE_1)
    views = {m: paper_tables.stack_stage_one(r) for m, r in reproduction.by_method.items()}
    ours = views[_PAPERS_METHOD]
    difference = ours - printed
    in_sd = np.sqrt(np.mean((difference / evidence.sd) ** 2, axis=0))
    own = [row.rms for row in reproduction.by_method[_PAPERS_METHOD].calibration.stage_one]
    own_rms, held_rms = (np.sqrt(np.mean(np.square(rms))) for rms in (own, evidence.held_rms))
    scatter = ours.std(axis=0, ddof=1)
    means = " and ".join(
        f"{values[:, 0].mean():.1f} px by our {LOCATED_BY[method]}"
        for method, values in views.items()
    )
    left = np.count_nonzero(difference[:, 0] < 0)
    return (
        "The paper locates corners by saddle points. From ours, single views give principal points "
        f"that differ from the printed ones by up to {np.abs(difference[:, :2]).max():.1f} px, "
        "because one view hardly determines them: moving the principal point is nearly the same "
        "as tilting the board. If the printed xp, yp and k1 are held in every view and the "
        "homography alone is fitted, our saddle points are registered within "
        f"{held_rms:.4f} reference px rms instead of {own_rms:.4f}. Measured by a view's own SD "
        f"the differences are {in_sd[0]:.1f} in xp, {in_sd[1]:.1f} in yp and {in_sd[2]:.1f} in k1 "
        "(root mean square). This SD takes residuals for noise of single corners. It does not "
        "contain what the corners of a view share because a lens has more than k1 and no board is "
        "quite flat; the scatter of the views does, since all have the same principal point: "
        f"{scatter[0]:.1f} px in xp and {scatter[1]:.1f} px in yp. That our xp lies to the left of "
        f"the printed one in {left} of {len(printed)} views is not chance but an error of this "
        "kind. How corners are located is enough to make one: the mean xp is "
        f"{printed[:, 0].mean():.1f} px printed, {means}. All views together determine the "
        "principal point, and there Stage II comes close to the paper's (last row, and 5.1 below)."
    )
