"""Two rendered cameras take their pictures together, and become a rig; what fails ends no other."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from calibgui.app.calibrating.settings import Settings
from calibgui.app.photographs.detection import find_views
from calibgui.app.photographs.recording import BoardFinder, Recorder, begin_session, describe_pairs
from calibgui.app.rig.calibrating import calibrate_photographs, search_cameras
from calibgui.app.rig.pairing import pair_photographs
from calibgui.engine.boards import CHECKERBOARD, Board
from calibgui.engine.camera.camera import Camera
from calibgui.engine.capture import Frame, JointSession, JointState, PairedFrames
from calibgui.engine.capture.camera_links import show_board
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.rig.consensus import Relation
from calibgui.formats.times_csv import read_times
from tests.scenes.hand import RenderedCamera, Walk, follow, spread_places

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


class ChangingCamera(RenderedCamera):
    """Sends images of twice the size in a while."""

    def __init__(self, *args: Any, changed: tuple[float, float], **options: Any) -> None:
        super().__init__(*args, **options)
        self._changed = changed

    def read(self) -> Frame | None:
        frame = super().read()
        if frame is None or not self._changed[0] <= frame.time < self._changed[1]:
            return frame
        return Frame(np.kron(frame.image, np.ones((2, 2), np.uint8)), frame.time)


class Captured(NamedTuple):
    """What a capture left."""

    session: JointSession
    recorder: Recorder
    said: list[str]
    """What was said of cameras that are absent, each once."""
    last: JointState


def _capture(
    folder: Path,
    places: int,
    fails_at: float = np.inf,
    changed: tuple[float, float] = (np.inf, np.inf),
) -> Captured:
    """Take pictures of a board in so many places; the second camera may fail, or change its size
    from one time to another."""
    walk = Walk(spread_places(BOARD, places, np.array([30.0, 0.0, 330.0])), hold=HOLD, move=MOVE)
    sources = [
        RenderedCamera(CAMERAS[0], POSES[0], BOARD, walk, seconds=walk.seconds),
        ChangingCamera(
            CAMERAS[1],
            POSES[1],
            BOARD,
            walk,
            LATE,
            0.013,
            walk.seconds,
            fails_at=fails_at,
            changed=changed,
        ),
    ]
    session = begin_session(2, BoardFinder(CHECKERBOARD, BOARD.grid_size), BOARD.square, 0.01)
    recorder = Recorder(session, folder)
    frames = PairedFrames(sources, 1.0)
    places_taken, said = set(), list[str]()
    for recorded in recorder.record(frames, lambda: False):
        state = recorded.state
        assert state.instruction
        said += [each for each in recorder.describe_absent(frames) if each not in said]
        time = next(frame.time for frame in (c.newest for c in frames.cameras) if frame)
        place, since = divmod(time, HOLD + MOVE)
        if recorded.files:
            places_taken.add(place)
        elif since > HOLD / 2 and place not in places_taken:  # in time, before it moves on
            recorder.ask_for_picture()
            places_taken.add(place)
    frames.close()
    return Captured(session, recorder, said, state)


def test_the_pictures_become_a_rig_and_the_clocks_are_compared(tmp_path: Path) -> None:
    session, _, said, last = _capture(tmp_path, 6)
    assert not said
    _check_goals(last)
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
    session, recorder, said, _ = _capture(tmp_path, 3, fails_at=0.6)
    assert said == ["cam1: a rendered camera stopped sending images. Check its cable."]
    assert len(session.cameras[1].pictures) == 1
    assert len(session.cameras[0].pictures) >= 2
    count = {c: len([*(tmp_path / f"cam{c}").glob("*.png")]) for c in (0, 1)}
    assert count == {0: len(session.instants), 1: 1}
    first = next(iter(recorder.measure_progress(0).pictures))
    session.remove(session.instants[0])
    assert not session.cameras[1].pictures
    assert first not in recorder.measure_progress(0).pictures


def test_a_camera_that_changes_its_size_is_left_out_meanwhile(tmp_path: Path) -> None:
    began, ended = HOLD + MOVE, 2 * (HOLD + MOVE)
    session, recorder, said, _ = _capture(tmp_path, 3, changed=(began, ended))
    assert said == [
        "cam1: The images changed from 320 x 240 px to 640 x 480 px. "
        "It counts again when they have their size."
    ]
    frames = [each[1] for each in session.instants]
    assert [frame is None for frame in frames] == [False, True, False]
    files = sorted(file.name for file in (tmp_path / "cam1").glob("*.png"))
    assert files == ["picture-001.png", "picture-003.png"]
    assert [file.name for file in recorder.measure_progress(1).pictures] == files


def _check_goals(state: JointState) -> None:
    """Check that both cameras show one place where the board is wanted."""
    lead, other = state.leading, 1 - state.leading
    wanted, shown = state.goals[lead], state.goals[other]
    assert wanted is not None
    assert shown is not None
    truth = [Relation.of_pose(pose) for pose in POSES]
    uv = show_board(
        BOARD.points(),
        follow(wanted, CAMERAS[lead], BOARD),
        truth[other].after(truth[lead].invert()),
        CAMERAS[other],
    )
    assert uv is not None
    # Outside of the image nothing tells of the lens.
    is_inside = ((uv >= 0) & (uv < CAMERAS[other].size)).all(axis=1)
    assert np.abs(uv - shown.reshape(-1, 2))[is_inside].max() < 2.0
