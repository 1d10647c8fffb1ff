"""Frames come from videos, cameras and folders alike, and failures say what to do."""

from __future__ import annotations

import http.server
import shutil
import socketserver
import threading
from collections.abc import Iterator
from pathlib import Path

import cv2
import numpy as np
import pytest

from calibgui.engine.capture.camera_settings import CameraSettings
from calibgui.engine.capture.frame_sources import CameraSource, FolderSource, open_source
from calibgui.engine.errors import CalibrationError

SIZE = (64, 48)
COUNT = 5


def _draw(k: int) -> np.ndarray:
    return np.full((SIZE[1], SIZE[0], 3), (40 * k, 30, 200 - 40 * k), np.uint8)


@pytest.fixture
def video(tmp_path: Path) -> Path:
    file = tmp_path / "film.avi"
    writer = cv2.VideoWriter(str(file), cv2.VideoWriter_fourcc(*"FFV1"), 10.0, SIZE)
    if not writer.isOpened():
        pytest.skip("this OpenCV writes no FFV1")
    for k in range(COUNT):
        writer.write(_draw(k)[:, :, ::-1])
    writer.release()
    return file


def test_a_video_gives_its_frames_with_their_times(video: Path) -> None:
    with open_source(str(video), 1.0) as source:
        frames = list(iter(source.read, None))
    assert source.is_continuous
    assert len(frames) == COUNT
    for k, frame in enumerate(frames):
        np.testing.assert_allclose(frame.image, _draw(k), atol=1)
    assert np.diff([frame.time for frame in frames]) == pytest.approx(0.1, abs=1e-3)


def test_a_folder_gives_photographs_as_soon_as_they_are_whole(tmp_path: Path) -> None:
    folder = tmp_path / "tethered"
    folder.mkdir()
    (folder / "notes.txt").write_text("none")
    whole = tmp_path / "whole.png"
    cv2.imwrite(str(whole), _draw(1))
    shutil.copy(whole, folder / "a.png")
    source = FolderSource(folder, patience=1.5)
    first = source.read()
    assert first is not None
    assert first.image.shape[:2] == SIZE[::-1]
    shutil.copy(whole, folder / "b.png")
    assert source.read() is not None
    assert source.read() is None
    assert not source.is_continuous


class _Server(http.server.BaseHTTPRequestHandler):
    """A camera that sends MJPEG, and stops after some frames."""

    def do_GET(self) -> None:
        self.send_response(200)
        self.send_header("Content-Type", "multipart/x-mixed-replace; boundary=frame")
        self.end_headers()
        for k in range(COUNT):
            content = cv2.imencode(".jpg", _draw(k))[1].tobytes()
            head = f"--frame\r\nContent-Type: image/jpeg\r\nContent-Length: {len(content)}\r\n\r\n"
            self.wfile.write(head.encode() + content + b"\r\n")

    def log_message(self, *_: object) -> None:
        pass


@pytest.fixture
def address() -> Iterator[str]:
    with socketserver.TCPServer(("127.0.0.1", 0), _Server) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        yield f"http://127.0.0.1:{server.server_address[1]}/stream.mjpg"
        server.shutdown()
        thread.join()


def test_a_camera_that_dies_says_so(address: str) -> None:
    with open_source(address, 1.0) as source:
        frame = source.read()
        assert frame is not None
        assert frame.image.shape == (SIZE[1], SIZE[0], 3)
        with pytest.raises(CalibrationError, match=r"stopped sending images\. Check its cable"):
            for _ in range(COUNT + 1):
                source.read()


def test_a_camera_that_is_not_there_is_refused() -> None:
    with pytest.raises(CalibrationError, match="camera 97 cannot be opened"):
        CameraSource(97)


def test_what_is_none_is_refused_with_what_would_be_one(tmp_path: Path) -> None:
    (tmp_path / "notes.txt").write_text("none")
    for name in (tmp_path / "missing", tmp_path / "notes.txt"):
        with pytest.raises(CalibrationError, match=r"no camera, video or folder.*by its number"):
            open_source(str(name), 1.0)


class _Device:
    """What OpenCV knows of a camera that has two sizes, one exposure, and autofocus."""

    def __init__(self) -> None:
        self.has = {
            cv2.CAP_PROP_FRAME_WIDTH: 640.0,
            cv2.CAP_PROP_FRAME_HEIGHT: 480.0,
            cv2.CAP_PROP_EXPOSURE: 156.0,
            cv2.CAP_PROP_AUTOFOCUS: 1.0,
            cv2.CAP_PROP_FOCUS: 0.0,
        }

    def isOpened(self) -> bool:  # noqa: N802 - OpenCV's name
        return True

    def getBackendName(self) -> str:  # noqa: N802 - OpenCV's name
        return "V4L2"

    def get(self, which: int) -> float:
        return self.has[which]

    def set(self, which: int, value: float) -> bool:
        if which != cv2.CAP_PROP_EXPOSURE:
            self.has[which] = value
        return True


def test_a_camera_is_set_as_it_is_wanted_and_says_what_it_does_not_take(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(cv2, "VideoCapture", lambda _: _Device())
    remark = CameraSource(0).remark
    assert remark.startswith("The camera has 640 x 480 px, exposure 156. Autofocus is on, ")
    source = open_source("0", 1.0, CameraSettings((1280, 720), -6.0, 30.0))
    assert source.remark == (
        "The camera has 1280 x 720 px, exposure 156, focus 30. It does not take exposure -6."
    )
    with pytest.raises(CalibrationError, match="has no settings here"):
        open_source("rtsp://none", 1.0, CameraSettings(focus=1.0))
