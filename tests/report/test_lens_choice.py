"""What is said of lens models: figures against the formulas, and a reason for every outcome."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

from calibgui.engine.assessment.choices.lens_choice import LensChoice, choose_lens
from calibgui.engine.assessment.choices.lens_trial import LensTrial
from calibgui.engine.boards import Board, Circles
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.models import MODELS
from calibgui.report.lens_choice import (
    describe_lens_choice,
    format_lens_options,
    list_lens_rows,
    tabulate_lens_choice,
)
from calibgui.report.lens_models import describe_lens_model, get_lens_title
from tests.engine.scenes import VGA, barrel, looking, scene, seen

FISHEYE = Camera(VGA, [235, 234, 318, 243, -0.05, 4e-3, -3e-3, 4e-4], "kannala-brandt")


def photograph_fisheye() -> list[Observation]:
    """Return views of a board that reaches far off the axis, with 0.1 px of noise."""
    rng = np.random.default_rng(1)
    poses = [looking(FISHEYE, rng, fill=(0.8, 2.0)) for _ in range(6)]
    return seen(FISHEYE, poses, partial=True).noisy(0.1, rng)


@pytest.fixture(scope="module")
def kept() -> LensChoice:
    """A choice on views of a mild lens."""
    views = scene(barrel(), 6, seed=1).noisy(0.1, np.random.default_rng(2))
    return choose_lens(views, VGA, ("pinhole", "brown-conrady-4", "lucchese"))


@pytest.fixture(scope="module")
def fisheye() -> LensChoice:
    """A choice on views of a fisheye lens."""
    candidates = ("lucchese", "kannala-brandt", "kannala-brandt-decentering")
    return choose_lens(photograph_fisheye(), VGA, candidates)


def change(choice: LensChoice, model: str, **changes: object) -> LensChoice:
    """Return the choice with another trial of one model."""
    trial = replace(choice.trials[model], **changes)
    return replace(choice, trials={**choice.trials, model: trial})


def solve_angle(radius: float, k: np.ndarray) -> float:
    """Return the angle, degrees, that Kannala and Brandt's polynomial images at a radius."""
    image = lambda t: t * (1 + k @ t ** np.array([2, 4, 6, 8])) - radius  # noqa: E731
    return float(np.rad2deg(brentq(image, 0.0, 2.6, xtol=1e-14)))


def test_figures_are_those_of_the_residuals(fisheye: LensChoice) -> None:
    rows = {row.model: row for row in list_lens_rows(fisheye)}
    for model, trial in fisheye.trials.items():
        row, image = rows[model], np.vstack([v.image for v in trial.calibration.residuals])
        assert row.rms == pytest.approx(np.sqrt((image**2).sum() / len(image)))
        assert (row.sigma_x, row.sigma_y) == pytest.approx(np.std(image, axis=0))
        assert row.corners == len(image)
        if trial.validation is not None:
            unseen = np.sort(trial.validation.lengths)
            assert row.unseen_rms == pytest.approx(np.sqrt((unseen**2).mean()))
            assert row.unseen_median == pytest.approx(np.median(unseen))
            assert np.mean(unseen <= row.unseen_p95) == pytest.approx(0.95, abs=1e-3)
    assert list(rows)[-1] == "lucchese" and np.isnan(rows["lucchese"].unseen_rms)
    for model, count in (("kannala-brandt", 8), ("kannala-brandt-decentering", 10)):
        assert rows[model].parameters == count
    a, b = (rows[model] for model in ("kannala-brandt-decentering", "kannala-brandt"))
    n = 2 * a.corners
    expected = 2 * n * np.log(a.rms / b.rms) + 2 * np.log(n)
    assert a.bic - b.bic == pytest.approx(expected, abs=1e-6)
    assert min(row.bic for row in rows.values()) == 0


