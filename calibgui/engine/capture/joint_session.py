"""A joint capture: one or several cameras that photograph a board at the same instants.

Each camera has a session of its own (`session`), which follows the board and says what it lacks. A
picture is taken of all cameras at once when the board is still in all that see it, and new for one
of them: as a view of that camera alone, or as a view that two cameras share of which it is not yet
known how they stand to each other (`camera_links`). These pairs are those of the tree that joins
all cameras by the most common views.

One thing is said at a time: what the camera lacks that is known worst, then which two cameras have
too few common views. While the board moves, its tracks tell how far the clocks of two cameras are
apart (`clock_offsets`). One camera is the case in which there are no pairs.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.capture.board_tracking import measure_motion
from calibgui.engine.capture.camera_links import (
    Link,
    find_relations,
    measure_link,
    show_board,
)
from calibgui.engine.capture.clock_offsets import Seen, Track, estimate_clock_offset
from calibgui.engine.capture.frame_sources import Frame
from calibgui.engine.capture.guidance import EASY_SHIFT
from calibgui.engine.capture.latest_frames import Instant
from calibgui.engine.capture.scattered_mean import ScatteredMean
from calibgui.engine.capture.session import MIN_MATCH, CaptureSession, CaptureState, Picture
from calibgui.engine.errors import CalibrationError
from calibgui.engine.features.corners import Corners
from calibgui.engine.rig.consensus import Relation, find_tree

_TRACK_FRAMES = 100
"""Number of frames of a moving board that tell an offset in time, at most: two cameras take 0.4 s
for it."""


@dataclass(frozen=True, eq=False, slots=True)
class JointState:
    """The boards in the frames of one instant, and what is to be done."""

    cameras: tuple[CaptureState | None, ...]
    """The state of each camera; None of one that sent no frame."""
    leading: int
    """Number of the camera whose wanted view is to be followed."""
    goals: tuple[Array | None, ...]
    """(rows, cols, 2) px, where each camera sees the corners in that view, perhaps not all of them;
    None of a camera that sees none, or of which it is not known well enough how it stands."""
    instruction: str
    """The one thing that the user is to do."""

    @property
    def taken(self) -> tuple[Picture | None, ...]:
        """The picture that each camera's frame became; None where it became none."""
        return tuple(None if state is None else state.taken for state in self.cameras)

    @property
    def is_taken(self) -> bool:
        """True if the frames of this instant were taken."""
        return any(picture is not None for picture in self.taken)


