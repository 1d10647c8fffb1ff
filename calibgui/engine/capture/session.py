"""A capture: frames of a live image become the photographs that a camera is calibrated from.

The board is followed from frame to frame (`board_tracking`), and found anew now and then and
whenever it was lost. A frame is taken by itself if it is

- still: the corners move by less than a third of a pixel over some frames,
- new: it lowers the uncertainty of the worst pixel by at least half of what the best view would
  (`uncertainty/next_view.py`), or, while the views do not determine the camera, it is near the pose
  that is wanted,
- sharp: its edges are not much more blurred than those of the sharpest one taken,
- well exposed: neither white nor black of the board are cut off (`exposure`), where the light or
  the camera can still be changed.

After each the camera is calibrated with all and the next view proposed. Every fifth picture is put
aside as well: a second camera is calibrated without these, and tells how well what was not seen is
predicted. The capture is complete when the worst pixel's uncertainty has come down to what was
asked for.

A first frame may show but a part of a board whose size nobody stated. When the finder meets a
larger one, the pictures that were taken are found again as parts of it. Which part of a plain board
they show does not matter for the camera.

The lens is the best fitting of three (`MODELS`); the choice among all is left to the calibration
that follows the capture.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np

from calibgui.engine.arrays import Array, GreyImage, Size
from calibgui.engine.boards.board import Board
from calibgui.engine.calibration.board_poses import follow_board, locate_board
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation, make_observation
from calibgui.engine.calibration.result import Calibration, DegenerateError
from calibgui.engine.camera.distortion import project_points
from calibgui.engine.capture.board_tracking import MAX_OFF_PX, measure_motion, track_corners
from calibgui.engine.capture.exposure import judge_exposure
from calibgui.engine.capture.frame_sources import LOOK_SECONDS, Frame
from calibgui.engine.capture.guidance import guide_board
from calibgui.engine.capture.row_readout import RowReadout
from calibgui.engine.detection.detector_io import check_grey_levels
from calibgui.engine.errors import CalibrationError, NoBoardError
from calibgui.engine.features.corners import Corners
from calibgui.engine.geometry.homography import apply_homography, fit_homography
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.geometry.rotations import rotation_from_vector
from calibgui.engine.uncertainty.next_view import (
    NextView,
    predict_uncertainty,
    propose_views,
)
from calibgui.engine.uncertainty.projection_uncertainty import estimate_projection_uncertainty
from calibgui.engine.uncertainty.view_design import ViewDesign

MODELS = ("lucchese", "brown-conrady", "kannala-brandt")
"""The lens models of which the best fitting one is used: the paper's, one for strong barrel
distortion, and one for fisheyes."""
_STILL_PX = 0.3
"""Rms motion of the corners from frame to frame up to which the board is still, px: its share of
the blur is less than that of a pixel."""
_STILL_FRAMES = 5
"""Number of such frames in a row."""
_MAX_BLUR_RATIO = 1.5
"""Blur of the edges over that of the sharpest picture up to which one is sharp: a choice."""
_MIN_USE = 0.5
"""Part of what the best view would gain that a view must gain to be taken: a choice."""
MIN_MATCH = 0.7
"""Match with the wanted pose from which a view is taken while the camera is not determined: within
a third of the board's size, which a tilt of 25 degrees or more survives."""
_VALIDATION_EVERY = 5
"""Of so many pictures one is put aside."""
_WHOLE_BOARD = "Hold the whole board in the picture."
_LOSS = ViewDesign.compute_worst
"""What the next view is to lower: that of the worst pixel, which the capture ends by."""


@dataclass(frozen=True, eq=False, slots=True)
class Picture:
    """A frame that was taken."""

    frame: Frame
    corners: Corners
    observation: Observation
    for_validation: bool
    """True if it is put aside to check a camera with that is calibrated without it."""


@dataclass(frozen=True, eq=False, slots=True)
class CaptureState:
    """The content of a frame, and what is to be done."""

    corners: Corners | None
    """The board in the frame; None if there is none."""
    wanted: NextView | None
    """The view to take next; None before the first picture, and when the capture is complete."""
    goal: Array | None
    """(rows, cols, 2) px, where that view shows the corners; None if there is none."""
    match: float
    """How near the board is to it, 0 to 1."""
    instruction: str
    """The one thing that the user is to do."""
    taken: Picture | None
    """The picture that this frame became."""


