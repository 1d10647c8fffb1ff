"""Files of others are not taken for exported ones; `test_exporters` has those."""

from __future__ import annotations

from pathlib import Path

from calibgui.formats import EXPORTERS
from calibgui.formats.origin import is_own


def test_files_of_others_are_not_known() -> None:
    golden = Path(__file__).parents[1] / "golden"
    for path in (golden / "opencv.xml", golden / "camchain.yaml"):
        assert not any(is_own(path, kind) for kind in EXPORTERS)
