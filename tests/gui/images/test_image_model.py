"""A long list stays cheap: work per finding does not grow with the number of images."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtWidgets import QApplication

from calibgui.app.projects.document import Document
from calibgui.app.projects.project import Project, add_images, change_views
from calibgui.dataset import View, ViewStatus
from calibgui.engine.features.corners import Corners, OtherBoard
from calibgui.gui.images import image_model
from calibgui.gui.images.film_strip import FilmStrip
from calibgui.gui.images.image_model import Criterion
from calibgui.gui.images.thumbnails import Thumbnails
from calibgui.gui.session.session import Session


@pytest.mark.parametrize("criterion", Criterion)
def test_one_finding_among_a_thousand_looks_at_few(
    qapp: QApplication, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, criterion: Criterion
) -> None:
    session = Session(qapp)
    monkeypatch.setattr(Thumbnails, "read_new", lambda _: None)
    images = FilmStrip(session)
    names = [str(tmp_path / f"{k:04}.png") for k in range(1000)]
    session.begin(Document(add_images(Project(), names)))
    images.sorting[criterion].trigger()
    compared: list[int] = []
    sort_key = image_model.ImageModel.sort_key

    def counted(self: image_model.ImageModel, row: int, by: Criterion) -> tuple[object, ...]:
        compared.append(row)
        return sort_key(self, row, by)

    monkeypatch.setattr(image_model.ImageModel, "sort_key", counted)
    session.document.learn(
        lambda p: change_views(p, [names[500]], lambda view: replace(view, reason="none"))
    )
    assert len(compared) < 100
    session.jobs.close()
    images.deleteLater()
    session.deleteLater()


def test_names_with_numbers_are_in_the_order_people_expect(
    qapp: QApplication, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    session = Session(qapp)
    monkeypatch.setattr(Thumbnails, "read_new", lambda _: None)
    images = FilmStrip(session)
    names = [str(tmp_path / f"Image{k}.tif") for k in (10, 2, 1)]
    session.begin(Document(add_images(Project(), names)))
    model = images.list.model()

    def list_shown() -> list[str]:
        return [model.index(row, 0).data() for row in range(model.rowCount())]

    ordered = ["Image1.tif", "Image2.tif", "Image10.tif"]
    assert list_shown() == ordered
    session.begin(Document(add_images(Project(), names[::-1])))  # as they come
    assert list_shown() == ordered
    session.edit("Add", lambda project: add_images(project, [str(tmp_path / "Image0.tif")]))
    assert list_shown() == ["Image0.tif", *ordered]
    session.document.undo()
    assert list_shown() == ordered
    session.jobs.close()
    images.deleteLater()
    session.deleteLater()


def test_further_boards_are_told() -> None:
    uv, outline = np.zeros((2, 2)), np.zeros((4, 2))
    corners = Corners((6, 9), [[0, 0], [0, 1]], uv, uv, others=(OtherBoard((4, 5), outline),))
    tip = image_model.status_tip(View("a.png", ViewStatus.FOUND, corners=corners))
    assert "Another board is seen here, of 4 × 5 inner corners." in tip
    refused = View("a.png", ViewStatus.NO_BOARD, "This board has 7 x 10 inner corners, not 6 x 9.")
    assert image_model.status_tip(refused).endswith("7 × 10 inner corners, not 6 × 9.")
