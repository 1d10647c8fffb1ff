"""A folder of new images: what in it may be replaced, and the record of what was made there.

A folder often holds photographs of the same names. An image in it is replaced only if this program
made it and nobody has changed it since, which the folder's record tells by the images' SHA-256,
or if the user allows it; never if it is a photograph that is being worked on, or a link, because
the photograph that a link leads to would be lost.

The names of new images enter the record before the images are made, so that the next call may
replace what a call that was killed has left.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from pathlib import Path

from calibgui.app.outputs.output_files import identify_file, make_folder
from calibgui.app.photographs.image_store import compute_file_digest
from calibgui.app.photographs.paths import make_natural_key
from calibgui.engine.errors import CalibrationError
from calibgui.engine.files import describe_write_error
from calibgui.formats.resampled_json import Written, read_resampled, update_written
from calibgui.report.numbers import format_count


class ForeignFilesError(CalibrationError):
    """An error: new images would replace files that this program did not make.

    Args:
        folder: the folder of the new images.
        names: the names of these files.
    """

    def __init__(self, folder: Path, names: Sequence[str]) -> None:
        others = f" and {format_count(len(names) - 1, 'more file')}" if len(names) > 1 else ""
        super().__init__(
            f"{folder / names[0]}{others} would be replaced, which calibgui did not make there.",
            "Choose another folder, or add --overwrite to replace them.",
        )
        self.names = tuple(names)


class OutputFolder:
    """The new images in a folder, which is created if missing.

    Args:
        geometry_file: the file in the folder that holds the record, and later the geometry of the
            new images.
        sources: the photographs that the images are made from.
        faces: what is added to the photographs' names; "" where there is one new image of each.
        overwrite: whether files may be replaced that this program did not make.

    Raises:
        CalibrationError: if the folder cannot be used, two images would have one name in it, or a
            photograph or the target of a link would be overwritten.
        ForeignFilesError: if other files would be replaced.
    """

    def __init__(
        self,
        geometry_file: Path,
        sources: Sequence[Path],
        faces: Iterable[str] = ("",),
        overwrite: bool = False,
    ) -> None:
        folder = geometry_file.parent
        make_folder(folder)
        self.geometry_file, self._faces = geometry_file, tuple(faces)
        self._targets = _choose_targets(sources, folder)
        found = read_resampled(geometry_file)
        self._content, self._record = found or ({}, {})
        self._made: dict[str, str] = {}
        paths = [path for source in sources for path in self.name_images(source).values()]
        read = {identify_file(source) for source in sources}
        for path in [geometry_file, *paths]:
            _refuse_link(path)
            if path.exists() and identify_file(path) in read:
                raise _make_overwritten_error(path)
        foreign = [path.name for path in paths if not self._is_own(path)]
        if found is None:
            foreign.insert(0, geometry_file.name)
        if foreign and not overwrite:
            raise ForeignFilesError(folder, foreign)
        claimed = dict.fromkeys(path.name for path in paths)
        update_written(self.geometry_file, self._content, {**self._record, **claimed})

    def name_images(self, source: Path) -> dict[str, Path]:
        """Return the paths of the new images of a photograph, by face."""
        target = self._targets[source]
        return {
            face: target.with_stem(f"{target.stem}_{face}") if face else target
            for face in self._faces
        }

    def record(self, path: Path) -> None:
        """Record an image that has been made; may be called in any thread."""
        self._made[path.name] = compute_file_digest(path)

    @property
    def written(self) -> Written:
        """The images in the folder that this program made."""
        return {**self._record, **self._made}

    def close(self) -> None:
        """Write the record beside an earlier geometry, or remove it where there are no images."""
        if self.written:
            update_written(self.geometry_file, self._content, self.written)
        else:
            self.geometry_file.unlink(missing_ok=True)

    def _is_own(self, path: Path) -> bool:
        """Return whether a path is free, or that of an image which this program made."""
        if not path.exists():
            return True
        digest = self._record.get(path.name, "")
        try:
            return path.is_file() and (digest is None or compute_file_digest(path) == digest)
        except OSError as error:
            raise describe_write_error(path, error) from error


def _choose_targets(sources: Iterable[Path], folder: Path) -> dict[Path, Path]:
    """Return the path in `folder` that has the name of each photograph."""
    taken: dict[str, Path] = {}
    for path in sorted(sources, key=make_natural_key):
        if path.resolve().parent == folder.resolve():
            raise _make_overwritten_error(path)
        if (other := taken.setdefault(path.name.casefold(), path)) != path:
            raise CalibrationError(
                f"{other} and {path} would have the same name in {folder}.",
                "Work on one folder after the other.",
            )
    return {path: folder / path.name for path in taken.values()}


def _refuse_link(path: Path) -> None:
    """Refuse to write to a link, because what it leads to would be lost."""
    if path.is_symlink():
        raise CalibrationError(
            f"{path} is a link to {os.path.realpath(path)}, which would be overwritten.",
            "Choose another folder for the new images, or remove the link.",
        )


def _make_overwritten_error(path: Path) -> CalibrationError:
    return CalibrationError(
        f"{path} would be overwritten.", "Choose another folder for the new images."
    )
