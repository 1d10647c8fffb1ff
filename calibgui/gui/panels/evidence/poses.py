"""Camera and boards in space: where each photograph was taken."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QT_TRANSLATE_NOOP
from PySide6.QtWidgets import QComboBox

from calibgui.app.calibrating.calibration import shorten_names
from calibgui.dataset import Result
from calibgui.gui.panels.evidence.scene_view import SceneView
from calibgui.gui.panels.panel import Panel
from calibgui.gui.panels.services import Services
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.buttons import Button
from calibgui.gui.widgets.elided import elide_name
from calibgui.gui.widgets.layouts import make_row
from calibgui.gui.widgets.lengths import describe_condition, state_condition
from calibgui.gui.widgets.reserved_label import ReservedLabel
from calibgui.report.coverage import measure_attitudes
from calibgui.report.names import number_names
from calibgui.report.scene3d import SceneCentre, build_scene


class PosesPanel(Panel):
    """Shows where the board was held, seen from any side."""

    title = str(QT_TRANSLATE_NOOP("PosesPanel", "Poses"))
    purpose = str(
        QT_TRANSLATE_NOOP(
            "PosesPanel", "Where the board was held before the camera, in space: the extrinsics."
        )
    )

    def __init__(self, services: Services) -> None:
        super().__init__(services)
        self.centre = QComboBox()
        self.centre.addItem(self.tr("Camera at rest"), SceneCentre.CAMERA)
        self.centre.addItem(self.tr("Board at rest"), SceneCentre.BOARD)
        self.centre.setToolTip(
            self.tr(
                "What stands still in the picture: the camera, with the boards around it, or the "
                "board, with the cameras around it."
            )
        )
        self.centre.setAccessibleName(self.tr("What stands still"))
        self.centre.currentIndexChanged.connect(self._refresh_now)
        self.home = Button(self.tr("&Reset view"))
        self.home.setToolTip(self.tr("Show everything, from where it was seen first"))
        self.space = SceneView()
        self.space.setToolTip(
            self.tr("Drag to turn, wheel to zoom, click a board or camera to see its image.")
        )
        self.space.setAccessibleName(self.tr("Camera and boards in space"))
        self.space.picked.connect(self._pick)
        self.space.hovered.connect(self._point_at)
        self.home.clicked.connect(self.space.go_home)
        self.words = ReservedLabel(2)
        bar = make_row(self.centre, None, self.home)
        self._fill_body(bar, (self.space, 1), self.words)

    def _refresh(self, result: Result) -> None:
        self._attitudes = measure_attitudes(result.calibration, result.observations())
        self._condition = describe_condition(result)
        self._names = [elide_name(name) for name in shorten_names(result.used)]
        numbers = number_names([view.image for view in result.views])
        self.space.show_scene(
            build_scene(result, SceneCentre(self.centre.currentData())),
            [numbers[i] for i in self._indices],
            [theme.view_colour(i) for i in self._indices],
            state_condition(result),
        )

    def _select(self, k: int, corner: int) -> None:  # noqa: ARG002 - a board is drawn whole
        self.space.select(k)
        self._describe(k)

    def _hover_view(self, k: int) -> None:
        self.space.hover(k)
        self._describe(k if k >= 0 else self._selected[0])

    def _describe(self, k: int) -> None:
        """Say where the board of calibrated view k was, or in what range all were if k is -1."""
        distance, tilt = self._attitudes.distance, np.rad2deg(self._attitudes.tilt)
        self.words.setText(
            self.tr("{0}: {1:.0f} mm away{2}, tilted by {3:.0f}°").format(
                self._names[k], distance[k], self._condition, tilt[k]
            )
            if k >= 0
            else self.tr(
                "{0} views, {1:.0f} to {2:.0f} mm away{3}, tilted by {4:.0f}° to {5:.0f}°"
            ).format(
                len(tilt), distance.min(), distance.max(), self._condition, tilt.min(), tilt.max()
            )
        )