class JointSession:
    """Looks at the frames of all cameras, says what to do, and takes those that are worth it.

    Args:
        cameras: the session of each camera.
        names: what they are called in words.
    """

    def __init__(self, cameras: Sequence[CaptureSession], names: Sequence[str]) -> None:
        self.cameras, self.names = tuple(cameras), tuple(names)
        self.changed: dict[int, str] = {}
        """Sentences on the cameras whose last images had another size, by their numbers."""
        self.instants: list[Instant] = []
        """The frames that were taken together."""
        self.links: tuple[Link, ...] = ()
        """The pairs of cameras that join all of them, or are to."""
        self._offsets: dict[tuple[int, int], ScatteredMean] = {}
        self._tracks = [deque[Seen](maxlen=_TRACK_FRAMES) for _ in cameras]
        self._found_goals: tuple[Array, tuple[Array | None, ...]] | None = None
        """The goal of a leading camera, and where all see that view."""
        self._is_decided = False
        """True if it was decided whether to take this pose, since the board last moved."""
        self._link_cameras()

    @property
    def is_complete(self) -> bool:
        """True if all cameras, and how they stand, are known as well as was asked for."""
        return all(each.is_complete for each in self.cameras) and not self._list_weak_links()

    @property
    def worst(self) -> float:
        """Uncertainty of the worst pixel of the camera that is known worst, px."""
        return max(camera.worst for camera in self.cameras)

    def state_limit(self, limit: float) -> None:
        """State the uncertainty at which the capture is complete, px."""
        for camera in self.cameras:
            camera.limit = limit

    def leave_out_changed(self, frames: Instant) -> Instant:
        """Leave out the frames of cameras that changed their size; the others go on without them.

        Raises:
            CalibrationError: if the images of a single camera change their size.
        """
        kept: list[Frame | None] = []
        self.changed = {}
        for c, frame in enumerate(frames):
            kept.append(frame)
            try:
                if frame is not None:
                    self.cameras[c].check_size(frame.image)
            except CalibrationError as error:
                if len(frames) == 1:
                    raise
                self.changed[c] = f"{error.message} It counts again when they have their size."
                kept[c] = None
        return tuple(kept)

    def observe(self, frames: Instant, *, is_live: bool = True) -> JointState:
        """Look at the frames of an instant, and take them if they are worth it.

        Args:
            frames: the frame of each camera; None of one that sent none.
            is_live: False if their exposure can no longer be changed, and does not matter.

        Raises:
            CalibrationError: if the images of a camera change their size.
        """
        states = [
            None if frame is None else camera.look(frame, is_live=is_live)
            for camera, frame in zip(self.cameras, frames, strict=True)
        ]
        seeing = [c for c, state in enumerate(states) if state is not None and state.corners]
        is_ready = bool(seeing) and all(self.cameras[c].is_ready for c in seeing)
        self._remember_board(frames, states)
        is_wanted = False
        if is_ready and not self._is_decided:
            self._compare_clocks()
            is_new = any(self.cameras[c].is_new for c in seeing)
            is_wanted = is_new or self._is_new_for_links(states)
        self._is_decided = is_ready
        if not is_wanted:
            return self._state(states)
        for c in seeing:
            frame, state = frames[c], states[c]
            assert frame is not None and state is not None
            states[c] = self.cameras[c].take_seen(frame, state)
        return self._take_instant(frames, states)

    def examine(self, frames: Instant) -> JointState:
        """Look at frames that somebody took by themselves, and take them if one shows a sharp
        board.

        Raises:
            CalibrationError: if the images of a camera change their size.
        """
        states = [
            None if frame is None else camera.examine(frame)
            for camera, frame in zip(self.cameras, frames, strict=True)
        ]
        return self._take_instant(frames, states)

    def remove(self, frames: Instant) -> list[Picture | None]:
        """Take an instant back: the cameras are calibrated without it. Return its pictures."""
        pictures = self.find_pictures(frames)
        for camera, picture in zip(self.cameras, pictures, strict=True):
            if picture is not None:
                camera.remove(picture)
        self._link_cameras()
        return pictures

    def restore(self, pictures: Sequence[Picture | None]) -> None:
        """Take an instant again that was taken back."""
        for camera, picture in zip(self.cameras, pictures, strict=True):
            if picture is not None:
                camera.restore(picture)
        self._link_cameras()

    def find_pictures(self, frames: Instant) -> list[Picture | None]:
        """Find the pictures of an instant; None where a camera's frame does not count."""
        return [
            next((each for each in camera.pictures if each.frame is frame), None)
            for camera, frame in zip(self.cameras, frames, strict=True)
        ]

    def list_offsets(self) -> dict[tuple[int, int], tuple[float, float]]:
        """List by how much the clock of the second camera of a pair is later than the first's, and
        the standard deviation, s; of the pairs of which two motions or more told it."""
        found = {pair: offset.estimate() for pair, offset in self._offsets.items()}
        return {pair: each for pair, each in found.items() if np.isfinite(each[1])}

    def _take_instant(self, frames: Instant, states: list[CaptureState | None]) -> JointState:
        """Keep the frames together, if one of them was taken."""
        if any(state is not None and state.taken for state in states):
            self.instants.append(frames)
            self._link_cameras()
        return self._state(states)

    def _state(self, states: Sequence[CaptureState | None]) -> JointState:
        """Say one thing: to the camera that is known worst, or on the pair that is."""
        present = [c for c, state in enumerate(states) if state is not None]
        leading = min(present, key=self._rank_camera, default=0)
        goals = self._find_goals(leading)
        return JointState(tuple(states), leading, goals, self._instruct(states, leading))

    def _find_goals(self, leading: int) -> tuple[Array | None, ...]:
        """Find where each camera sees the view that is wanted of the leading one."""
        goal, wanted = self.cameras[leading].goal, self.cameras[leading].wanted
        board = self.cameras[leading].board
        goals = [goal if c == leading else None for c in range(len(self.cameras))]
        if goal is None or wanted is None or board is None or len(goals) == 1:
            return tuple(goals)
        if self._found_goals is not None and self._found_goals[0] is goal:
            return self._found_goals[1]
        for c, (relation, worst) in find_relations(self.links, leading).items():
            calibration = self.cameras[c].calibration
            if c == leading or calibration is None:
                continue
            camera = calibration.camera
            if worst <= EASY_SHIFT * camera.size[0]:
                uv = show_board(board.points(), wanted.pose, relation, camera)
                goals[c] = None if uv is None else uv.reshape(goal.shape)
        self._found_goals = goal, tuple(goals)
        return tuple(goals)

    def _instruct(self, states: Sequence[CaptureState | None], leading: int) -> str:
        state = states[leading]
        if state is None:
            return "No camera sends images."
        if len(states) == 1:
            return state.instruction
        if any(each is not None and each.taken for each in states):
            return "Taken."
        if self.cameras[leading].is_complete and (weak := self._list_weak_links()):
            return self._describe_lack(weak[0])
        return f"{self.names[leading]}: {state.instruction}"

    def _rank_camera(self, c: int) -> tuple[bool, float, int]:
        """Rank cameras: those that are not known well enough first, the worst known ahead, and of
        those not determined the one with fewest pictures."""
        camera = self.cameras[c]
        return camera.is_complete, -camera.worst, len(camera.pictures)

    def _describe_lack(self, link: Link) -> str:
        """Say what a pair of cameras lacks."""
        first, second = self.names[link.first], self.names[link.second]
        if not link.shared:
            return f"Hold the board where {first} and {second} both see it."
        missing = link.count_missing(self.cameras[link.first].limit)
        return (
            f"Hold the board elsewhere where {first} and {second} both see it: "
            f"about {missing} more common views are needed."
        )

    def _link_cameras(self) -> None:
        """Find the pairs that join the cameras, and how well each is known."""
        self._found_goals = None
        count = len(self.cameras)
        pictures = [self.find_pictures(frames) for frames in self.instants]
        shared = np.zeros((count, count), dtype=np.int64)
        for each in pictures:
            there = np.array([picture is not None for picture in each])
            shared += np.outer(there, there)
        tree = find_tree(shared)
        joined = {0, *(second for _, second in tree)}
        tree += [(0, c) for c in range(count) if c not in joined]
        self.links = tuple(
            Link(a, b, int(shared[a, b]), *self._measure_link(a, b, pictures)) for a, b in tree
        )

    def _measure_link(
        self, a: int, b: int, pictures: list[list[Picture | None]]
    ) -> tuple[float, Relation | None]:
        """Measure how two cameras stand to each other, and how well it is known, px."""
        calibrations = self._get_calibrations(a, b)
        views = tuple(
            {
                k: picture.observation
                for k, each in enumerate(pictures)
                if (picture := each[c]) is not None and each[a] and each[b]
            }
            for c in (a, b)
        )
        if calibrations is None or not views[0]:
            return np.inf, None
        return measure_link(calibrations, (views[0], views[1]))

    def _get_calibrations(self, a: int, b: int) -> tuple[Calibration, Calibration] | None:
        """Return what is known of two cameras; None if one is not determined."""
        first, second = self.cameras[a].calibration, self.cameras[b].calibration
        if first is None or second is None or first.diagnosis or second.diagnosis:
            return None
        return first, second

    def _list_weak_links(self) -> list[Link]:
        """List the pairs that have too few common views, the worst known first."""
        weak = [each for each in self.links if each.count_missing(self.cameras[each.first].limit)]
        return sorted(weak, key=lambda link: -link.worst)

    def _is_new_for_links(self, states: Sequence[CaptureState | None]) -> bool:
        """Return whether a pair that has too few common views sees the board in a new place."""
        seen = [None if state is None else state.corners for state in states]
        for link in self._list_weak_links():
            now = seen[link.first], seen[link.second]
            if now[0] is None or now[1] is None:
                continue
            pictures = [self.find_pictures(frames) for frames in self.instants]
            pairs = [(each[link.first], each[link.second]) for each in pictures]
            if not any(a and b and _is_same_place(a.corners, now[0]) for a, b in pairs):
                return True
        return False

    def _remember_board(self, frames: Instant, states: Sequence[CaptureState | None]) -> None:
        """Remember where the board is, counted from a known corner."""
        for track, frame, state in zip(self._tracks, frames, states, strict=True):
            if frame and state and state.corners and not state.corners.relative:
                track.append(Seen(frame.time, state.corners))

    def _compare_clocks(self) -> None:
        """Learn what a motion that has come to rest tells of the clocks."""
        for link in self.links:
            calibrations = self._get_calibrations(link.first, link.second)
            board = self.cameras[link.first].board
            if calibrations is None or board is None:
                continue
            first, second = (
                Track(calibration.camera, tuple(self._tracks[c]))
                for calibration, c in zip(calibrations, (link.first, link.second), strict=True)
            )
            if found := estimate_clock_offset(first, second, board):
                mean = self._offsets.setdefault((link.first, link.second), ScatteredMean())
                mean.add(found[0], 1 / found[1] ** 2)
        for track in self._tracks:
            track.clear()


def _is_same_place(before: Corners, now: Corners) -> bool:
    """Return whether a board is about where it was, as a picture shows it."""
    size = float(np.linalg.norm(np.ptp(before.uv, axis=0)))
    return 1 - measure_motion(before, now) / size >= MIN_MATCH
