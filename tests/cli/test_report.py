"""calibgui report: files from a result or a project, and what is refused."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from calibgui.app.projects.project_file import write_project
from calibgui.app.projects.result_project import make_project
from calibgui.cli.main import main
from calibgui.dataset.details import Details

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
