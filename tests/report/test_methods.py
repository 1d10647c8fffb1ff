"""What is said of methods: a dash for what is not estimated, and no more than the figures say."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from calibgui.engine.assessment.choices.method_comparison import MethodComparison
from calibgui.engine.boards import Board, Circles
from calibgui.report.methods import (
    QUANTITIES,
    MethodRow,
    describe_method_comparison,
    list_method_rows,
    tabulate_methods,
)
from tests.report.compared_methods import NOISE, TRUTH, compare_on_a_scene


@pytest.fixture(scope="module")
def comparison() -> MethodComparison:
    return compare_on_a_scene()


def list_by_name(comparison: MethodComparison) -> dict[str, MethodRow]:
    return {row.name: row for row in list_method_rows(comparison)}


def set_errors(comparison: MethodComparison, **unseen: float) -> MethodComparison:
    """Return the comparison with these methods only, and these errors on unseen views."""
    kept = {name.replace("_", "-"): error for name, error in unseen.items()}
    trials = {
        name: replace(comparison.trials[name], held_out=error) for name, error in kept.items()
    }
    methods = {name: comparison.methods[name] for name in kept}
    return replace(comparison, methods=methods, trials=trials, lines={}, refused={})


def test_every_method_has_a_row(comparison: MethodComparison) -> None:
    rows = list_method_rows(comparison)
    assert [row.name for row in rows] == list(comparison.methods)
    kinds = {kind: [row.name for row in rows if row.kind == kind] for kind in ("camera", "lines")}
    assert set(kinds["camera"]) == comparison.trials.keys() >= {"lucchese", "bouguet", "zhang"}
    assert set(kinds["lines"]) == comparison.lines.keys()
    for row in rows:
        assert row.title and row.source and row.limits
        assert row.is_usable == (row.kind == "camera")


def test_values_are_those_of_a_calibration_by_the_method(comparison: MethodComparison) -> None:
    row, found = list_by_name(comparison)["bouguet"], comparison.trials["bouguet"].calibration
    for i, name in enumerate(QUANTITIES[:4]):
        value, sigma = row.values[name]
        assert (value, sigma) == (found.camera.params[i], found.sigma[i])
        assert abs(value - TRUTH.params[i]) < 5 * sigma
    lengths = np.concatenate([np.hypot(*view.image.T) for view in found.residuals])
    assert row.rms == pytest.approx(np.sqrt(np.mean(lengths**2)))
    assert row.rms == pytest.approx(NOISE * math.sqrt(2), rel=0.1)
    assert NOISE < row.unseen < 0.2
    assert row.coefficients.startswith("k1 = -0.2") and " ± " in row.coefficients


def test_the_shift_is_that_of_the_lens(comparison: MethodComparison) -> None:
    """Brown-Conrady's radial polynomial gives the ideal radius of a measured one by a root."""
    rows = list_by_name(comparison)
    fx, radius = TRUTH.params[0], rows["bouguet"].radius
    k1, k2, k3 = TRUTH.params[[4, 5, 8]]
    roots = np.roots([k3, 0, k2, 0, k1, 0, 1, -radius / fx])
    ideal = min(r.real for r in roots if abs(r.imag) < 1e-9 and r.real > 0)
    for name in ("lucchese", "bouguet", "opencv", "stein"):
        shift = rows[name].shift
        assert shift is not None
        assert shift[0] == pytest.approx(radius - fx * ideal, rel=0.03)
        assert 0 < shift[1] < 2


def test_what_a_method_does_not_estimate_is_missing(comparison: MethodComparison) -> None:
    rows = list_by_name(comparison)
    assert rows["bouguet"].values.keys() == {"fx", "fy", "cx", "cy"}
    assert rows["bouguet-skew"].values.keys() == set(QUANTITIES)
    ideal = rows["zhang-closed-form"]
    assert ideal.shift is None and ideal.coefficients == "" and ideal.iterations is None
    for name in comparison.lines:
        assert rows[name].values.keys() <= {"cx", "cy"}
        assert "px^-2" in rows[name].coefficients
    text = tabulate_methods(comparison, Board(4, 5, 20.0, Circles()))
    assert " circles in " in text.splitlines()[0]
    skew = next(line for line in text.splitlines() if line.split()[:1] == ["bouguet"]).split()[5]
    assert skew == "-"


