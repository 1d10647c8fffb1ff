"""Hand and eye: where the calibrated camera is in a robot's hand, or beside the robot."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from PySide6.QtWidgets import (
    QComboBox,
    QDialog,
    QFileDialog,
    QLabel,
    QLineEdit,
    QSplitter,
    QWidget,
)

from calibgui.app.calibrating.hand_eye import find_hand_eye, parse_point
from calibgui.app.outputs.output_files import check_suffix
from calibgui.dataset import HandEyeSet, Result
from calibgui.formats.hand_eye_files import WRITERS
from calibgui.formats.robot_poses import read_robot_poses
from calibgui.gui.jobs.jobs import Jobs
from calibgui.gui.panels.latest import Latest
from calibgui.gui.panels.parts.estimates import estimate_columns
from calibgui.gui.verdict.sentences import translate_sentences
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.actions import make_buttons
from calibgui.gui.widgets.buttons import Button
from calibgui.gui.widgets.elided import ElidedLabel
from calibgui.gui.widgets.layouts import keep_place, make_column, make_row
from calibgui.gui.widgets.save_names import ask_for_name
from calibgui.gui.widgets.tables import Column, Table, with_digits
from calibgui.gui.widgets.wrapped_label import WrappedLabel
from calibgui.report.hand_eye import (
    describe_in_a_line,
    find_outliers,
    list_hand_eye_remarks,
    measure_errors,
)


class HandEyeDialog(QDialog):
    """Finds hand and eye from a calibration and the robot's poses, by a job at every change.

    Args:
        jobs: that read the poses, compute and write.
        result: the calibration, with the photographs that were taken at the robot's poses.
        parent: over which the dialog opens.
    """

    def __init__(self, jobs: Jobs, result: Result, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle(self.tr("Hand and eye"))
        self._jobs, self._work, self._result = jobs, Latest(jobs, self), result
        self._poses: Path | None = None
        self._point = ""
        self._without: frozenset[str] = frozenset()
        self._rows: list[str] = []
        self._chosen = ""
        self.found: HandEyeSet | None = None
        """What is shown; None while there is nothing."""
        self.choose = Button(self.tr("Robot's &poses…"), takes_enter=False)
        self.choose.setToolTip(
            self.tr(
                "CSV, JSON, text or MAT: a pose for each photograph, by its name or in their "
                "order, in any units and convention"
            )
        )
        self.choose.clicked.connect(self._ask_for_poses)
        self.file = ElidedLabel()
        self.mount = QComboBox()
        self.mount.setAccessibleName(self.tr("Where the camera is"))
        for text, eye_in_hand in (
            (self.tr("as the poses tell"), None),
            (self.tr("in the hand"), True),
            (self.tr("beside the robot"), False),
        ):
            self.mount.addItem(text, eye_in_hand)
        self.mount.currentIndexChanged.connect(self._find)
        self.tool = QLineEdit()
        self.tool.setAccessibleName(self.tr("The tool's point in the hand's frame"))
        self.tool.setPlaceholderText(self.tr("X, Y, Z: the board"))
        self.tool.setToolTip(
            self.tr("Where ± is stated, as 0, 0, 120; if empty, it is where the board was")
        )
        self.tool.editingFinished.connect(self._take_point)
        self.headline, self.words = WrappedLabel(), WrappedLabel()
        self.headline.setFont(theme.make_font(theme.FIGURE, bold=True))
        self.poses, self.errors = Table(), Table()
        self.errors.picked.connect(self._pick)
        self.leave_out = Button(takes_enter=False)
        self.leave_out.clicked.connect(self._leave_out)
        self.save = Button(self.tr("&Save…"), takes_enter=False)
        self.save.clicked.connect(self._ask_and_save)
        self.said = WrappedLabel()
        self._lay_out()
        self.setMinimumSize(640, 440)
        self.resize(1000, 600)
        self._invite()

    def _lay_out(self) -> None:
        camera, tool = QLabel(self.tr("Camera")), QLabel(self.tr("Tool at"))
        point = make_row(tool, self.tool, QLabel(self.tr("mm")))
        above = make_row(self.choose, (self.file, 1), camera, self.mount, point)
        self._shown = QSplitter()
        for table in (self.poses, self.errors):
            self._shown.addWidget(table)
        self._shown.setSizes([560, 440])
        keep_place(self._shown)
        below = make_row((self.said, 1), make_buttons(self, self.leave_out, self.save))
        make_column(
            above, self.headline, self.words, (self._shown, 1), below, of=self, margins=theme.MARGIN
        )

    def _invite(self) -> None:
        """Ask for the poses, or for the side of a square first."""
        is_known = self._result.lengths_confirmed
        self.choose.setEnabled(is_known)
        self._clear(
            self.tr("Choose the file of the poses at which the robot stood for the photographs.")
            if is_known
            else self.tr(
                "The side of a square is not known, and the robot's poses have lengths. Close "
                "this, and answer in the window how long the squares are."
            )
        )

    def _ask_for_poses(self) -> None:
        name, _ = QFileDialog.getOpenFileName(
            self,
            self.tr("Poses of the robot"),
            "",
            self.tr("Poses (*.csv *.json *.txt *.mat);;All files (*)"),
        )
        if name:
            self.show_poses(Path(name))

    def show_poses(self, path: Path) -> None:
        """Find hand and eye with the poses of a file."""
        self._poses, self._without, self._chosen = path, frozenset(), ""
        self.file.setText(path.name)
        self._clear("")
        self._find()

    def _take_point(self) -> None:
        """Find anew if the tool's point is another one."""
        if self.tool.text() != self._point:
            self._find()

    def _find(self) -> None:
        """Find hand and eye by what is stated now, once the poses are chosen."""
        path, result, without = self._poses, self._result, self._without
        eye_in_hand, text = self.mount.currentData(), self.tool.text()
        self._work.cancel()
        self._point = text
        try:
            point = parse_point(text) if text.strip() else None
        except ValueError:
            self._clear(self.tr("{0} is no point X, Y, Z, such as 0, 0, 120.").format(text))
            return
        if path is None:
            self._invite()
            return
        self.found = None
        self.save.setEnabled(False)
        self.words.setText(self.tr("working…"))
        self.said.setText("")
        self._work.start(
            self.tr("Finding hand and eye"),
            lambda _: find_hand_eye(result, read_robot_poses(path), eye_in_hand, point, without),
            self._show,
            self._fail,
        )

    def _fail(self, error: Exception) -> None:
        """Say why nothing is found, and let what was left out be used again."""
        self._clear(translate_sentences(str(error)))
        if self._without:
            self._tabulate_errors({}, set())
            self._shown.setVisible(True)
            self._offer_to_leave_out()

    def _clear(self, text: str) -> None:
        self.found = None
        self.headline.setText("")
        self.headline.hide()
        self.words.setText(text)
        self.said.setText("")
        self._rows = []
        self.poses.show_columns([])
        self.errors.show_columns([])
        self._shown.setVisible(False)
        self.save.setEnabled(False)
        self._offer_to_leave_out()

    def _show(self, hand_eye_set: HandEyeSet) -> None:
        self.found = hand_eye_set
        line = describe_in_a_line(hand_eye_set)
        self.headline.setText(translate_sentences(line[0].upper() + line[1:]))
        self.headline.show()
        remarks = list_hand_eye_remarks(hand_eye_set, mount="above", leave_out="below")
        self.words.setText("\n".join(map(translate_sentences, remarks)))
        self._tabulate_poses(hand_eye_set)
        found = hand_eye_set.found
        errors = dict(zip(found.names, measure_errors(found).tolist(), strict=True))
        self._tabulate_errors(errors, {found.names[k] for k in find_outliers(found)})
        self._shown.setVisible(True)
        self.save.setEnabled(True)
        self._offer_to_leave_out()

    def _tabulate_poses(self, hand_eye_set: HandEyeSet) -> None:
        """Show the poses of camera and board."""
        found = hand_eye_set.found
        camera, board = (
            (self.tr("Camera in the hand"), self.tr("Board in the base"))
            if found.eye_in_hand
            else (self.tr("Camera in the base"), self.tr("Board in the hand"))
        )
        columns = [
            Column(
                self.tr("Pose"),
                ["X", "Y", "Z", *(self.tr("rotation vector, {0}").format(axis) for axis in "XYZ")],
            )
        ]
        for title, pose, covariance in (
            (camera, found.camera_pose, found.covariance),
            (board, found.board_pose, found.board_covariance),
        ):
            sigma = np.sqrt(np.diag(covariance))
            values = [*pose.tvec, *np.degrees(pose.rvec)]
            columns += estimate_columns(title, values, [*sigma[3:], *np.degrees(sigma[:3])])
        columns.append(Column(self.tr("Unit"), [self.tr("mm")] * 3 + [self.tr("degrees")] * 3))
        self.poses.show_columns(columns)

    def _tabulate_errors(self, errors: dict[str, list[float]], outliers: set[str]) -> None:
        """Show the robot's error in each pose, and the photographs that are left out.

        Args:
            errors: rad and mm, by the name of the photograph.
            outliers: names of those that stand out.
        """
        views = self._result.views
        self._rows = [v.name for v in views if v.name in errors or v.name in self._without]
        shown = [errors.get(name, (math.nan, math.nan)) for name in self._rows]
        tip = self.tr("The most likely error of the robot's pose")
        self.errors.show_columns(
            [
                Column(self.tr("Photograph"), self._rows),
                Column(
                    self.tr("Robot off by"),
                    [shift for _, shift in shown],
                    with_digits(2),
                    tip,
                    unit=self.tr("mm"),
                ),
                Column(
                    self.tr("Turned by"),
                    [math.degrees(turn) for turn, _ in shown],
                    with_digits(2),
                    tip,
                    unit=self.tr("degrees"),
                ),
                Column(
                    self.tr("Used"),
                    [
                        self.tr("left out") if n in self._without else self.tr("yes")
                        for n in self._rows
                    ],
                ),
            ],
            [row for row, name in enumerate(self._rows) if name in outliers],
        )
        self.errors.select(self._rows.index(self._chosen) if self._chosen in self._rows else -1)

    def _pick(self, row: int) -> None:
        self._chosen = self._rows[row] if 0 <= row < len(self._rows) else ""
        self._offer_to_leave_out()

    def _offer_to_leave_out(self) -> None:
        """Let the chosen photograph be left out, or taken in again."""
        is_out = self._chosen in self._without
        self.leave_out.setText(self.tr("&Use again") if is_out else self.tr("&Leave out"))
        self.leave_out.setEnabled(self._chosen in self._rows)

    def _leave_out(self) -> None:
        self._without ^= {self._chosen}
        self._find()

    def _ask_and_save(self) -> None:
        path = ask_for_name(
            self,
            self.tr("Save hand and eye"),
            "hand_eye.json",
            self.tr("Hand and eye (*.json);;ROS, easy_handeye2 (*.calib);;OpenCV (*.yaml *.yml)"),
        )
        if path is not None:
            self.write(path)

    def write(self, path: Path) -> None:
        """Write what is shown, in the format that the suffix tells, by a job."""
        found = self.found
        if found is None:
            return

        def work(_: object) -> None:
            check_suffix(path, WRITERS, "a file of hand and eye")
            WRITERS[path.suffix.lower()][1](found, path)

        self._jobs.start(
            self.tr("Writing {0}").format(path.name),
            work,
            lambda _: self.said.setText(self.tr("Saved as {0}.").format(path.name)),
            failed=lambda error: self.said.setText(str(error)),
            owner=self,
        )
