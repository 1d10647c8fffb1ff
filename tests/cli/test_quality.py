"""calibgui uncertainty, diff and views: numbers, figures and sentences."""

from __future__ import annotations

import json
import re
import sys
from pathlib import Path

import pytest

from calibgui.cli.main import main
from calibgui.engine.images import render_view, write_image
from tests.photographs import BOARD, CAMERA, draw_poses

Capture = pytest.CaptureFixture[str]


@pytest.fixture(scope="module")
def held_file(corners_file: Path) -> Path:
    """result.json of the same corners with fewer coefficients."""
    file = corners_file.with_name("held.json")
    assert main(["calibrate", str(corners_file), "--fix", "k2,k3", "-q", "-o", str(file)]) == 0
    return file


def test_uncertainty_prints_and_draws(
    result_file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    monkeypatch.chdir(tmp_path)
    picture = Path("map.png")
    options = ["--distance", "700", "--limit", "0.5", "-o", str(picture)]
    assert main(["uncertainty", str(result_file), *options]) == 0
    out = capsys.readouterr().out
    assert "points 700 mm away" in out
    assert "known to 0.5 px or better" in out
    assert "Do the residuals look like noise?" in out
    assert max(map(len, out.splitlines())) <= 80
    assert picture.stat().st_size > 10_000


def test_uncertainty_as_json(result_file: Path, capsys: Capture) -> None:
    assert main(["uncertainty", str(result_file), "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["distance_mm"] is None
    assert answer["centre_px"] <= answer["worst_px"]
    assert len(answer["worst_direction_px"]) == len(answer["v"])
    assert set(answer["noise"].values()) <= {True, False}


def test_the_error_of_a_length_is_told_in_mm(result_file: Path, capsys: Capture) -> None:
    length = ["uncertainty", str(result_file), "--length", "50", "--at", "600"]
    assert main(length) == 0
    out = capsys.readouterr().out
    assert out.startswith("50 mm at 600 mm: ± ") and "(k = 2)" in out.splitlines()[0]
    assert max(map(len, out.splitlines())) <= 80
    assert main([*length, "--json"]) == 0
    worst = json.loads(capsys.readouterr().out)["length"]
    assert main([*length, "--json", "--pixel", "160,120"]) == 0
    there = json.loads(capsys.readouterr().out)["length"]
    assert there["pixel"] == [160, 120] and there["sigma_mm"] < worst["sigma_mm"]
    assert worst["sigma_mm"] ** 2 == pytest.approx(
        worst["by_calibration_mm"] ** 2 + worst["by_noise_mm"] ** 2 + worst["by_scale_mm"] ** 2
    )
    assert main(["uncertainty", str(result_file), "--length", "5000", "--at", "600"]) == 1
    assert "does not lie in the image" in capsys.readouterr().err
    for wrong in (["--length", "50"], [*length[2:], "--pixel", "160"]):
        with pytest.raises(SystemExit):
            main(["uncertainty", str(result_file), *wrong])


@pytest.mark.slow
def test_uncertainty_validates(
    result_file: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    assert main(["uncertainty", str(result_file), "--validate"]) == 0
    out, err = capsys.readouterr()
    assert "validating" in err
    for title in ("Cross-validation", "resamplings of the views", "Board shapes on unseen views"):
        assert title in out
    assert max(map(len, out.splitlines())) <= 80


def test_diff(
    result_file: Path,
    held_file: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: Capture,
) -> None:
    monkeypatch.chdir(tmp_path)
    picture = Path("difference.png")
    both = [str(result_file), str(held_file)]
    assert main(["diff", *both, "--covered", "--distance", "700", "-o", str(picture)]) == 0
    out = capsys.readouterr().out
    assert "shifted by" in out
    assert out.startswith("A is result.json, B is held.json.\n")
    assert max(map(len, out.splitlines())) <= 80
    assert picture.stat().st_size > 10_000
    [expected] = re.findall(r"expected from both uncertainties \(rms\) +([\d.]+)", out)
    [told] = re.findall(r"uncertainties explain ([\d.]+) px rms", " ".join(out.split()))
    assert float(told) == pytest.approx(float(expected), rel=0.1, abs=5e-4)
    [worst] = re.findall(r"worst +([\d.]+)", out)
    [at_most] = re.findall(r"([\d.]+) px at most", " ".join(out.split()))
    assert float(at_most) == pytest.approx(float(worst), rel=0.1, abs=5e-4)
    assert main(["diff", both[0], both[0], "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["worst_px"] == pytest.approx(0, abs=1e-9)
    assert answer["expected_rms_px"] > 0


@pytest.mark.slow
def test_views(
    result_file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    monkeypatch.chdir(tmp_path)
    curves, poses = Path("curves.png"), Path("next.png")
    options = ["--limit", "1", "-o", str(curves), "--next", str(poses)]
    assert main(["views", str(result_file), *options]) == 0
    out = capsys.readouterr().out
    assert "The principal point is" in out
    assert "Hold the board" in out
    assert max(map(len, out.splitlines())) <= 80
    assert min(curves.stat().st_size, poses.stat().st_size) > 10_000


@pytest.mark.parametrize("option", ["--distance", "--limit"])
def test_distances_and_limits_are_positive(result_file: Path, option: str) -> None:
    with pytest.raises(SystemExit):
        main(["uncertainty", str(result_file), option, "0"])


@pytest.mark.parametrize("command", ["uncertainty", "views"])
def test_a_place_that_cannot_be_written_is_told_first(
    command: str, result_file: Path, tmp_path: Path, capsys: Capture
) -> None:
    assert main([command, str(result_file), "-o", str(tmp_path / "no" / "map.png")]) == 1
    assert "does not exist" in capsys.readouterr().err
    assert main([command, str(result_file), "-o", str(tmp_path / "map.txt")]) == 1
    assert "Give it the suffix .png or .svg or .pdf" in capsys.readouterr().err


def test_the_noise_floor_is_shown_beside_residuals(
    result_file: Path, tmp_path: Path, capsys: Capture
) -> None:
    pose = draw_poses()[0]
    for seed in range(6):
        image = render_view(CAMERA, pose, BOARD, blur=0.7, noise=2.0, seed=seed)
        write_image(tmp_path / f"frame{seed}.png", image)
    command = ["noise", str(tmp_path), "--result", str(result_file)]
    assert main(command) == 0
    out = capsys.readouterr().out
    assert "6 frames of 42 corners" in " ".join(out.split())
    assert "Nothing has moved meanwhile." in out and "% is this noise" in " ".join(out.split())
    assert main([*command, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    # The corner finder states what corners scatter by.
    assert found["sigma_px"] == pytest.approx(found["stated_sigma_px"], rel=0.3)
    assert main(["noise", str(tmp_path.parent / "none")]) == 1
