"""Two rendered cameras take their pictures together, and become a rig; what fails ends no other."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from calibgui.app.calibrating.settings import Settings
from calibgui.app.photographs.detection import find_views
from calibgui.app.photographs.recording import BoardFinder, Recorder, begin_session, describe_pairs
from calibgui.app.rig.calibrating import calibrate_photographs, search_cameras
from calibgui.app.rig.pairing import pair_photographs
from calibgui.engine.boards import CHECKERBOARD, Board
from calibgui.engine.camera.camera import Camera
from calibgui.engine.capture import JointSession, PairedFrames
from calibgui.engine.geometry.pose import Pose
from calibgui.formats.times_csv import read_times
from tests.scenes.hand import RenderedCamera, Walk, spread_places

CAMERAS = (
    Camera((320, 240), [300, 300, 157, 122, -0.2, 0.05, 0, 0, 0], "brown-conrady"),
    Camera((320, 240), [310, 310, 163, 118, -0.15, 0.03, 0, 0, 0], "brown-conrady"),
)
BOARD = Board(6, 8, 20.0)
POSES = (Pose([0, 0, 0], [0, 0, 0]), Pose([0.01, -0.12, 0.0], [-60.0, 1.0, 6.0]))
HOLD, MOVE = 0.36, 0.36
"""Time for which the board is held still, and in which it moves, s."""
LATE = 0.037
"""Time by which the second camera is late, s: nearly a frame."""


def _capture(folder: Path, places: int, fails_at: float = np.inf) -> tuple[JointSession, Recorder]:
    """Take pictures of a board in so many places; the second camera may fail."""
    walk = Walk(spread_places(BOARD, places, np.array([30.0, 0.0, 330.0])), hold=HOLD, move=MOVE)
    sources = [
        RenderedCamera(CAMERAS[0], POSES[0], BOARD, walk, seconds=walk.seconds),
        RenderedCamera(
            CAMERAS[1], POSES[1], BOARD, walk, LATE, 0.013, walk.seconds, fails_at=fails_at
        ),
    ]
    session = begin_session(2, BoardFinder(CHECKERBOARD, BOARD.grid_size), BOARD.square, 0.01)
    recorder = Recorder(session, folder)
    frames = PairedFrames(sources, 1.0)
    places_taken = set()
    for recorded in recorder.record(frames, lambda: False):
        assert recorded.state.instruction
        time = next(frame.time for frame in (c.newest for c in frames.cameras) if frame)
        place, since = divmod(time, HOLD + MOVE)
        if recorded.files:
            places_taken.add(place)
        elif since > HOLD / 2 and place not in places_taken:  # in time, before it moves on
            recorder.ask_for_picture()
            places_taken.add(place)
    frames.close()
    return session, recorder


def test_the_pictures_become_a_rig_and_the_clocks_are_compared(tmp_path: Path) -> None:
    session, _ = _capture(tmp_path, 6)
    late, sigma = session.list_offsets()[0, 1]
    assert sigma < 1e-3
    assert abs(late - LATE) < 2 * sigma
    assert any(re.match(r"cam1 is 3[67]\..* ms later", each) for each in describe_pairs(session))
    pairing = pair_photographs([str(tmp_path)])
    assert [camera.name for camera in pairing.cameras] == ["cam0", "cam1"]
    assert len(pairing.shared) == len(session.instants) >= 5
    times = read_times(
        tmp_path / "times.csv", {c.name: [*c.files.values()] for c in pairing.cameras}
    )
    apart = [
        times["cam0"][pairing.cameras[0].files[k]] - times["cam1"][pairing.cameras[1].files[k]]
        for k in pairing.shared
    ]
    assert np.abs(apart).max() <= 0.02 + 1e-6
    found = search_cameras(
        pairing, lambda files, _: find_views([*map(Path, files)], BOARD.grid_size), BOARD.square
    )
    rig = calibrate_photographs(pairing, [found], Settings()).rig
    error = np.r_[rig.poses[1].rvec - POSES[1].rvec, rig.poses[1].tvec - POSES[1].tvec]
    place = rig.layout.pose(1)
    distance = error @ np.linalg.solve(rig.covariance[place, place], error)
    assert np.sqrt(distance / 6) < 2


def test_a_camera_that_dies_costs_nothing_and_ends_no_other(tmp_path: Path) -> None:
    session, recorder = _capture(tmp_path, 3, fails_at=0.6)
    assert len(session.cameras[1].pictures) == 1
    assert len(session.cameras[0].pictures) >= 2
    count = {c: len([*(tmp_path / f"cam{c}").glob("*.png")]) for c in (0, 1)}
    assert count == {0: len(session.instants), 1: 1}
    first = next(iter(recorder.measure_progress(0).pictures))
    session.remove(session.instants[0])
    assert not session.cameras[1].pictures
    assert first not in recorder.measure_progress(0).pictures
