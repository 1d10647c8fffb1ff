"""Cameras are listed by the names that the system tells."""

from __future__ import annotations

from pathlib import Path

from calibgui.engine.capture.cameras import list_cameras


def test_cameras_are_named_and_their_side_data_are_none(tmp_path: Path) -> None:
    for device, index, name in (
        ("video2", "0", "Desk"),
        ("video3", "1", "Desk"),
        ("video0", "0", ""),
    ):
        folder = tmp_path / device
        folder.mkdir()
        (folder / "index").write_text(f"{index}\n")
        (folder / "name").write_text(f"{name}\n")
    (tmp_path / "videonone").mkdir()
    assert list_cameras(tmp_path) == {0: "camera 0", 2: "Desk"}
    assert list_cameras(tmp_path / "none") == {}
