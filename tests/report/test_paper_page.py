"""The page that sets the paper beside ours: every number in its place."""

from __future__ import annotations

import re
from dataclasses import replace
from html import unescape

import numpy as np
import pytest

from calibgui.dataset import ViewStatus
from calibgui.engine.calibration.refinement.covariances import make_paper_table
from calibgui.engine.calibration.result import Cost
from calibgui.report import printed_values
from calibgui.report.paper_page import make_paper_page
from calibgui.report.paper_stage_one import examine_stage_one
from calibgui.report.paper_tables import Reproduction, make_table_of_others, stack_stage_one
from tests.report.paper_run import calibrate_paper_views

TABLES = ("Table 1", "Table 2", "Section 5.1", "Table 3", "Other figures")


@pytest.fixture(scope="module")
def run() -> Reproduction:
    return Reproduction(
        by_method={
            name: calibrate_paper_views(seed) for seed, name in enumerate(["edges", "saddle"])
        },
        method="edges",
        image_cost=calibrate_paper_views(0, cost=Cost.IMAGE),
        synthetic=calibrate_paper_views(2),
        extrinsic_errors=np.full((25, 6), 1e-4),
    )


def read_tables(page: str) -> dict[str, list[list[str]]]:
    """The cells of each table of the page, by the heading above it."""
    found = re.findall(r"<h2>([^<]*)</h2>\s*<div[^>]*><table>(.*?)</table>", page, re.DOTALL)
    return {
        unescape(heading): [
            [unescape(cell) for cell in re.findall(r"<t[hd](?: [^>]*)?>(.*?)</t[hd]>", row)]
            for row in re.findall(r"<tr>(.*?)</tr>", table, re.DOTALL)
        ]
        for heading, table in found
    }


@pytest.fixture(scope="module")
def page(run: Reproduction) -> str:
    return make_paper_page(run, {"Figure 4: a < b": "figure-4.png"})


def find_table(page: str, heading: str) -> list[list[str]]:
    (table,) = (table for name, table in read_tables(page).items() if name.startswith(heading))
    return table


def test_tables_are_rectangular(page: str) -> None:
    tables = read_tables(page)
    assert len(tables) == len(TABLES)
    for heading in TABLES:
        assert len({len(row) for row in find_table(page, heading)}) == 1


def test_table_1_sets_saddle_points_beside_edges(run: Reproduction, page: str) -> None:
    head, *rows = find_table(page, "Table 1")
    assert head[1:4] == ["xp, px: printed", "saddle points ± SD", "edges"]
    evidence = examine_stage_one(run.by_method["saddle"], np.array(printed_values.TABLE_1))
    for k, row in enumerate(rows[:25]):
        saddle, edges = (
            run.by_method[name].calibration.stage_one[k] for name in ("saddle", "edges")
        )
        assert row[0] == str(k + 1)
        assert [float(cell.split(" ± ")[0]) for cell in row[1:10]] == pytest.approx(
            [
                *(printed_values.TABLE_1[k][0], saddle.xp, edges.xp),
                *(printed_values.TABLE_1[k][1], saddle.yp, edges.yp),
                *(printed_values.TABLE_1[k][2] * 1e7, saddle.k1 * 1e7, edges.k1 * 1e7),
            ],
            abs=6e-5,
        )
        sd = [float(row[column].split(" ± ")[1]) for column in (2, 5, 8)]
        assert sd == pytest.approx(evidence.sd[k] * [1, 1, 1e7], abs=6e-3)
        assert float(row[10]) == pytest.approx(saddle.rms, abs=6e-5)
        assert float(row[11]) == pytest.approx(evidence.held_rms[k], abs=6e-5)


def test_table_1_ends_with_what_all_views_say(run: Reproduction, page: str) -> None:
    mean, scatter, together = find_table(page, "Table 1")[-3:]
    saddle = stack_stage_one(run.by_method["saddle"])
    assert [float(mean[1]), float(mean[4])] == pytest.approx(printed_values.TABLE_1_MEAN, abs=1e-4)
    assert float(mean[2]) == pytest.approx(saddle[:, 0].mean(), abs=6e-5)
    assert float(scatter[5]) == pytest.approx(saddle[:, 1].std(ddof=1), abs=6e-5)
    stage_two = make_paper_table(run.by_method["edges"].calibration)[0]
    assert float(together[1]) == printed_values.TABLE_2[0]
    assert float(together[6]) == pytest.approx(stage_two[1], abs=6e-5)


def test_bouguets_result_as_printed_and_in_our_frame(page: str) -> None:
    head, xp, yp, fx, fy, sigma = find_table(page, "Section 5.1")
    assert head[4:] == ["ours, edges", "ours, saddle points", "ours, edges, image cost"]
    assert xp[1:4] == ["-16.48 (0.94)", "-17.03 (0.58)", "-16.53 ± 0.19"]
    assert yp[1:4] == ["-2.90 (0.97)", "-2.50 (0.55)", "-3.00 ± 0.18"]
    assert fx[1:4] == ["656.66 (0.71)", "657.25 (0.28)", "657.250 ± 0.093"]
    assert fy[1:4] == ["657.83 (0.57)", "657.68 (0.29)", "657.680 ± 0.097"]
    assert sigma[1:4] == ["0.091, 0.107", "0.119, 0.116", "0.119, 0.116"]
    assert "prints three standard deviations" in " ".join(page.split())


def test_our_columns_are_those_of_their_headings(run: Reproduction, page: str) -> None:
    _, *rows = find_table(page, "Section 5.1")
    results = [run.by_method["edges"], run.by_method["saddle"], run.image_cost]
    for column, result in enumerate(results, start=4):
        values, sigma, _ = make_paper_table(result.calibration)
        for row, k in zip(rows, (0, 1, 8, 9), strict=False):
            value, one_sigma = map(float, row[column].split(" ± "))
            assert value == pytest.approx(values[k], abs=0.06 * sigma[k])
            assert one_sigma == pytest.approx(sigma[k], rel=0.06)


@pytest.mark.parametrize("method", ["edges", "saddle"])
def test_table_2_is_from_the_corners_asked_for(run: Reproduction, method: str) -> None:
    table = find_table(make_paper_page(replace(run, method=method), {}), "Table 2")
    values = make_paper_table(run.by_method[method].calibration)[0]
    assert [float(row[2]) for row in table[1:]] == pytest.approx(values, rel=1e-5)


def test_the_largest_error_is_named_by_the_number_of_its_view(run: Reproduction) -> None:
    """The third synthetic view was not found, so the errors' fourth row is that of view 5."""
    views = list(run.synthetic.views)
    views[2] = replace(views[2], status=ViewStatus.NO_BOARD, corners=None)
    calibration = run.synthetic.calibration
    fewer = replace(calibration, poses=calibration.poses[:24])
    errors = np.full((24, 6), 1e-4)
    errors[3, 2] = 0.02
    lost = replace(run.synthetic, calibration=fewer, views=tuple(views))
    table = make_table_of_others(replace(run, synthetic=lost, extrinsic_errors=errors))
    text = " ".join(cell for row in table.rows for cell in row)
    theta = run.real.paper_poses()[4].theta
    assert f"2.000 % (θ of view 5, which is {theta:.2g} rad)" in text


def test_captions_are_escaped(page: str) -> None:
    assert '<img src="figure-4.png" alt="Figure 4: a &lt; b">' in page
