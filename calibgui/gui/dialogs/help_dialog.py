"""Help: the way from photographs to a calibrated camera, on one page."""

from __future__ import annotations

from html import escape

from PySide6.QtWidgets import QDialog, QTextBrowser, QVBoxLayout, QWidget

from calibgui.gui.widgets.actions import add_close_button
from calibgui.gui.widgets.glossary import list_terms
from calibgui.version import __version__


class HelpDialog(QDialog):
    """The workflow, the keys, and where the method comes from."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle(self.tr("Help"))
        self.text = QTextBrowser()
        self.text.setAccessibleName(self.tr("How it works"))
        self.text.setOpenExternalLinks(True)
        self.text.setHtml(self._page())
        buttons = add_close_button(self)
        layout = QVBoxLayout(self)
        layout.addWidget(self.text)
        layout.addWidget(buttons)
        self.resize(680, 600)

    def _page(self) -> str:
        steps = (
            self.tr(
                "<b>Photograph</b> a flat board 10 to 20 times with focus and zoom fixed: "
                "tilted by 20 to 45 degrees in different directions, near and far, and with "
                "corners close to every corner of the image. <i>Print a board</i> makes one; "
                "glue it to something flat and measure the bar below it."
            ),
            self.tr(
                "<b>Drop</b> the images or their folder on the window. Corners are found and "
                "the camera is calibrated at once. State the <b>side of a square</b>: only "
                "distances depend on it."
            ),
            self.tr(
                "<b>Look at the film strip</b>: images without a board say why. <i>Mark board</i> "
                "(M) takes four clicks on the outermost inner corners; the loupe shows where a "
                "click will go. <i>Mark all by hand</i> (Board) turns the search off. "
                "<i>Edit corners</i> (E) moves, removes and restores single corners. An "
                "image whose file has changed since says so: <i>detect again</i> (F5)."
            ),
            self.tr(
                "<b>Read the verdict</b>: the button below it mends what is most wrong, or shows "
                "where to hold the board next. The result states every value with its standard "
                "deviation, and what is badly determined."
            ),
            self.tr(
                "<b>Doubt it</b>: residuals that point the same way, a view with a long bar, or "
                "a synthetic check whose residuals are much smaller than the real ones show what "
                "the model does not explain; so does the sentence above the residuals. Exclude "
                "views above a threshold, or let the Set-up leave outliers out and estimate the "
                "board's shape, and calibrate again; "
                "every result keeps its name and can be compared."
            ),
            self.tr(
                "<b>Export</b> to the format that your program reads. Models that differ are "
                "refitted to the same corners; the dialog says how far they are off, in pixels."
            ),
        )
        keys = (
            ("F9", self.tr("calibrate")),
            ("M / E", self.tr("mark board / edit corners")),
            (self.tr("Space"), self.tr("exclude or include the selected images: the fit follows")),
            ("F7", self.tr("the desk alone, or back")),
            (self.tr("↑ ↓"), self.tr("move the threshold, with the film strip in focus")),
            (self.tr("← →"), self.tr("previous and next image, with the image in focus")),
            (
                self.tr("Wheel, + −"),
                self.tr("zoom, before and after as well; Ctrl+0 fits, Ctrl+1 shows pixels"),
            ),
            ("Shift+1 … 6", self.tr("layers over the image")),
            ("Ctrl+E / Ctrl+P", self.tr("export the camera / write the report")),
            ("Ctrl+Shift+P", self.tr("find any action or panel by typing a part of it")),
            ("Ctrl+Z / Ctrl+Shift+Z", self.tr("undo and redo: everything can be taken back")),
        )
        origin = self.tr(
            "The method is L. Lucchese, <i>Geometric calibration of digital cameras through "
            "multi-view rectification</i>, Image and Vision Computing 23 (2005) 517-539."
        )
        rows = "".join(f"<tr><td><b>{a}</b>&nbsp;&nbsp;</td><td>{b}</td></tr>" for a, b in keys)
        words = "".join(
            f"<tr><td><b>{escape(term)}</b>&nbsp;&nbsp;</td><td>{escape(sentence)}</td></tr>"
            for term, sentence in list_terms().items()
        )
        listed = "".join(f"<li style='margin-bottom: 6px'>{step}</li>" for step in steps)
        return (
            f"<h2>{self.tr('From photographs to a camera')}</h2><ol>{listed}</ol>"
            f"<h3>{self.tr('Keys')}</h3><table>{rows}</table>"
            f"<h3>{self.tr('Words')}</h3><table>{words}</table>"
            f"<p>{origin}</p><p>calibgui {__version__}</p>"
        )
