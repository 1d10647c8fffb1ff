"""Small pictures of the project's images, and whether the files still are what they were."""

from __future__ import annotations

from collections.abc import Iterable

from PySide6.QtCore import QObject, QSize, Qt, Signal
from PySide6.QtGui import QImage, QPixmap

from calibgui.app.photographs.image_store import (
    Signature,
    Thumbnail,
    read_signature,
    read_thumbnail,
)
from calibgui.app.projects.project import Project, add_digests
from calibgui.gui.jobs.jobs import PICTURE
from calibgui.gui.session.session import Session
from calibgui.gui.widgets.picture import make_qimage

THUMBNAIL = QSize(98, 62)
"""Device-independent px."""


class Thumbnails(QObject):
    """Reads every image of the project once, and again when its file has been written to.

    The SHA-256 of a file is kept in the project from when its corners were searched for; an
    image whose file has another one by now is `altered`.
    """

    read = Signal(str)
    """The picture of this image is there, or another one."""
    found_altered = Signal(list)
    """Images that are altered and have not been announced."""

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self._session = session
        self._pictures: dict[str, QPixmap] = {}
        self._digests: dict[str, str] = {}
        """Digests of the files as they were read last."""
        self._signatures: dict[str, Signature] = {}
        self._requested: set[str] = set()
        self._told: dict[str, str] = {}
        """Altered images with the digests under which they were announced."""

    def picture(self, image: str) -> QPixmap | None:
        """The picture of an image, if it has been read."""
        return self._pictures.get(image)

    def altered(self, image: str) -> bool:
        """Return whether the file holds something else than when it was searched."""
        known = self._session.project.digests.get(image)
        return known is not None and self._digests.get(image, known) != known

    def read_new(self) -> None:
        """Read the project's images that have not been read."""
        self._read([view.image for view in self._session.project.views])

    def read_again(self, images: Iterable[str]) -> None:
        """Read `images` whatever is known of them."""
        images = list(images)
        self._requested.difference_update(images)
        self._read(images)

    def look_for_changes(self) -> None:
        """Read those again whose files have been written to since."""
        before = dict(self._signatures)

        def written(_: object) -> list[str]:
            return [image for image, was in before.items() if read_signature(image) != was]

        if before:
            self._session.jobs.start("", written, self.read_again, owner=self)

    def _read(self, images: Iterable[str]) -> None:
        new = [image for image in images if image not in self._requested]
        if not new:
            self._ended()
            return
        self._requested.update(new)
        self._session.jobs.each(
            "",
            new,
            _small,
            self._done,
            delay=PICTURE,
            failed=_unread,
            ended=self._ended,
            owner=self,
        )

    def _done(self, image: str, found: tuple[QImage, Thumbnail, Signature]) -> None:
        picture, thumbnail, self._signatures[image] = found
        before = self._digests.get(image, thumbnail.digest)
        self._pictures[image] = QPixmap.fromImage(picture)
        self._digests[image] = thumbnail.digest
        if before != thumbnail.digest:
            self._session.renew(image)
        self.read.emit(image)

    def _ended(self) -> None:
        self._session.document.learn(self._with_digests)
        images = [view.image for view in self._session.project.views]
        altered = {image: self._digests[image] for image in images if self.altered(image)}
        if new := [image for image in altered if self._told.get(image) != altered[image]]:
            self.found_altered.emit(new)
        self._told = altered

    def _with_digests(self, project: Project) -> Project:
        mine = {view.image for view in project.views} - project.digests.keys()
        new = {image: self._digests[image] for image in self._digests.keys() & mine}
        return add_digests(project, new) if new else project


def _small(image: str) -> tuple[QImage, Thumbnail, Signature]:
    before = read_signature(image)
    thumbnail = read_thumbnail(image)
    picture = make_qimage(thumbnail.grey).scaled(
        THUMBNAIL * 2,
        Qt.AspectRatioMode.KeepAspectRatio,
        Qt.TransformationMode.SmoothTransformation,
    )
    return picture, thumbnail, before


def _unread(_: Exception) -> None:
    """An image that cannot be read is reported by the search for corners."""
