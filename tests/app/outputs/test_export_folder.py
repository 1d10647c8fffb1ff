"""All formats in a folder, with a page that tells who reads which file."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from calibgui.app.outputs.export_folder import PAGE, export_all
from calibgui.dataset import Result
from calibgui.engine.camera.camera import Camera
from calibgui.engine.errors import CalibrationError
from calibgui.formats import EXPORTERS
from calibgui.formats.origin import is_own
from calibgui.formats.result_json import read_result

_GOLDEN = Path(__file__).parents[2] / "golden"


@pytest.fixture(scope="module")
def golden() -> Result:
    return read_result(_GOLDEN / "result-1.json")


def test_every_format_is_there_and_on_the_page(tmp_path: Path, golden: Result) -> None:
    steps = []
    outcomes = export_all(golden, tmp_path / "all", report=lambda *step: steps.append(step))
    assert [one.exporter.name for one in outcomes] == list(EXPORTERS)
    assert steps[-1] == (len(outcomes), len(outcomes))
    page = (tmp_path / "all" / PAGE).read_text()
    rows = [line.strip("| ").split(" | ") for line in page.splitlines() if line.startswith("| ")]
    listed = {row[0]: row[1:] for row in rows[2:]}
    for one in outcomes:
        exporter, report = one.exporter, one.report
        assert report is not None and is_own(tmp_path / "all" / one.file, exporter.name)
        *facts, error = listed[one.file]
        assert facts == [exporter.readers, exporter.keeps, exporter.loses]
        if report.largest_error_px is None:
            assert error == "none"
        elif error != "unlimited at the edge":
            assert float(error) == pytest.approx(report.largest_error_px, rel=0.05)
    export_all(golden, tmp_path / "all")  # over its own files


def test_formats_that_cannot_hold_the_camera_are_named(tmp_path: Path, golden: Result) -> None:
    skewed = Camera((640, 480), [650, 500, 303, 243, 0.2, 0.1, 0, 0, 0, 0], "lucchese")
    calibration = replace(golden.calibration, camera=skewed)
    outcomes = export_all(replace(golden, calibration=calibration), tmp_path)
    (refused,) = (one for one in outcomes if one.exporter.name == "lensfun")
    assert refused.report is None and "square pixels" in refused.reason
    assert not (tmp_path / refused.file).exists()
    page = (tmp_path / PAGE).read_text()
    assert f"- {refused.file}: {refused.reason}" in page


def test_files_of_others_are_kept(tmp_path: Path, golden: Result) -> None:
    (tmp_path / PAGE).write_text("Mine.\n")
    with pytest.raises(CalibrationError, match=r"README\.md exists, and is not a page on exports"):
        export_all(golden, tmp_path)
    assert (tmp_path / PAGE).read_text() == "Mine.\n"
    export_all(golden, tmp_path, overwrite=True)