def test_angles_are_those_of_the_printed_formula(fisheye: LensChoice) -> None:
    row = next(row for row in list_lens_rows(fisheye) if row.model == "kannala-brandt")
    camera = fisheye.trials["kannala-brandt"].calibration.camera
    fx, fy, cx, cy, *k = camera.params
    k = np.array(k)
    w, h = VGA
    corners = [
        solve_angle(np.hypot((u - cx) / fx, (v - cy) / fy), k)
        for u, v in ((-0.5, -0.5), (w - 0.5, h - 0.5))
    ]
    expected = (
        solve_angle((cx + 0.5) / fx, k) + solve_angle((w - 0.5 - cx) / fx, k),
        solve_angle((cy + 0.5) / fy, k) + solve_angle((h - 0.5 - cy) / fy, k),
        sum(corners),
    )
    assert row.field_of_view == pytest.approx(expected, abs=1e-6)
    seen = np.vstack([view.uv for view in photograph_fisheye()])
    radii = np.hypot(*((seen - [cx, cy]) / [fx, fy]).T)
    assert row.largest_angle == pytest.approx(solve_angle(radii.max(), k), abs=1e-6)


def test_tables_fit_a_terminal_and_mark_the_recommended(
    kept: LensChoice, fisheye: LensChoice
) -> None:
    for choice in (kept, fisheye):
        text = tabulate_lens_choice(choice)
        assert max(map(len, text.splitlines())) <= 80, text
        marked = [line.split()[1] for line in text.splitlines() if line.startswith("  * ")]
        assert marked == [choice.model] * 2
        assert "corners in 6 views" in text
        assert "circles in 6 views" in tabulate_lens_choice(choice, Board(4, 5, 20.0, Circles()))
    unknown = replace(fisheye, refused={"mei": "The corners do not fit."})
    assert "- mei: cannot be calibrated. The corners do not fit." in tabulate_lens_choice(unknown)


def test_the_papers_model_is_kept_where_nothing_speaks_against_it(kept: LensChoice) -> None:
    error = kept.trials["lucchese"].held_out
    assert describe_lens_choice(kept) == (
        f"The paper's model (Lucchese) is kept: it predicts unseen views with {error:.3f} px RMS, "
        "and no other model that these views determine does noticeably better."
    )
    shaken = change(kept, "lucchese", is_valid_at_corners=False)
    assert describe_lens_choice(shaken).endswith(
        "No model is without reservations; of this one: folds within the corners: there it is not "
        "one-to-one."
    )


def test_coefficients_that_the_views_leave_open_are_named(kept: LensChoice) -> None:
    held = change(kept, "lucchese", fixed={"k3": 0.0, "k2": 0.0})
    assert describe_lens_choice(held).startswith(
        "The paper's model (Lucchese, with k3, k2 held at 0) is kept: it predicts "
    )
    row = next(row for row in list_lens_rows(held) if row.model == "lucchese")
    assert row.held == ("k3", "k2") and row.is_eligible
    assert row.remarks == ("k3, k2 held at 0: left open by these views",)
    assert "- lucchese: k3, k2 held at 0" in tabulate_lens_choice(held)


def test_coefficients_that_harm_are_named_with_what_they_cost(kept: LensChoice) -> None:
    whole = replace(kept.trials["lucchese"], fixed={"k3": 0.0})
    assert whole.validation is not None
    lengths = 0.345 / whole.held_out * whole.validation.lengths
    worse = replace(whole, validation=replace(whole.validation, lengths=lengths))
    held = change(kept, "lucchese", fixed={"k3": 0.0, "p1": 0.0, "p2": 0.0}, fuller=worse)
    error = held.chosen.held_out
    assert describe_lens_choice(held).startswith(
        "The paper's model (Lucchese, with k3, p1, p2 held at 0) is kept: it predicts unseen views "
        f"with {error:.3f} px RMS (0.345 px with p1, p2 estimated), and no other "
    )
    row = next(row for row in list_lens_rows(held) if row.model == "lucchese")
    assert row.held == ("k3", "p1", "p2") and row.is_eligible
    assert row.remarks == (
        "k3 held at 0: left open by these views",
        "p1, p2 held at 0: they may be 0, and unseen views are predicted better without "
        f"({error:.3f} instead of 0.345 px RMS)",
    )