class CaptureSession:
    """Follows the board, says what to do, and takes the frames that are worth it.

    Args:
        find: finds the board in an image (h, w), or raises `NoBoardError`. It may come to know that
            the board is larger than it took it to be.
        square: side of a square or distance of circles, mm.
        limit: uncertainty of the worst pixel's projection at which the capture is complete, px.
    """

    def __init__(self, find: Callable[[GreyImage], Corners], square: float, limit: float) -> None:
        self._find = find
        self._square = square
        self.limit = limit
        self.pictures: list[Picture] = []
        self.calibration: Calibration | None = None
        """The camera so far, which may be partial; None before the first picture."""
        self._checked: Calibration | None = None
        """The camera from the pictures that are not put aside; None if none is put aside."""
        self._unseen_error: float | None = np.nan
        """The answer of `measure_unseen_error`; None if it is to be measured anew."""
        self.worst = np.inf
        """Uncertainty of the worst pixel's projection, px; infinite until the views determine the
        camera."""
        self._board: Board | None = None
        self._size: Size | None = None
        self.wanted: NextView | None = None
        """The view to take next; None before the first picture, and at the end."""
        self.goal: Array | None = None
        """(rows, cols, 2) px, where that view shows the corners; None if there is none."""
        self._before: Frame | None = None
        self._corners: Corners | None = None
        self._pose: Pose | None = None
        """The pose of the board in the frame before, as long as it is followed."""
        self._found_at = -np.inf
        self._motions: deque[float] = deque(maxlen=_STILL_FRAMES)
        self._readout = RowReadout()
        self._has_judged = False
        """True if this pose was judged since the board last moved."""
        self.is_new = False
        """True if the board is in a pose that is worth a picture, which was not taken."""
        self._advice = ""
        """Why this pose was not taken, as long as the board stays in it."""

    @property
    def board(self) -> Board | None:
        """The board, as far as the pictures show it; None before the first."""
        return self._board

    @property
    def is_complete(self) -> bool:
        """True if the camera is known as well as was asked for."""
        return self.worst <= self.limit

    @property
    def views(self) -> list[Observation]:
        """The views that the camera is calibrated from."""
        return [each.observation for each in self.pictures]

    def observe(self, frame: Frame, *, is_live: bool = True) -> CaptureState:
        """Look at a frame, and take it if it is still, new, sharp and well exposed.

        Args and errors are those of `look`.
        """
        state = self.look(frame, is_live=is_live)
        return self.take_seen(frame, state) if self.is_new else state

    def look(self, frame: Frame, *, is_live: bool = True) -> CaptureState:
        """Look at a frame: follow the board, and judge it when it has come to rest.

        Args:
            frame: the frame.
            is_live: False if its exposure can no longer be changed, and does not matter.

        Raises:
            CalibrationError: if its size is not that of the frames before.
        """
        self.check_size(frame.image)
        self._follow(frame)
        if self._corners is None:
            self.is_new = False
            return self._state(_WHOLE_BOARD)
        pose = self._locate(self._corners)
        match, instruction = self._guide(pose)
        if not self._is_still:
            self._has_judged, self.is_new, self._advice = False, False, ""
            return self._state(instruction, match)
        if not self._has_judged:
            grey = check_grey_levels(frame.image)
            self._advice = judge_exposure(grey, self._corners) if is_live else ""
            self._has_judged = not self._advice  # the light may change while the board does not
            self.is_new = self._has_judged and self._is_worth_taking(self._corners, pose, match)
        return self._state(self._advice or instruction, match)

    @property
    def is_ready(self) -> bool:
        """True if the board is still and well exposed in the last frame."""
        return self._corners is not None and self._is_still and self._has_judged

    def take_seen(self, frame: Frame, state: CaptureState) -> CaptureState:
        """Take a frame that was looked at, unless it is blurred; return its new state."""
        taken = self.take(frame)
        if taken is None:
            return self._state(self._advice or state.instruction, state.match)
        return self._state("Taken.", state.match, taken)

    def examine(self, frame: Frame) -> CaptureState:
        """Look at a photograph that somebody took by itself, and take it if it shows a sharp board.

        Raises:
            CalibrationError: if its size is not that of those before.
        """
        picture = self.take(frame)
        self._corners = None if picture is None else picture.corners
        if picture is None:
            return self._state(self._advice)
        match, instruction = self._guide(self._locate(picture.corners))
        return self._state(instruction, match, picture)

    def take(self, frame: Frame) -> Picture | None:
        """Take a frame, whatever it adds, unless it shows no board or is blurred.

        Raises:
            CalibrationError: if its size is not that of those before.
        """
        self.is_new = False
        self.check_size(frame.image)
        try:
            corners = self._find_board(frame.image)
        except NoBoardError as error:
            self._advice = error.message
            return None
        if corners.relative:  # which part of the board it is cannot be told
            self._advice = _WHOLE_BOARD
            return None
        if self._is_blurred(corners):
            self._advice = "It is blurred here: hold it still, and check the focus."
            return None
        if self._board is None:
            self._board = Board(*corners.shape, self._square, corners.pattern)
        try:
            observation = self._make_observation(corners)
        except CalibrationError as error:
            self._advice = error.message
            return None
        is_aside = len(self.pictures) % _VALIDATION_EVERY == _VALIDATION_EVERY - 1
        picture = Picture(frame, corners, observation, is_aside)
        was_known = self.calibration is not None
        self.pictures.append(picture)
        self._learn()
        if was_known and self.calibration is None:  # nothing more would ever be learnt with it
            self.remove(picture)
            self._advice = "It contradicts the pictures taken before: take back one that is wrong."
            return None
        return picture

    def remove(self, picture: Picture) -> None:
        """Take a picture back: the camera is calibrated without it.

        Raises:
            ValueError: if it was not taken.
        """
        self.pictures.remove(picture)
        self._learn()

    def restore(self, picture: Picture) -> None:
        """Take a picture again that was taken back."""
        assert self._board is not None
        is_whole = picture.corners.shape == self._board.grid_size
        self.pictures += [picture] if is_whole else self._find_again([picture])
        self._learn()

    def compute_tilts(self) -> Array:
        """Compute the normals (n, 3) of the boards, in the camera's frame, towards the camera.

        They are those of the pictures that the camera is calibrated from.
        """
        if self.calibration is None:
            return np.empty((0, 3))
        rvecs = np.array([pose.rvec for pose in self.calibration.poses])
        return -rotation_from_vector(rvecs)[..., 2]

    def measure_unseen_error(self) -> float:
        """Measure the rms distance, px, of corners put aside from where they are expected.

        It is that of a camera that is calibrated without them; their boards' poses are estimated.
        NaN if none was put aside, or no camera is known without them.
        """
        if self._unseen_error is None:
            aside = [each.observation for each in self.pictures if each.for_validation]
            self._unseen_error = np.nan
            if aside and self._checked is not None:
                missed = [locate_board(self._checked.camera, view).residuals for view in aside]
                squares = np.sum(np.concatenate(missed) ** 2, axis=1)
                self._unseen_error = float(np.sqrt(np.mean(squares)))
        return self._unseen_error

    def _state(
        self, instruction: str, match: float = 0.0, taken: Picture | None = None
    ) -> CaptureState:
        return CaptureState(self._corners, self.wanted, self.goal, match, instruction, taken)

    def check_size(self, image: GreyImage) -> None:
        """Check the size of an image.

        Raises:
            CalibrationError: if it is not that of those before.
        """
        size = (image.shape[1], image.shape[0])
        self._size = self._size or size
        if size != self._size:
            raise CalibrationError(
                f"The images changed from {self._size[0]} x {self._size[1]} px to "
                f"{size[0]} x {size[1]} px.",
                "A camera is calibrated for images of one size: start again. What was taken before "
                "is kept.",
            )

    def _follow(self, frame: Frame) -> None:
        """Follow the board to this frame, or find it."""
        before, self._before = self._before, frame
        image, time = frame
        corners, motion = None, np.inf
        if self._corners is not None and before is not None:
            corners = track_corners(before.image, image, self._corners)
            if corners is not None:
                motion = measure_motion(self._corners, corners)
        self._motions.append(motion)
        if corners is None or time - self._found_at >= LOOK_SECONDS:
            with suppress(NoBoardError):  # a blurred one can be followed where it cannot be found
                found = self._find_board(image)
                self._found_at = time
                if corners is None or not measure_motion(corners, found) <= MAX_OFF_PX:
                    self._pose = None  # it may be counted from another end
                if corners is not None and self._corners is not None and before is not None:
                    self._time_rows(found, self._corners, corners, time - before.time)
                corners = found
        self._corners = corners
        if corners is None:
            self._pose = None

    def _time_rows(self, found: Corners, before: Corners, after: Corners, seconds: float) -> None:
        """Learn how long rows take from corners found, and how they were followed to there."""
        if self.calibration is None or self.calibration.diagnosis is not None or seconds <= 0:
            return
        pose = self._locate(found)
        if pose is None or self._board is None:
            return
        came_from = _map_back(before, after, found.uv)
        self._readout.add_frame(
            self.calibration.camera,
            pose,
            self._board.points(found.grid),
            found.uv,
            (found.uv - came_from) / seconds,
        )

    def describe_readout(self) -> str:
        """Say how long the camera's rows take, where what moved told; else ""."""
        return self._readout.describe()

    @property
    def _is_still(self) -> bool:
        full = len(self._motions) == _STILL_FRAMES
        return full and max(self._motions) <= _STILL_PX

    def _find_board(self, image: GreyImage) -> Corners:
        """Find the board, and with it those of earlier pictures if it is larger than they told.

        Raises:
            NoBoardError: if there is none.
        """
        corners = self._find(check_grey_levels(image))
        board = self._board
        if board is not None and corners.shape != board.grid_size:
            self._board = Board(*corners.shape, self._square, corners.pattern)
            self.pictures = self._find_again(self.pictures)
            self._learn()
        return corners

    def _find_again(self, pictures: Iterable[Picture]) -> list[Picture]:
        """Find the board in pictures again; those in which it is not found are left out."""
        again = []
        for each in pictures:
            with suppress(CalibrationError):
                corners = self._find(check_grey_levels(each.frame.image))
                observation = self._make_observation(corners)
                again.append(replace(each, corners=corners, observation=observation))
        return again

    def _make_observation(self, corners: Corners) -> Observation:
        """Make the view of these corners; raises CalibrationError as `make_observation`."""
        assert self._board is not None
        return make_observation(corners.uv, self._board.points(corners.grid), corners.cov)

    def _locate(self, corners: Corners) -> Pose | None:
        """Locate the board with the camera so far, near where it was if it was followed."""
        if self.calibration is None or self._board is None:
            return None
        view, camera = (corners.uv, self._board.points(corners.grid)), self.calibration.camera
        try:
            self._pose = (
                locate_board(camera, view).pose
                if self._pose is None
                else follow_board(camera, view, self._pose)
            )
        except CalibrationError:
            self._pose = None
        return self._pose

    def _guide(self, pose: Pose | None) -> tuple[float, str]:
        """Return the match with the wanted view, and what to do."""
        if self._board is None or self.calibration is None or self.wanted is None or pose is None:
            return 0.0, "Hold it still."
        guidance = guide_board(
            pose, self.wanted.pose, self._board.points(), self.calibration.camera
        )
        return guidance.match, guidance.instruction

    def _is_worth_taking(self, corners: Corners, pose: Pose | None, match: float) -> bool:
        """Return whether a view is as new as is wanted."""
        if self.calibration is None or self.wanted is None:
            return not self.pictures
        if pose is None or self._board is None:
            return False
        if self.calibration.diagnosis is not None:
            return match >= MIN_MATCH
        view = make_observation(corners.uv, self._board.points(corners.grid))
        after = predict_uncertainty(self.calibration, self.views, view, pose, _LOSS)
        gain, best = self.wanted.before - after, self.wanted.before - self.wanted.after
        return bool(gain >= _MIN_USE * best)

    def _is_blurred(self, corners: Corners) -> bool:
        """Return whether a picture is blurred beside those that were taken."""
        taken = [_measure_blur(each.corners) for each in self.pictures]
        return bool(taken) and _measure_blur(corners) > _MAX_BLUR_RATIO * min(taken)

    def _learn(self) -> None:
        """Calibrate with what was taken, and propose the next view."""
        assert self._size is not None
        views = self.views
        self.calibration = _calibrate(views, self._size, MODELS) if views else None
        kept = [each.observation for each in self.pictures if not each.for_validation]
        self._checked, self._unseen_error = None, None
        if self.calibration is not None and len(kept) < len(views):
            self._checked = _calibrate(kept, self._size, (self.calibration.camera.model,))
        self.worst, self.wanted, self.goal = np.inf, None, None
        if self.calibration is None:
            return
        if self.calibration.diagnosis is None:
            self.worst = estimate_projection_uncertainty(self.calibration, views).worst
        if self.is_complete:
            return
        assert self._board is not None
        with suppress(CalibrationError):
            (self.wanted,) = propose_views(self.calibration, views, 1, _LOSS)
            corners = self._board.points()
            goal = project_points(corners, self.calibration.camera, self.wanted.pose)
            self.goal = goal.reshape(*self._board.grid_size, 2)


def _calibrate(views: list[Observation], size: Size, models: Iterable[str]) -> Calibration | None:
    """Calibrate in the model that fits better, whole or, if need be, in part; None if neither."""
    found = []
    for model in models:
        try:
            found.append(calibrate(views, size, model=model))
        except DegenerateError as error:
            if error.partial is not None:
                found.append(error.partial)
        except CalibrationError:
            continue
    whole = [each for each in found if each.diagnosis is None]
    return min(whole or found, key=lambda each: each.noise, default=None)


def _map_back(before: Corners, after: Corners, uv: Array) -> Array:
    """Return where points (n, 2) px near corners after came from, as a plane between two frames."""
    places = {tuple(cell): k for k, cell in enumerate(before.grid.tolist())}
    kept = [places[tuple(cell)] for cell in after.grid.tolist()]
    H = fit_homography(after.uv, before.uv[kept], np.ones(len(kept)))
    return apply_homography(H, uv)


def _measure_blur(corners: Corners) -> float:
    """Return the median blur of the corners' edges, px; 0 where the finder tells none."""
    return 0.0 if corners.blur is None else float(np.nanmedian(corners.blur))