def test_the_skew_is_in_pixels(comparison: MethodComparison) -> None:
    found = comparison.trials["bouguet-skew"].calibration
    skew = found.camera.names.index("skew")
    value, sigma = list_by_name(comparison)["bouguet-skew"].values["skew"]
    assert value == pytest.approx(found.camera.params[0] * found.camera.params[skew])
    assert sigma == pytest.approx(found.camera.params[0] * found.sigma[skew])


def test_a_refused_method_says_why(comparison: MethodComparison) -> None:
    trials = {name: t for name, t in comparison.trials.items() if name != "zhang"}
    refused = replace(
        comparison, trials=trials, refused={**comparison.refused, "zhang": "The views do not fit."}
    )
    row = list_by_name(refused)["zhang"]
    assert (row.kind, row.values, row.is_usable) == ("refused", {}, False)
    assert row.remarks == ("The views do not fit.",)
    assert math.isnan(row.rms) and math.isnan(row.difference_rms) and row.shift is None
    text = " ".join(tabulate_methods(refused).split())
    assert f"- zhang ({row.title}): refused. The views do not fit." in text


def test_tables_fit_a_terminal(comparison: MethodComparison) -> None:
    lines = tabulate_methods(comparison).splitlines()
    assert max(map(len, lines)) <= 100
    assert lines[0].startswith("Methods of calibration on 648 corners in 6 views")
    assert "Errors, time, and difference from the chosen camera, that of lucchese" in lines
    marked = {line.split()[1] for line in lines if line.startswith("  *  ")}
    assert marked == comparison.lines.keys()
    assert not any("nan" in line.split() for line in lines)


def test_the_best_are_named_with_their_errors(comparison: MethodComparison) -> None:
    words = describe_method_comparison(
        set_errors(comparison, lucchese=0.1, bouguet=0.1019, opencv=0.103, zhang_closed_form=1.5)
    )
    assert words.startswith(
        "lucchese predicts unseen views best, with 0.1000 px RMS; within 2 % of it is bouguet. "
        "The others are off by so many px RMS more: opencv: 0.003; zhang-closed-form: 1.4. "
    )
    alone = describe_method_comparison(set_errors(comparison, bouguet=0.1, zhang=0.2))
    assert "; no other method comes within 2 % of it. The others are off" in alone
    unknown = set_errors(comparison, bouguet=math.nan)
    assert describe_method_comparison(unknown) == (
        "None of the methods could be tried on unseen views."
    )


def test_agreement_is_measured_in_the_methods_own_uncertainty(
    comparison: MethodComparison,
) -> None:
    both = set_errors(comparison, bouguet=0.1, opencv=0.1001)
    words = describe_method_comparison(both)
    assert "within two of their own standard deviations of bouguet's in opencv." in words
    trial = both.trials["opencv"]
    found = trial.calibration
    params = found.camera.params.copy()
    params[1] = both.trials["bouguet"].calibration.camera.params[1]
    params[1] += 7.31 * found.sigma[1]
    moved = replace(found, camera=replace(found.camera, params=params))
    trials = {**both.trials, "opencv": replace(trial, calibration=moved)}
    words = describe_method_comparison(replace(both, trials=trials))
    assert "No other method's focal lengths and centre all lie within two" in words
    assert "opencv (7.3)." in words


def test_methods_without_lengths_are_summed_up(comparison: MethodComparison) -> None:
    errors = [f"{t.held_out:.4f} px by {name}" for name, t in comparison.lines.items()]
    assert all(error in describe_method_comparison(comparison) for error in errors)