def test_the_recommended_model_is_given_as_options_of_calibrate(kept: LensChoice) -> None:
    assert format_lens_options(kept) == "--model lucchese"
    held = change(kept, "lucchese", fixed={"k3": 0.0, "p1": 0.0})
    assert format_lens_options(held) == "--model lucchese --fix k3=0,p1=0"
    line = "- To calibrate with it: --model lucchese --fix k3=0,p1=0"
    assert line in tabulate_lens_choice(held).splitlines()


def test_there_is_a_reason_for_another_model(fisheye: LensChoice) -> None:
    choice = replace(
        fisheye,
        model="kannala-brandt",
        errors={"kannala-brandt": 0.0312, "kannala-brandt-decentering": 0.0345},
    )
    words = describe_lens_choice(choice)
    error = choice.trials["kannala-brandt"].held_out
    assert words.startswith(
        f"Kannala-Brandt: it predicts unseen views with {error:.3f} px RMS; Lucchese leaves "
    )
    assert words.endswith(
        "Of the models that predict as well it is the simplest that no other is known better than "
        "by more than a fifth: pixels are known to 0.031 px rms over the image."
    )
    alone = replace(choice, errors={"kannala-brandt": 0.0312})
    assert describe_lens_choice(alone).endswith(
        "No other model that these views determine predicts as well."
    )
    gone = {k: v for k, v in choice.trials.items() if k != "lucchese"}
    refused = replace(choice, trials=gone, refused={"lucchese": "No."})
    assert "; Lucchese cannot be calibrated from them." in describe_lens_choice(refused)
    assert "Lucchese" not in describe_lens_choice(replace(choice, trials=gone))


def test_the_reason_against_the_papers_model_is_what_it_lacks(kept: LensChoice) -> None:
    other = replace(kept, model="brown-conrady-4", errors={"brown-conrady-4": 0.1})
    error = kept.trials["lucchese"].held_out
    assert f"; Lucchese predicts them with {error:.3f} px. " in describe_lens_choice(other)
    narrow = change(other, "lucchese", valid_share=0.835)
    assert "px and is one-to-one on 83 % of the image only. " in describe_lens_choice(narrow)
    folded = change(other, "lucchese", is_valid_at_corners=False)
    assert "; Lucchese does not suit them (" in describe_lens_choice(folded)
    vaguer = replace(
        other,
        errors={"lucchese": 0.456, "brown-conrady-4": 0.1},
    )
    assert "predicts them as well, but is known to 0.456 px only. " in describe_lens_choice(vaguer)


def test_remarks_name_what_speaks_against_a_model(kept: LensChoice, fisheye: LensChoice) -> None:
    rows = {row.model: row for row in list_lens_rows(kept)}
    assert rows["lucchese"].remarks == () and rows["lucchese"].is_eligible
    assert not rows["pinhole"].is_eligible
    assert rows["pinhole"].remarks[-1].startswith("not tried on unseen views: residuals ")
    rms = {row.model: row.rms for row in list_lens_rows(fisheye)}
    times = rms["lucchese"] / min(rms.values())
    remarks = " ".join(list_lens_rows(fisheye)[-1].remarks)
    assert f"residuals {times:.1f} times the least" in remarks


@pytest.mark.parametrize("model", MODELS)
def test_every_model_has_a_purpose(model: str) -> None:
    assert describe_lens_model(model).endswith(".")


def test_a_splined_model_names_its_numbers() -> None:
    title = get_lens_title("splined-stereographic-12x8-100")
    assert title == "Splined stereographic (mrcal), 12 x 8 over 100 degrees"
    assert describe_lens_model("splined-stereographic-12x8-100").startswith("mrcal's")


def test_no_trial_is_shown_twice(kept: LensChoice) -> None:
    trials: list[LensTrial] = list(kept.trials.values())
    assert [row.model for row in list_lens_rows(kept)] == [
        t.model for t in sorted(trials, key=lambda t: t.held_out)
    ]
