"""A board to print: its size and paper, and how it will look."""

from __future__ import annotations

from PySide6.QtCore import QByteArray, QRectF, Qt
from PySide6.QtGui import QPainter, QPaintEvent
from PySide6.QtSvg import QSvgRenderer
from PySide6.QtWidgets import (
    QComboBox,
    QDialog,
    QFormLayout,
    QLabel,
    QSpinBox,
    QWidget,
)

from calibgui.app.outputs.printable_board import (
    PAPER_SIZES_MM,
    Page,
    choose_paper,
    complete_pattern,
    count_points,
    count_printed,
    lay_out_page,
    write_page,
)
from calibgui.engine.boards import AprilGrid, Board, Pattern
from calibgui.engine.errors import CalibrationError
from calibgui.gui.settings.pattern_choice import PatternChoice
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.actions import make_buttons
from calibgui.gui.widgets.buttons import Button, Kind
from calibgui.gui.widgets.layouts import make_column, make_row
from calibgui.gui.widgets.number_box import NumberBox
from calibgui.gui.widgets.save_names import ask_for_name
from calibgui.gui.widgets.wrapped_label import WrappedLabel

_DEFAULT = Board(7, 10, 25.0)


class _Preview(QWidget):
    """The sheet, as large as there is room for."""

    def __init__(self) -> None:
        super().__init__()
        self._drawing = QSvgRenderer(self)
        self.setMinimumSize(280, 280)

    def show_sheet(self, page: Page | None) -> None:
        self._drawing.load(QByteArray() if page is None else page.svg().encode())
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802, ARG002 - Qt's signature
        if not self._drawing.isValid():
            return
        size = self._drawing.viewBoxF().size()
        size.scale(self.width() - 2.0, self.height() - 2.0, Qt.AspectRatioMode.KeepAspectRatio)
        place = QRectF(0, 0, size.width(), size.height())
        place.moveCenter(QRectF(self.rect()).center())
        painter = QPainter(self)
        self._drawing.render(painter, place)
        painter.setPen(theme.current().line)
        painter.drawRect(place)


class PrintDialog(QDialog):
    """Makes a PDF, SVG or PNG of a board in true size."""

    def __init__(self, board: Board | None, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle(self.tr("Board to print"))
        board = board or _DEFAULT
        self.rows, self.cols = (QSpinBox(minimum=3, maximum=200) for _ in range(2))
        rows, cols = count_printed(board.pattern, board.grid_size)
        self.rows.setValue(rows)
        self.cols.setValue(cols)
        self.pattern = PatternChoice(self.tr("usual"))
        self.pattern.show_pattern(board.pattern, board.square)
        self.counted, self.side = QLabel(), QLabel()
        self.rows.setAccessibleName(self.tr("Rows"))
        self.cols.setAccessibleName(self.tr("Columns"))
        self.square = NumberBox(decimals=2, minimum=1.0, maximum=500.0, suffix=self.tr(" mm"))
        self.square.setValue(board.square)
        self.side.setBuddy(self.square)
        self.paper = QComboBox()
        self.paper.addItems(list(PAPER_SIZES_MM))
        self.paper.setCurrentText(choose_paper(board))
        self.words = WrappedLabel()
        self.preview = _Preview()
        squares = make_row(self.rows, QLabel("×"), self.cols)
        form = QFormLayout()
        form.addRow(self.pattern)
        form.addRow(self.counted, squares)
        form.addRow(self.side, self.square)
        form.addRow(self.tr("&Paper"), self.paper)
        form.addRow(self.words)
        self.odd_and_even = QLabel(
            self.tr("An odd and an even number of squares\nlets every view find the same origin.")
        )
        form.addRow(self.odd_and_even)
        self.save = Button(self.tr("&Save…"), Kind.MAIN)
        self.show_on_screen = Button(self.tr("Show on this scr&een"))
        self.save.clicked.connect(self._ask_and_save)
        self.show_on_screen.setToolTip(
            self.tr("As large as the screen holds it: a screen is flat, and needs no printer")
        )
        self.show_on_screen.clicked.connect(self._show_on_screen)
        middle = make_row(form, (self.preview, 1))
        buttons = make_buttons(self, self.save, self.show_on_screen)
        make_column((middle, 1), buttons, of=self, margins=theme.MARGIN)
        for box in (self.rows, self.cols, self.square):
            box.valueChanged.connect(self._refresh)
        self.pattern.changed.connect(self._refresh)
        self.pattern.listed.connect(self._take_list)
        self.pattern.failed.connect(lambda error: self.words.setText(str(error)))
        self.paper.currentIndexChanged.connect(self._refresh)
        theme.follow(self._refresh)
        self.resize(760, 440)
        self._refresh()

    def _take_list(self, _: Pattern, pitch: float) -> None:
        """Show a board of listed circles in the size that the list states."""
        self.square.setValue(pitch)
        self._refresh()

    def make_sheet(self) -> Page:
        """The sheet as chosen. Raises CalibrationError if it does not fit the paper."""
        return lay_out_page(self._make_board(), self.paper.currentText())

    def _make_board(self) -> Board:
        """Return the board as chosen. Raises CalibrationError if there is no such board."""
        pattern = self.pattern.pattern
        grid_size = count_points(pattern, (self.rows.value(), self.cols.value()))
        return Board(*grid_size, self.square.value(), complete_pattern(pattern, grid_size))

    def _show_on_screen(self) -> None:
        from calibgui.gui.dialogs.board_screen import BoardScreen

        try:
            screen = BoardScreen(self._make_board(), self.parentWidget())
            screen.setGeometry(self.screen().geometry())  # no window manager may do it
            screen.showFullScreen()
            self.accept()
        except CalibrationError as error:
            self.words.setText(str(error))

    def _refresh(self) -> None:
        colours = theme.current()
        chosen = self.pattern.pattern
        if isinstance(chosen, AprilGrid):
            counted, side = self.tr("Tags"), self.tr("Side of a tag")
        elif chosen.has_squares:
            counted, side = self.tr("Squares"), self.tr("Side of a square")
        else:
            counted, side = self.tr("Circles"), self.tr("Distance")
        self.counted.setText(counted)
        self.side.setText(side)
        widest = max(self.side.sizeHint().width(), self.pattern.label.minimumWidth())
        for label in (self.side, self.pattern.label):  # the fields stand under one another
            label.setMinimumWidth(widest)
        self.odd_and_even.setVisible(chosen.has_squares and not chosen.identifies_points)
        self.pattern.show_pattern(self.pattern.pattern, self.square.value())
        try:
            page: Page | None = self.make_sheet()
            text, colour = self.tr("Fits. Print it without scaling."), colours.good
        except CalibrationError as error:
            page, text, colour = None, str(error), colours.bad
        self.preview.show_sheet(page)
        self.words.setText(text)
        theme.set_text_colour(self.words, colour)
        self.save.setEnabled(page is not None)

    def _ask_and_save(self) -> None:
        path = ask_for_name(
            self,
            self.tr("Save board"),
            "board.pdf",
            self.tr("PDF (*.pdf);;SVG drawing (*.svg);;PNG image (*.png)"),
        )
        if path is None:
            return
        try:
            write_page(self.make_sheet(), path)
            self.accept()
        except CalibrationError as error:
            self.words.setText(str(error))
