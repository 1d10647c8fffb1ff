"""The cameras that a capture is to be with: one, or several of a rig."""

from __future__ import annotations

from PySide6.QtWidgets import QComboBox, QHBoxLayout, QVBoxLayout, QWidget

from calibgui.engine.capture import list_cameras
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.buttons import Button

_UNNAMED = 4
"""Number of cameras that are offered by number where the system names none."""
_MOST = 4
"""Number of cameras whose pictures there is room for."""


class SourceList(QWidget):
    """A field for each camera, and what adds another one or takes the last one away."""

    def __init__(self) -> None:
        super().__init__()
        self.boxes: list[QComboBox] = []
        self._column = QVBoxLayout(self)
        self._column.setContentsMargins(0, 0, 0, 0)
        self._column.setSpacing(theme.SPACING)
        self.add, self.remove = Button(self.tr("&Another camera")), Button(self.tr("&Remove"))
        self.add.setToolTip(
            self.tr("Several cameras that stand fast to each other take each picture together")
        )
        self.add.clicked.connect(self._add)
        self.remove.clicked.connect(self._remove)
        row = QHBoxLayout()
        row.addWidget(self.add)
        row.addWidget(self.remove)
        row.addStretch(1)
        self._column.addLayout(row)

    def offer(self) -> None:
        """Offer one of the cameras that there are now."""
        while self.boxes:
            self._remove()
        self._add()

    def list_names(self) -> list[str]:
        """List the names of what was chosen, as `open_source` takes them."""
        names = []
        for box in self.boxes:
            text = box.currentText().strip()
            index = box.findText(text)
            names.append(box.itemData(index) if index >= 0 else text)
        return names

    def _add(self) -> None:
        """Add a field, with another camera than the ones before."""
        box = QComboBox()
        box.setEditable(True)
        box.setInsertPolicy(QComboBox.InsertPolicy.NoInsert)
        box.setAccessibleName(self.tr("Camera {0}").format(len(self.boxes) + 1))
        box.setToolTip(
            self.tr(
                "A camera at this computer, or the address of one in the network (rtsp://…, "
                "http://…), or the folder that a camera's program fills"
            )
        )
        named = list_cameras()
        for number in named or range(_UNNAMED):
            name = self.tr("camera {0}").format(number)
            if number in named:
                name = f"{name}, {named[number]}"
            box.addItem(name, str(number))
        box.setCurrentIndex(min(len(self.boxes), box.count() - 1))
        self._column.insertWidget(len(self.boxes), box)
        self.boxes.append(box)
        self._show_buttons()

    def _remove(self) -> None:
        box = self.boxes.pop()
        self._column.removeWidget(box)
        box.deleteLater()
        self._show_buttons()

    def _show_buttons(self) -> None:
        self.add.setEnabled(len(self.boxes) < _MOST)
        self.remove.setVisible(len(self.boxes) > 1)
