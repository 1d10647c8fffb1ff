"""The worth of a rig, in words and tables."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QLabel, QSizePolicy, QWidget

from calibgui.dataset import RigResult
from calibgui.engine.numbers import format_two_digits
from calibgui.engine.rig import estimate_point_uncertainty
from calibgui.gui.verdict.sentences import translate_sentences
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.layouts import make_column
from calibgui.gui.widgets.tables import Column, Table, with_decimals
from calibgui.gui.widgets.wrapped_label import WrappedLabel
from calibgui.report.numbers import format_with_sigma
from calibgui.report.rig import (
    describe_boards,
    describe_disagreement,
    describe_fit,
    describe_mistake,
    describe_offsets,
    describe_turned,
    measure_board_distance,
    measure_board_turn,
    measure_distance,
    measure_turn,
)


class RigAnswer(QWidget):
    """The fit and what is wrong, then how the cameras stand, and how well points are located."""

    def __init__(self) -> None:
        super().__init__()
        self._is_sound = True
        self.headline, self.words = WrappedLabel(), WrappedLabel()
        self.headline.setFont(theme.make_font(theme.HEADLINE, bold=True))
        self.places, self.boards, self.cameras, self.points = (Table() for _ in range(4))
        self.condition = WrappedLabel()
        self._titles: dict[Table, QLabel] = {}
        for text, table in (
            (self.tr("Where the cameras stand"), self.places),
            (self.tr("Where the boards stand"), self.boards),
            (self.tr("Cameras"), self.cameras),
            (self.tr("Points ahead"), self.points),
        ):
            title = self._titles[table] = QLabel(text)
            title.setFont(theme.make_font(theme.CAPTION, bold=True))
            table.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
            table.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
            table.setVerticalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        tables = (part for table, title in self._titles.items() for part in (title, table))
        make_column(self.headline, self.words, *tables, self.condition, None, of=self)
        theme.follow(self._restyle)

    def _restyle(self) -> None:
        colours = theme.current()
        theme.set_text_colour(self.headline, colours.good if self._is_sound else colours.warning)

    def show_result(self, result: RigResult) -> None:
        """Show a rig."""
        rig = result.rig
        self._is_sound = not (rig.disagreement or rig.mistakes)
        self.headline.setText(
            self.tr("The cameras agree")
            if self._is_sound
            else self.tr("Photographs contradict")
            if rig.mistakes
            else self.tr("The instants disagree")
        )
        self._restyle()
        remarks = [
            describe_fit(rig),
            *describe_offsets(rig),
            *describe_disagreement(result),
            *(describe_mistake(result, mistake) for mistake in rig.mistakes),
            *describe_turned(result),
            *describe_boards(rig),
            *result.remarks,
        ]
        self.words.setText("\n\n".join(map(translate_sentences, remarks)))
        self.condition.setText(
            self.tr("All lengths hold {0}.").format(result.condition) if result.condition else ""
        )
        self._show_places(result)
        self._show_boards(result)
        counted = range(len(rig.cameras))
        self.cameras.show_columns(
            [
                Column(self.tr("camera"), rig.names),
                Column(
                    "fx",
                    [
                        format_with_sigma(rig.cameras[c].params[0], rig.camera_sigma(c)[0])
                        for c in counted
                    ],
                    unit="px",
                ),
                Column(
                    "RMS",
                    [rig.camera_rms(c) for c in counted],
                    with_decimals(3),
                    self.tr("Root mean square residual of this camera in the rig, px"),
                    unit="px",
                ),
                Column(
                    "n",
                    [sum(len(v.residuals) for v in rig.views if v.camera == c) for c in counted],
                    tip=self.tr("Number of corners"),
                ),
            ]
        )
        noise = rig.rms_alone / 2**0.5
        seen = [each for each in estimate_point_uncertainty(rig, noise) if each.cameras > 1]
        self.points.show_columns(
            [
                Column(
                    self.tr("distance"), [p.distance for p in seen], with_decimals(0), unit="mm"
                ),
                Column(
                    self.tr("± along"),
                    [p.along for p in seen],
                    format_two_digits,
                    self.tr(
                        "Standard deviation along the line of sight, with this rig's noise, mm"
                    ),
                    unit="mm",
                ),
                Column(self.tr("± across"), [p.across for p in seen], format_two_digits, unit="mm"),
                Column(
                    self.tr("calib."),
                    [100 * p.share_of_calibration for p in seen],
                    with_decimals(0),
                    self.tr("Part of the variance that the calibration is to blame for, %"),
                    unit="%",
                ),
            ]
        )
        for table, title in self._titles.items():
            _fit_height(table)
            for part in (title, table):
                part.setVisible(table.model().rowCount() > 0)

    def tell(self, text: str) -> None:
        """Tell what was written, or why it could not be."""
        self.condition.setText(text)

    def _show_places(self, result: RigResult) -> None:
        rig, rows = result.rig, range(1, len(result.rig.cameras))
        self.places.show_columns(
            [
                Column(self.tr("camera"), [rig.names[c] for c in rows]),
                Column(
                    self.tr("from {0}").format(rig.names[0]),
                    [format_with_sigma(*measure_distance(rig, c)) for c in rows],
                    tip=self.tr("Distance of the two cameras' centres, mm"),
                    unit="mm",
                ),
                Column(
                    self.tr("turn"),
                    [format_with_sigma(*measure_turn(rig, c)) for c in rows],
                    tip=self.tr("Angle between the two cameras, degrees"),
                    unit="°",
                ),
            ]
        )

    def _show_boards(self, result: RigResult) -> None:
        """Show how several boards stand to each other, as far as it is known."""
        rig, boards = result.rig, result.rig.placed_boards
        rows = [b for b, board in enumerate(boards) if board.reference != b]
        beside = {boards[b].reference for b in rows}
        names = [str(b + 1) for b in range(len(boards))]
        places = [
            self.tr("{0} from {1}").format(names[b], names[boards[b].reference])
            if len(beside) > 1
            else names[b]
            for b in rows
        ]
        self.boards.show_columns(
            [
                Column(self.tr("board"), places),
                Column(
                    self.tr("from board {0}").format(1) if beside <= {0} else self.tr("distance"),
                    [format_with_sigma(*measure_board_distance(rig, b)) for b in rows],
                    tip=self.tr("Distance of the boards' origins, mm"),
                    unit="mm",
                ),
                Column(
                    self.tr("turn"),
                    [format_with_sigma(*measure_board_turn(rig, b)) for b in rows],
                    tip=self.tr("Angle between the boards, degrees"),
                    unit="°",
                ),
            ]
        )


def _fit_height(table: Table) -> None:
    """Give a table the height of its rows."""
    rows = table.model().rowCount() * table.verticalHeader().defaultSectionSize()
    table.setFixedHeight(table.horizontalHeader().sizeHint().height() + rows + theme.SPACING)
