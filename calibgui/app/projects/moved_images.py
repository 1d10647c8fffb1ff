"""Search for images that are no longer at the paths in the project."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from itertools import takewhile
from pathlib import Path, PurePath

from calibgui.app.photographs.image_store import compute_file_digest
from calibgui.app.projects.project import Project


def list_missing_images(project: Project) -> list[str]:
    """Return the images of the project whose files are missing."""
    return [view.image for view in project.views if not Path(view.image).is_file()]


def find_moved_images(
    missing: Iterable[str], folder: Path, digests: Mapping[str, str]
) -> dict[str, str]:
    """Return the new paths, in `folder` at any depth, of the `missing` images that are found.

    A file of the same name is taken if its SHA-256 is the known one, or if none is known. A renamed
    file is found by its SHA-256 alone. Of several files the one whose folders have the same names
    is taken: cameras begin to count anew in every folder.
    """
    files = sorted(path for path in folder.rglob("*") if path.is_file())
    by_name: dict[str, list[Path]] = {}
    for path in files:
        by_name.setdefault(path.name, []).append(path)
    moved = {}
    for image in missing:
        known = digests.get(image)
        alike = by_name.get(PurePath(image).name, [])
        candidates = (
            alike if known is None else [p for p in alike if compute_file_digest(p) == known]
        )
        if not candidates and known is not None:
            suffix = PurePath(image).suffix
            candidates = [
                p for p in files if p.suffix == suffix and compute_file_digest(p) == known
            ]
        if candidates:
            found = max(candidates, key=lambda p: _count_common_parts(p, PurePath(image)))
            moved[image] = str(found.absolute())
    return moved


def _count_common_parts(path: PurePath, other: PurePath) -> int:
    """Return how many names at the end of two paths are the same."""
    pairs = zip(reversed(path.parts), reversed(other.parts), strict=False)
    return sum(1 for _ in takewhile(lambda pair: pair[0] == pair[1], pairs))
