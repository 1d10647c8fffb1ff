"""Photographs of a fleet at addresses: a web server's are read as files are, and only when new."""

from __future__ import annotations

import os
import shutil
import sys
import threading
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import pytest
from fsspec.config import conf
from fsspec.registry import _registry

from calibgui.app.fleet.manifest import CameraTask
from calibgui.app.fleet.photographs import list_photographs
from calibgui.engine.errors import CalibrationError
from calibgui.formats.result_json import read_result
from tests.app.fleet.conftest import Here, read_results, read_rows, run


class Server:
    """A web server on this machine, for a folder."""

    def __init__(self, folder: Path) -> None:
        self.fetched: list[str] = []
        """Names of the photographs whose content was asked for."""
        self._server = ThreadingHTTPServer(
            ("127.0.0.1", 0), partial(_Handler, directory=str(folder), fetched=self.fetched)
        )
        self._thread = threading.Thread(target=self._server.serve_forever)
        self.address = f"http://127.0.0.1:{self._server.server_port}"

    def __enter__(self) -> Server:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._server.shutdown()
        self._server.server_close()
        self._thread.join()


class _Handler(SimpleHTTPRequestHandler):
    """It answers as a plain web server does, with a page of links for a folder."""

    def __init__(self, *args: object, fetched: list[str], **options: object) -> None:
        self._fetched = fetched
        super().__init__(*args, **options)  # type: ignore[arg-type]

    def do_GET(self) -> None:
        if self.path.endswith(".png"):
            self._fetched.append(Path(self.path).name)
        super().do_GET()

    def log_message(self, *_: object) -> None:
        pass


@pytest.fixture
def server(fleet: Path, tmp_path: Path) -> Iterator[Server]:
    """The photographs of the camera c0 in the folder shots."""
    shutil.copytree(fleet / "c0", tmp_path / "web" / "shots")
    with Server(tmp_path / "web") as server:
        yield server


@pytest.mark.parametrize("what", ["shots", "shots/", "shots/view*.png"])
def test_a_web_servers_folder_is_listed(server: Server, what: str) -> None:
    found = list_photographs([f"{server.address}/{what}"])
    assert [one.name for one in found] == [
        f"{server.address}/shots/view{k}.png" for k in range(1, 7)
    ]
    assert all(one.state for one in found)
    assert not server.fetched


def test_a_camera_at_a_web_server_is_calibrated_as_one_here(
    server: Server, tasks: Sequence[CameraTask], calibrated: Path, tmp_path: Path
) -> None:
    names = [f"view{k}.png" for k in range(1, 7)]
    far = replace(tasks[0], paths=(f"{server.address}/shots",))
    ledger = tmp_path / "f.db"
    run([far], ledger, Here())
    (row,) = read_rows(ledger)
    assert row.figures == read_rows(calibrated)[0].figures
    stored = read_result(ledger.parent / row.result)
    assert [view.image for view in stored.views] == [f"{far.paths[0]}/{name}" for name in names]
    assert sorted(server.fetched) == names

    # The server is asked whether anything has changed, and nothing is fetched if not.
    server.fetched.clear()
    before = read_results(ledger)
    run([far], ledger, Here())
    assert not server.fetched
    assert (read_rows(ledger), read_results(ledger)) == ([row], before)
    os.utime(tmp_path / "web" / "shots" / "view2.png", (1, 1))
    run([far], ledger, Here())
    assert sorted(server.fetched) == names
    assert read_results(ledger) == before


def test_new_photographs_are_seen_by_a_worker_that_lives_on(
    server: Server, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """File systems may remember what a folder held, as that of s3:// does unless told otherwise."""
    monkeypatch.setitem(conf, "http", {"use_listings_cache": True})
    address = f"{server.address}/shots/"
    assert len(list_photographs([address])) == 6
    shutil.copy(tmp_path / "web" / "shots" / "view1.png", tmp_path / "web" / "shots" / "view7.png")
    assert len(list_photographs([address])) == 7


def test_what_a_web_server_lacks_is_named(server: Server) -> None:
    with pytest.raises(CalibrationError, match=r"view9\.png cannot be read") as caught:
        list_photographs([f"{server.address}/shots/view9.png"])
    assert "Check the address" in caught.value.hint


def test_the_package_that_an_address_needs_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "aiohttp", None)
    monkeypatch.setitem(sys.modules, "s3fs", None)
    monkeypatch.delitem(sys.modules, "fsspec.implementations.http", raising=False)
    for protocol in ("http", "s3"):
        monkeypatch.delitem(_registry, protocol, raising=False)
    with pytest.raises(CalibrationError, match="aiohttp is not installed") as caught:
        list_photographs(["http://127.0.0.1:9/shots"])
    assert "pip install '.[batch]'" in caught.value.hint
    with pytest.raises(CalibrationError, match="s3fs") as caught:
        list_photographs(["s3://bucket/shots"])
    assert "pip install" in caught.value.hint
    monkeypatch.setitem(sys.modules, "fsspec", None)
    with pytest.raises(CalibrationError, match="fsspec") as caught:
        list_photographs(["http://127.0.0.1:9/shots"])
    assert "pip install '.[batch]'" in caught.value.hint
