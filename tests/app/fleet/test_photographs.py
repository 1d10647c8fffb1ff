"""Photographs of a fleet at addresses: a web server's are read as files are, and only when new."""

from __future__ import annotations

import contextlib
import gzip
import os
import shutil
import sys
import threading
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import pytest
from fsspec.config import conf
from fsspec.registry import _registry

from calibgui.app.calibrating.settings import Settings
from calibgui.app.fleet import photographs
from calibgui.app.fleet.manifest import CameraTask, read_manifest
from calibgui.app.fleet.photographs import Photograph, fetch_photographs, list_photographs
from calibgui.engine.errors import CalibrationError
from calibgui.formats.result_json import read_result
from tests.app.fleet.conftest import BOARD, Here, read_results, read_rows, run


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


_MANY_ZEROS = [bytes(1 << 20)] * 128
_TROUBLES: Mapping[str, tuple[Mapping[str, str], Sequence[bytes]]] = {
    "stated.png": ({"Content-Length": str(1 << 40)}, _MANY_ZEROS),
    "unstated.png": ({}, _MANY_ZEROS),
    "packed.png": ({"Content-Encoding": "gzip"}, [gzip.compress(b"".join(_MANY_ZEROS))]),
    "links": ({"Content-Type": "text/html"}, [b'<a href="simplecache::view1.png">1</a>']),
    "simplecache::view1.png": ({}, []),
}
"""Headers and contents of what a server that means no good answers."""


class _Handler(SimpleHTTPRequestHandler):
    """It answers as a plain web server does, with a page of links for a folder."""

    def __init__(self, *args: object, fetched: list[str], **options: object) -> None:
        self._fetched = fetched
        super().__init__(*args, **options)  # type: ignore[arg-type]

    def do_HEAD(self) -> None:
        if Path(self.path).name in _TROUBLES:
            self._answer({"ETag": "1"})
        else:
            super().do_HEAD()

    def do_GET(self) -> None:
        if (name := Path(self.path).name) in _TROUBLES:
            headers, pieces = _TROUBLES[name]
            self._answer(headers)
            with contextlib.suppress(ConnectionError):  # it is not heard to the end
                for piece in pieces:
                    self.wfile.write(piece)
                self._fetched.append(f"{name} to its end")
            return
        if self.path.endswith(".png"):
            self._fetched.append(Path(self.path).name)
        super().do_GET()

    def _answer(self, headers: Mapping[str, str]) -> None:
        self.send_response(200)
        for name, value in headers.items():
            self.send_header(name, value)
        self.end_headers()

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


@pytest.mark.parametrize("name", ["stated.png", "unstated.png", "packed.png"])
def test_no_more_is_fetched_than_a_photograph_has(
    server: Server, name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whatever the server says of the size: too much, nothing, or that of what it has packed."""
    monkeypatch.setattr(photographs, "_MAX_BYTES", 1 << 20)
    address = f"{server.address}/{name}"
    with (
        pytest.raises(CalibrationError, match=rf"{address} is larger than 1 MB") as caught,
        fetch_photographs([Photograph(address, "")]),
    ):
        pass
    assert caught.value.hint
    assert name == "packed.png" or not server.fetched, "it was read to its end"


def test_an_address_that_a_server_names_leads_nowhere_else(server: Server) -> None:
    found = list_photographs([f"{server.address}/links/"])
    assert [one.name for one in found] == [f"{server.address}/links/simplecache::view1.png"]
    with pytest.raises(CalibrationError, match="several in one"), fetch_photographs(found):
        pass


@pytest.mark.parametrize(
    ("address", "reason"),
    [
        ("simplecache::http://127.0.0.1:9/a.png", "several in one"),
        ("zip://a.png::http://127.0.0.1:9/a.zip", "several in one"),
        ("http://127.0.0.1:9/a.png::file:///etc/passwd", "several in one"),
        ("file:///etc/a.png", "protocol 'file'"),
        ("ftp://127.0.0.1/a.png", "protocol 'ftp'"),
        ("memory://a.png", "protocol 'memory'"),
        ("github://owner:name@/a.png", "protocol 'github'"),
        ("HTTP://127.0.0.1/a.png", "protocol 'HTTP'"),
        ("://a.png", "protocol ''"),
    ],
)
def test_other_protocols_are_refused_by_name(address: str, reason: str, tmp_path: Path) -> None:
    with pytest.raises(CalibrationError, match=reason) as caught:
        list_photographs([address])
    assert address in caught.value.message
    assert "://" in caught.value.hint
    manifest = tmp_path / "manifest.csv"
    manifest.write_text(f"id,paths\nc0,shots;{address}\n")
    with pytest.raises(CalibrationError, match=rf"manifest\.csv, line 2: .*{reason}"):
        read_manifest(manifest, BOARD, Settings())
