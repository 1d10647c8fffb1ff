"""calibgui report: files from a result or a project, and what is refused."""

from __future__ import annotations

import json
import re
import shlex
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from calibgui.app.outputs.report_files import format_command
from calibgui.app.projects.project_file import write_project
from calibgui.app.projects.result_project import make_project
from calibgui.cli.main import main
from calibgui.dataset.details import Details
from calibgui.formats.result_json import read_result

Capture = pytest.CaptureFixture[str]


def test_a_report_is_written_from_a_result(
    result_file: Path, tmp_path: Path, capsys: Capture
) -> None:
    page = tmp_path / "report.html"
    options = ["--operator", "Zoë", "--issued", "2026-03-01", "--camera-serial", "S-17"]
    assert main(["report", str(result_file), "-o", str(page), *options]) == 0
    assert capsys.readouterr().out == f"Wrote {page}.\n"
    text = page.read_text(encoding="utf-8")
    for words in ("Zoë", "S-17", "issued 2026-03-01", "view1.png", "calibgui calibrate"):
        assert words in text, words
    # Another report takes its place, and nothing else does.
    assert main(["report", str(result_file), "-o", str(page), "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == {"written": [str(page)]}
    mine = tmp_path / "mine.html"
    mine.write_text("not to be lost")
    assert main(["report", str(result_file), "-o", str(mine)]) == 1
    assert mine.read_text() == "not to be lost"


def test_a_pdf_takes_the_place_of_one(result_file: Path, tmp_path: Path) -> None:
    pytest.importorskip("typst", reason="the extra report is not installed")
    for _ in range(2):
        assert main(["report", str(result_file), "-o", str(tmp_path / "r.pdf"), "-q"]) == 0
    assert (tmp_path / "r.pdf").read_bytes().startswith(b"%PDF")


def test_a_project_gives_its_newest_result_and_what_is_stated(
    result_file: Path, tmp_path: Path, capsys: Capture
) -> None:
    project = replace(make_project(result_file, "first"), details=Details(operator="Zoë"))
    write_project(project, tmp_path / "project.json")
    page = tmp_path / "report.html"
    options = ["--layout", "certificate", "--customer", "Works"]
    assert main(["report", str(tmp_path / "project.json"), "-o", str(page), *options]) == 0
    text = page.read_text(encoding="utf-8")
    assert "Calibration certificate" in text and "Zoë" in text and "Works" in text
    write_project(replace(project, results={}), tmp_path / "project.json")
    assert main(["report", str(tmp_path / "project.json"), "-o", str(page)]) == 1
    assert "holds no result" in capsys.readouterr().err


def test_what_cannot_be_is_refused(result_file: Path, tmp_path: Path, capsys: Capture) -> None:
    assert main(["report", str(result_file), "-o", str(tmp_path / "r.doc")]) == 1
    assert "not named as a report" in capsys.readouterr().err
    page = str(tmp_path / "r.html")
    missing = ["--template", str(tmp_path / "none.html")]
    assert main(["report", str(result_file), "-o", page, *missing]) == 1
    with pytest.raises(SystemExit):
        main(["report", str(result_file), "-o", page, "--issued", "yesterday"])


def test_what_is_not_determined_has_a_report_as_well(
    corners_file: Path, tmp_path: Path, capsys: Capture
) -> None:
    file, page = tmp_path / "one.json", tmp_path / "one.html"
    one = ["calibrate", str(corners_file), "--exclude", "view[2-6].png", "-o", str(file)]
    assert main(one) == 1
    capsys.readouterr()
    assert main(["report", str(file), "-o", str(page)]) == 0
    text = page.read_text(encoding="utf-8")
    assert "NOT USABLE" in text and "left out" in text and "nan" not in text


def test_a_lens_of_many_parameters_has_a_short_table(
    corners_file: Path, tmp_path: Path, capsys: Capture
) -> None:
    file, page = tmp_path / "splined.json", tmp_path / "splined.html"
    lens = ["--as-asked", "--model", "splined-stereographic-8x6-70"]
    assert main(["calibrate", str(corners_file), *lens, "-o", str(file)]) == 0
    capsys.readouterr()
    assert main(["report", str(file), "-o", str(page)]) == 0
    text = page.read_text(encoding="utf-8")
    assert "The other 96 parameters are in result.json." in text
    listed = re.findall(r'<tr><td class="text">(\w+)</td>', text.partition(">Parameters<")[2])
    assert listed[:4] == ["fx", "fy", "cx", "cy"] and "c0" not in "".join(listed)


def test_the_command_makes_the_calibration_again(photographs: Path, tmp_path: Path) -> None:
    files = [tmp_path / "first.json", tmp_path / "again.json"]
    words = ["calibrate", str(photographs), "--square", "30+-0.01", "--board-shape", "bow"]
    assert main([*words, "--exclude", "view3.png", "-q", "-o", str(files[0])]) == 0
    first = read_result(files[0])
    again = shlex.split(format_command(first))
    assert main([*again[1:], "-q", "-o", str(files[1])]) == 0
    second = read_result(files[1])
    assert second.calibration.digest == first.calibration.digest
    assert second.board == first.board
    np.testing.assert_allclose(
        second.calibration.camera.params, first.calibration.camera.params, rtol=1e-9, atol=1e-12
    )
