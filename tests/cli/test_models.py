"""calibgui models: the comparison printed, as JSON and in a file; and calibrate --model auto."""

from __future__ import annotations

import json
from functools import partial
from pathlib import Path

import pytest

from calibgui.app.calibrating.settings import MODEL_CHOICES
from calibgui.cli.main import main
from calibgui.engine.assessment.choices import lens_choice
from calibgui.engine.assessment.choices.lens_choice import choose_lens
from calibgui.formats.result_json import read_result
from tests.photographs import COUNT

Capture = pytest.CaptureFixture[str]
FEW = ("lucchese", "brown-conrady-4", "pinhole")


@pytest.fixture
def few_lenses(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let there be few lens models to choose from, which is quick."""
    few = partial(choose_lens, candidates=FEW)
    monkeypatch.setattr("calibgui.app.calibrating.lens_comparison.choose_lens", few)
    monkeypatch.setattr(lens_choice, "_FIRST_CANDIDATES", FEW)


@pytest.mark.usefixtures("few_lenses")
def test_a_corners_file_is_compared_on(corners_file: Path, tmp_path: Path, capsys: Capture) -> None:
    file = tmp_path / "models.json"
    assert main(["models", str(corners_file), "-o", str(file)]) == 0
    printed, problems = capsys.readouterr()
    assert problems == ""
    assert f"corners in {COUNT} views (* recommended)" in printed
    assert "The paper's model (Lucchese) is kept" in printed
    lines = printed.splitlines()
    assert all(len(line) <= 80 or str(file) in line for line in lines)
    content = json.loads(file.read_text())
    assert content["recommended"] == "lucchese" and content["fixed"] == {}
    assert "- To calibrate with it: --model lucchese\n" in printed
    rows = {row["model"]: row for row in content["models"]}
    assert rows.keys() == set(FEW)
    chosen = rows["lucchese"]
    for key in ("rms_px", "unseen_rms_px", "unseen_median_px", "unseen_95_percent_px"):
        assert 0 < chosen[key] < 0.1
    assert chosen["largest_difference_px"] == 0 and chosen["parameters"] == 9
    assert 45 < chosen["field_of_view_deg"]["horizontal"] < 60
    assert rows["pinhole"]["unseen_rms_px"] is None, "its residuals are too large to be asked"
    assert "not tried" in rows["pinhole"]["remarks"][-1]
    best = next(line for line in lines if line.startswith("  *  lucchese")).split()
    assert best[3] == f"{chosen['rms_px']:.3f}"


@pytest.mark.usefixtures("few_lenses")
def test_json_stands_alone_and_quiet_is_one_line(corners_file: Path, capsys: Capture) -> None:
    assert main(["models", str(corners_file), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["recommended"] == "lucchese"
    assert main(["models", str(corners_file), "-q"]) == 0
    printed, problems = capsys.readouterr()
    assert "Lucchese" in printed and printed.count("\n") == 1
    assert problems == ""


@pytest.mark.usefixtures("few_lenses")
def test_photographs_need_no_square(photographs: Path, capsys: Capture) -> None:
    assert main(["models", str(photographs), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["models"][0]["corners"] == 252


def test_what_cannot_be_compared_is_told(content: dict, tmp_path: Path, capsys: Capture) -> None:
    file = tmp_path / "two.json"
    file.write_text(json.dumps(content | {"views": content["views"][:2]}))
    assert main(["models", str(file)]) == 1
    assert "too few to compare lens models" in capsys.readouterr().err
    assert main(["models", str(file), "-o", str(tmp_path / "no" / "a.json")]) == 1
    assert "does not exist" in capsys.readouterr().err
    with pytest.raises(SystemExit) as ended:
        main(["models", str(file), "--target", "circles"])
    assert ended.value.code == 2


@pytest.mark.usefixtures("few_lenses")
def test_calibrate_chooses_the_lens_model(
    corners_file: Path, tmp_path: Path, capsys: Capture
) -> None:
    file = tmp_path / "result.json"
    assert main(["calibrate", str(corners_file), "--model", "auto", "-v", "-o", str(file)]) == 0
    printed = " ".join(capsys.readouterr().out.split())
    settings = read_result(file).calibration.settings
    assert settings.model == "lucchese"
    assert settings.model_reason.startswith("The paper's model (Lucchese) is kept")
    assert settings.model_reason in printed
    assert read_result(file).calibration.warnings[0] == settings.model_reason


def test_help_lists_every_lens_model_and_no_splined_coefficient(capsys: Capture) -> None:
    with pytest.raises(SystemExit):
        main(["calibrate", "--help", "all"])
    printed = capsys.readouterr().out
    words = "".join(printed.split())
    assert all(f"{model}:" in words or f"{model}(default):" in words for model in MODEL_CHOICES)
    assert "auto," in words and "dx_0_0" not in words
    assert len(printed.splitlines()) < 200


def test_a_splined_model_of_any_numbers_can_be_named(corners_file: Path, tmp_path: Path) -> None:
    file = tmp_path / "result.json"
    options = ["--model", "splined-stereographic-6x5-70", "-q", "-o", str(file)]
    assert main(["calibrate", str(corners_file), *options]) == 0
    assert read_result(file).calibration.camera.model == "splined-stereographic-6x5-70"


@pytest.mark.slow
def test_all_lens_models_are_compared(corners_file: Path, capsys: Capture) -> None:
    assert main(["models", str(corners_file), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    tried = {row["model"] for row in found["models"]} | found["refused"].keys()
    assert tried == set(lens_choice.CANDIDATES)
    assert found["recommended"] == "lucchese"
