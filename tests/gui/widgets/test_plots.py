from __future__ import annotations

from pathlib import Path

import numpy as np
import pyqtgraph as pg
import pytest
from PySide6.QtCore import QRect, QRectF, Qt
from PySide6.QtGui import QImage
from PySide6.QtWidgets import QApplication, QLabel, QVBoxLayout, QWidget
from pytestqt.qtbot import QtBot

from calibgui.gui.widgets import theme
from calibgui.gui.widgets.plot_area import Axis
from calibgui.gui.widgets.plots import ColourBar, Plot


def example(qtbot: QtBot) -> Plot:
    plot = Plot("iteration", "cost", "", "px²")
    qtbot.addWidget(plot)
    plot.plot([0, 1, 2], [9.0, 4.0, 1.0])
    plot.resize(300, 200)
    return plot


def find_text(plot: Plot, axis: Axis) -> QRect:
    """Where the name of an axis is, without the blank around it."""
    blank = axis.label.document().documentMargin()
    text = axis.label.boundingRect().adjusted(blank, blank, -blank, -blank)
    return plot.mapFromScene(axis.label.mapToScene(text)).boundingRect()


def test_a_plot_has_no_hidden_controls(qtbot: QtBot) -> None:
    """Pyqtgraph's own has a menu of some 60 boxes, which takes as long to make as all the rest."""
    before = len(QApplication.allWidgets())
    example(qtbot)
    assert len(QApplication.allWidgets()) - before <= 8


def test_axes_name_their_units(qtbot: QtBot) -> None:
    area = example(qtbot).area
    assert area.left.labelText == "cost [px²]"
    assert area.bottom.labelText == "iteration"


def test_a_new_label_is_in_the_middle_of_its_axis(qtbot: QtBot) -> None:
    plot = example(qtbot)
    plot.show()
    plot.set_labels("a name that is much longer", "y")
    axis = plot.area.bottom
    middle = plot.mapFromScene(axis.mapToScene(axis.boundingRect().center())).x()
    assert abs(find_text(plot, axis).center().x() - middle) < 25  # the numbers may stand out


@pytest.mark.parametrize("enclosed", [False, True])
def test_what_an_axis_shows_is_never_cut_off(qtbot: QtBot, enclosed: bool) -> None:
    """A condition, as "mm if squares are 30 mm", makes the text longer than a plot is high."""
    plot = example(qtbot)
    box = QWidget()
    qtbot.addWidget(box)
    layout = QVBoxLayout(box)
    layout.addWidget(plot)
    plot.set_labels("view", "distance", "", "mm if squares are 30 mm, which nobody has confirmed")
    bar = ColourBar(plot, "", pg.colormap.get("viridis"))
    bar.set_quantity("out of the plane [mm if squares are 30 mm, which nobody has confirmed yet]")
    if enclosed:  # far narrower than high: the axes are shorter than the plot
        plot.box.setAspectLocked(True)
        plot.enclose(QRectF(0, 0, 400, 300))
    box.resize(300, 60)
    box.show()
    QApplication.processEvents()
    for axis in (plot.area.left, bar.axis):
        shown = find_text(plot, axis)
        assert plot.rect().top() <= shown.top() and shown.bottom() <= plot.rect().bottom()


@pytest.mark.parametrize("enclosed", [False, True])
def test_what_axes_show_does_not_touch_the_border(qtbot: QtBot, enclosed: bool) -> None:
    plot = example(qtbot)
    if enclosed:
        plot.box.setAspectLocked(True)
        plot.enclose(QRectF(0, 0, 640, 480))
    for size in ((300, 200), (200, 300)):
        plot.resize(*size)
        plot.show()
        QApplication.processEvents()
        for axis in plot.area.axes.values():
            assert plot.rect().adjusted(4, 4, -4, -4).contains(find_text(plot, axis))


def test_the_lines_of_a_title_are_centred(qtbot: QtBot) -> None:
    plot = example(qtbot)
    for text in ("mean 0.0000, standard deviation 0.0030 px<br>σ", "σ<br>a longer line"):
        plot.set_title(text)
        document = plot.area.title.item.document()
        layout = document.firstBlock().layout()
        lines = [layout.lineAt(k).naturalTextRect() for k in range(layout.lineCount())]
        assert len(lines) == 2
        assert abs(lines[0].center().x() - lines[1].center().x()) < 1


def test_numbers_of_a_logarithmic_axis_are_written_alike(qtbot: QtBot) -> None:
    axis = example(qtbot).area.left
    values = [-1, 0, np.log10(3), np.log10(5), 1]
    axis.setRange(-1.2, 1.3)
    assert axis.logTickStrings(values, 1.0, 1.0) == ["0.1", "1", "", "5", "10"]
    axis.setRange(-7, 2)
    assert axis.logTickStrings(values, 1.0, 1.0) == ["10⁻¹", "10⁰", "", "", "10¹"]
    axis.setRange(4, 7.5)
    assert axis.logTickStrings([5, np.log10(2e6)], 1.0, 1.0) == ["10⁵", "2·10⁶"]


