"""The ablation's switches name what there is and switch it off and on; ledgers tell changes."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from calibgui.engine.boards.checkerboard import CHECKERBOARD
from calibgui.engine.corner_fit import verification
from calibgui.engine.features import lattice
from calibgui.engine.lattices import lattice_growth, pyramid_search
from tests.benchmarks.ablation.ledger import (
    Change,
    Entry,
    compare,
    describe_changes,
    read_ledger,
    write_ledger,
)
from tests.benchmarks.ablation.numbers import list_scalings
from tests.benchmarks.ablation.patching import (
    Switch,
    UnknownNameError,
    Watch,
    check_switch,
    combine,
    keeps,
    marks_none,
    says,
    switched_off,
)
from tests.benchmarks.ablation.rules import list_rules
from tests.benchmarks.ablation.runs import score, search
from tests.benchmarks.ablation.sets import RENDERED, Picture
from tests.benchmarks.ablation.switches import SWITCHES
from tests.benchmarks.ablation.table import Outcome, make_row
from tests.scenes.checkerboards import draw
from tests.scenes.conditions import Conditions

_RESIDUAL = np.array([1.0, 1.0, 1.0, 9.0])
_SUSPECTS = Switch("suspects", {"find_suspect_corners": marks_none})


@pytest.mark.parametrize("kind", SWITCHES)
def test_every_switch_names_what_there_is(kind: str) -> None:
    wrong = []
    for switch in SWITCHES[kind]:
        try:
            check_switch(switch)
        except UnknownNameError as error:
            wrong.append(f"{switch.name}: {error}")
    assert not wrong, "\n".join(wrong)


def test_no_two_switches_have_one_name() -> None:
    for switches in SWITCHES.values():
        assert len({switch.name for switch in switches}) == len(switches)


@pytest.mark.parametrize("name", ["find_no_such_thing", "BoardPriors.no_method", "_THRESHOLDS"])
def test_a_name_that_is_not_there_or_ambiguous_is_an_error_that_names_it(name: str) -> None:
    with pytest.raises(UnknownNameError, match=name.rpartition(".")[2]):
        check_switch(Switch("", {name: says(None)}))


def test_a_function_is_off_wherever_it_was_imported_and_on_again() -> None:
    before = verification.find_suspect_corners, pyramid_search.is_large_enough
    both = combine("both", [_SUSPECTS, Switch("", {"is_large_enough": says(False)})])
    assert verification.find_suspect_corners(_RESIDUAL).any()
    with pytest.raises(RuntimeError), switched_off(both):
        assert not verification.find_suspect_corners(_RESIDUAL).any()
        assert pyramid_search.is_large_enough is not before[1]
        raise RuntimeError
    assert (verification.find_suspect_corners, pyramid_search.is_large_enough) == before


def test_a_number_is_another_wherever_it_is_read_and_back_again() -> None:
    limit = verification.SUSPECT_RELATIVE_RESIDUAL
    name = "verification.SUSPECT_RELATIVE_RESIDUAL"
    with switched_off(Switch("", numbers={name: 100.0, "lattice.MAX_DEVIATION": 7.0})):
        assert not verification.find_suspect_corners(_RESIDUAL).any()
        assert (lattice.MAX_DEVIATION, lattice_growth.MAX_DEVIATION) == (7, 7)
    assert verification.SUSPECT_RELATIVE_RESIDUAL == limit
    assert lattice.MAX_DEVIATION == lattice_growth.MAX_DEVIATION < 1


def test_numbers_are_halved_and_doubled_and_integers_stay_above_0() -> None:
    scaled = {each.name: each.numbers for each in list_scalings("checkerboard")}
    name = "lattice_growth.MAX_POINTS_PER_PLACE"
    assert scaled[f"{name} x 0.5"] == {name: 3}
    assert scaled[f"{name} x 2"] == {name: 12}
    assert all(value != 0 for numbers in scaled.values() for value in numbers.values())


def test_rules_are_listed_by_what_they_return() -> None:
    names = {each.name for each in list_rules(["a_contrario", "lattice"])}
    assert {"a_contrario.is_meaningful: no", "a_contrario.is_meaningful: yes"} <= names
    assert {"lattice.find_closed_corners: none", "lattice.find_closed_corners: all"} <= names
    assert {"lattice.trim_lattice: nothing", "lattice.crop_lattice: as it was"} <= names
    known = Switch("", {"is_meaningful": says(True)})
    assert not any("meaningful" in each.name for each in list_rules(["a_contrario"], [known]))
    with pytest.raises(UnknownNameError, match="no such rooms: moved"):
        list_rules(["lattice", "moved"])


def test_a_switch_matters_where_its_function_returns_anything_else() -> None:
    first = Switch("first", {"compare_light": keeps(0)})
    watch = Watch([_SUSPECTS, first, Switch("silent", {"is_large_enough": says(True)})])
    with watch.watching():
        verification.find_suspect_corners(np.ones(4))
        verification.compare_light(np.ones(4))
        assert not watch.mattering
        verification.find_suspect_corners(_RESIDUAL)
        assert watch.mattering == {"suspects"}
        watch.start()
        verification.compare_light(2 * np.ones(4))
        assert watch.mattering == {"first"}
    assert watch.called == {"suspects", "first"}


def _enter(uv: list[list[float]], sigma: float = 0.05) -> Entry:
    cov = np.broadcast_to(sigma**2 * np.eye(2), (len(uv), 2, 2))
    grid = np.column_stack([np.zeros(len(uv)), np.arange(len(uv))]).astype(np.int64)
    return Entry(grid, np.array(uv), cov, digest=7, seconds=0.5)


def test_a_ledger_is_read_as_it_was_written(tmp_path: Path) -> None:
    entries = {"board": _enter([[1, 2], [30, 40]]), "none": _enter([])}
    entries["none"] = replace(entries["board"], uv=np.empty((0, 2)), error="ValueError: no")
    entries["none"] = replace(
        entries["none"], grid=np.empty((0, 2), np.int64), cov=np.empty((0, 2, 2))
    )
    write_ledger(tmp_path / "ledger.npz", entries)
    again = read_ledger(tmp_path / "ledger.npz")
    assert list(again) == ["board", "none"]
    for name, entry in entries.items():
        np.testing.assert_array_equal(again[name].uv, entry.uv)
        np.testing.assert_array_equal(again[name].cov, entry.cov)
        assert again[name].error == entry.error
        assert not compare(again[name], entry)


@pytest.mark.parametrize(
    ("uv", "sigma", "change"),
    [
        ([[1, 2], [30, 40], [60, 70]], 0.05, Change()),
        ([[1, 2], [30, 40.004]], 0.05, Change(0, 1)),
        ([[1, 2], [30, 40.006], [60, 70]], 0.05, Change(moved=1, farthest=0.006)),
        ([[1, 2], [30, 40], [60, 70]], 0.06, Change(widened=3)),
        ([[1, 2], [30, 48], [60, 70], [90, 9]], 0.05, Change(2, 1)),
        ([[30, 40], [1, 2], [60, 70]], 0.05, Change(renumbered=2)),
    ],
)
def test_what_moved_is_told(uv: list[list[float]], sigma: float, change: Change) -> None:
    told = compare(_enter([[1, 2], [30, 40], [60, 70]]), _enter(uv, sigma))
    assert told[:5] == change[:5]
    if change.farthest:
        assert told.farthest == pytest.approx(change.farthest)


def test_an_image_that_is_another_is_not_compared() -> None:
    one, other = _enter([[1.0, 2.0]]), _enter([[5.0, 2.0]])
    text = describe_changes({"a": one, "b": one}, {"a": other, "b": replace(other, digest=8)})
    assert "1 of 2 images differ" in text
    assert "b: the image itself is another" in text


def test_a_row_tells_what_a_switch_costs() -> None:
    scene = draw(Conditions(parts=2), 1, with_bound=True)
    picture = Picture(
        "board/1",
        RENDERED,
        scene.photograph(1),
        CHECKERBOARD,
        boards=(scene.uv,),
        bound=scene.bound,
    )
    found = {picture.name: search(picture)}
    scored = score(picture, found[picture.name])
    assert (scored.whole, scored.lost, scored.wrong) == (1, 0, 0)
    assert 0.7 < scored.ratio < 1.4
    assert 0.5 < scored.chi2 < 1.8
    with switched_off(Switch("", {"is_meaningful": says(False)})):
        lost = {picture.name: search(picture)}
    before = Outcome.of([picture], found)
    cells = make_row("chance", [picture], 1, before, lost).split(" | ")
    assert cells[:5] == ["| chance", "1", "1", "-1", "+54"]
    assert cells[-1] == "board/1 (54 lost) |"
