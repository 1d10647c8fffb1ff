"""calibgui demo: the bundled sample, whose truth is known."""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path

import numpy as np
import pytest

from calibgui.app.system.resources import find_resource
from calibgui.cli.main import main
from calibgui.engine.images.reading import read_image_size
from calibgui.formats.result_json import read_result


def test_the_sample_is_calibrated_to_its_truth(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    out = tmp_path / "calibgui-demo"
    out.mkdir()
    # What an earlier run wrote is replaced.
    shutil.copy(Path(__file__).parents[1] / "golden/result-1.json", out / "result.json")
    assert main(["demo"]) == 0
    result = read_result(out / "result.json")
    truth = json.loads((find_resource("sample") / "truth.json").read_text())
    assert len(result.used) == len(truth["views"])
    sigma = result.calibration.sigma
    error = result.calibration.camera.params - list(truth["camera"]["params"].values())
    assert np.abs(error[sigma > 0] / sigma[sigma > 0]).max() < 4
    printed = capsys.readouterr().out
    assert str(out) in printed and "in sigmas" in printed
    assert max(len(line) for line in printed.splitlines() if str(out) not in line) <= 80
    readme = Path(__file__).resolve().parents[2] / "README.md"
    (table,) = re.findall(r"^```text\n(Camera, .*?)^```$", readme.read_text("utf-8"), re.M | re.S)
    found = printed[printed.index("Camera, ") :]
    # The last digits depend on the machine's arithmetic; everything else does not.
    number = re.compile(r"-?\d+\.\d+")
    lines = list(zip(table.splitlines(), found.splitlines(), strict=False))
    assert [number.sub("#", stated) for stated, _ in lines] == [
        number.sub("#", line) for _, line in lines
    ]
    for stated, line in lines:
        for ours, theirs in zip(number.findall(stated), number.findall(line), strict=True):
            assert float(ours) == pytest.approx(
                float(theirs), abs=1.5 * 10.0 ** -len(ours.split(".")[1])
            )
    for name in ("corners", "distortion", "residuals", "histograms", "undistorted", "convergence"):
        assert read_image_size(out / f"{name}.png")[0] > 400
    for name in ("opencv.yaml", "ros.yaml", "corners.json", "corners.csv"):
        assert (out / name).stat().st_size > 500


def test_a_folder_that_cannot_be_made_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "file").touch()
    assert main(["demo", "-o", str(tmp_path / "file")]) == 1
    assert "cannot be made" in capsys.readouterr().err