@pytest.mark.parametrize(
    ("low", "high"),
    [(28, 140), (45, 90), (28.5, 28.9), (9.99, 10.02), (34.1, 35.9), (1e-9, 1.3e-9), (1e-3, 1e6)],
)
def test_a_logarithmic_axis_has_two_numbers_at_least(qtbot: QtBot, low: float, high: float) -> None:
    axis = example(qtbot).area.left
    axis.setLogMode(True)
    ends = np.log10([low, high])
    axis.setRange(*ends)
    written = [
        (value, text)
        for spacing, values in axis.tickValues(*ends, 300)
        for value, text in zip(values, axis.tickStrings(values, 1.0, spacing), strict=True)
        if text
    ]
    assert 2 <= len({text for _, text in written}) <= 10
    assert all(ends[0] <= value <= ends[1] for value, _ in written)


def test_a_double_click_shows_all_again(qtbot: QtBot) -> None:
    plot = example(qtbot)
    plot.show()
    box = plot.box
    box.setRange(xRange=(7, 8), yRange=(70, 80))
    qtbot.mouseDClick(plot.viewport(), Qt.MouseButton.LeftButton)
    (left, right), (bottom, top) = box.viewRange()
    assert left <= 0 < 2 <= right < 7
    assert bottom <= 1 < 9 <= top < 70


def test_saved_as_png_and_svg(qtbot: QtBot, tmp_path: Path) -> None:
    plot = example(qtbot)
    plot.save(tmp_path / "plot.png")
    image = QImage(str(tmp_path / "plot.png"))
    assert image.width() == 2 * plot.width()
    plot.save(tmp_path / "plot.svg")
    assert "iteration" in (tmp_path / "plot.svg").read_text(encoding="utf-8")


def test_colours_follow_the_theme(qtbot: QtBot, qapp: QApplication) -> None:
    plot = example(qtbot)
    plot.show()
    backgrounds = []
    for scheme in (theme.Scheme.LIGHT, theme.Scheme.DARK):
        theme.apply(qapp, scheme)
        qtbot.wait(20)
        backgrounds.append(plot.grab().toImage().pixelColor(5, 5).lightness())
    assert backgrounds[0] > 200 > 60 > backgrounds[1]


def test_text_is_legible_on_its_background() -> None:
    def luminance(colour: str) -> float:
        rgb = np.array([int(colour[i : i + 2], 16) for i in (1, 3, 5)]) / 255
        linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
        return float(linear @ [0.2126, 0.7152, 0.0722])

    for colours in (theme.LIGHT, theme.DARK):
        pairs = [
            (text, back)
            for text in (colours.text, colours.muted, colours.good, colours.bad, colours.warning)
            for back in (colours.window, colours.base)
        ]
        pairs += [(colours.text, colours.button), (colours.on_accent, colours.accent)]
        pairs += [(colours.warning, colours.warning_base)]
        pairs += [(colours.bad, colours.bad_base), (colours.text, colours.bad_base)]
        for text, back in pairs:
            bright, dark = sorted((luminance(text), luminance(back)), reverse=True)
            assert (bright + 0.05) / (dark + 0.05) >= 4.5, (text, back)


def paint_axis(plot: Plot, axis: Axis) -> QImage:
    return plot.grab(plot.mapFromScene(axis.mapToScene(axis.rect())).boundingRect()).toImage()


def test_the_numbers_of_axes_and_colour_bar_follow_what_is_shown(qtbot: QtBot) -> None:
    """Without another size, at which all is drawn anew."""
    plot = example(qtbot)
    bar = ColourBar(plot, "corners", pg.colormap.get("viridis"))
    plot.show()
    qtbot.waitExposed(plot)
    axes = plot.area.left, plot.area.bottom, bar.axis
    before = [paint_axis(plot, axis) for axis in axes]
    plot.box.setRange(xRange=(3, 5), yRange=(20, 40), padding=0)
    bar.set_levels(0, 60)
    for axis, painted in zip(axes, before, strict=True):
        assert paint_axis(plot, axis) != painted


@pytest.mark.parametrize("area", [QRectF(0, 0, 640, 480), QRectF(0, 0, 480, 640)])
def test_a_plot_of_an_area_takes_no_more_height_than_it_fills(qtbot: QtBot, area: QRectF) -> None:
    """What stands below it, as the reading under the cursor, stays close to it."""
    panel, below = QWidget(), QLabel("below")
    qtbot.addWidget(panel)
    plot = Plot("u", "v", "px", "px", square=True)
    layout = QVBoxLayout(panel)
    layout.addWidget(plot, 1)
    layout.addWidget(below)
    layout.addStretch()
    plot.enclose(area)
    panel.show()
    for width in (360, 1200, 360):  # narrow again: the margins of the wide plot are gone
        panel.resize(width, 700)
        QApplication.processEvents()
        assert plot.area.size().width() <= plot.width()
        shown = plot.area.bottom.mapRectToScene(plot.area.bottom.boundingRect()).bottom()
        assert plot.y() + shown == pytest.approx(below.y(), abs=20)
