"""Every file that can be exported is known again as what it is, and not as anything else."""

from __future__ import annotations

from pathlib import Path

import pytest

from calibgui.dataset import Result
from calibgui.formats import EXPORTERS, export
from calibgui.formats.origin import is_own


@pytest.mark.parametrize("name", EXPORTERS)
def test_an_exported_file_is_known_by_its_kind(tmp_path: Path, name: str, result: Result) -> None:
    for suffix in EXPORTERS[name].suffixes:
        path = (tmp_path / EXPORTERS[name].file_name).with_suffix(suffix)
        export(result, name, path)
        assert [kind for kind in EXPORTERS if is_own(path, kind)] == [name]


def test_files_of_others_are_not_known() -> None:
    golden = Path(__file__).parents[1] / "golden"
    for path in (golden / "opencv.xml", golden / "camchain.yaml"):
        assert not any(is_own(path, kind) for kind in EXPORTERS)
