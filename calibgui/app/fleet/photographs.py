"""The photographs of a camera of a fleet: where and of when they are, what changed, copies of them.

They are files, or objects at addresses that fsspec reads where it is installed. The latter are
copied to a temporary folder for as long as a camera is worked on. What is at an address is not
trusted: neither the protocols that lead elsewhere are taken (fsspec has some that open archives,
other programs' repositories and files here), nor more bytes than a photograph has, whatever the
server says of their number.
"""

from __future__ import annotations

import hashlib
import re
import statistics
import tempfile
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import Any

from calibgui.app.photographs.image_store import compute_file_digest
from calibgui.app.photographs.paths import find_images, is_remote, make_natural_key
from calibgui.app.system.missing_library import describe_missing_extra
from calibgui.engine.errors import CalibrationError
from calibgui.engine.images import FORMATS, read_image_header

PROTOCOLS = ("http", "https", "s3", "gs")
"""The protocols of addresses: a web server, and objects stored at Amazon and Google."""
_CHAIN = "::"
"""What joins addresses of fsspec, of which one opens what the other reads."""
_MAX_BYTES = 1 << 30
"""Number of bytes of a photograph that are fetched at most: more than one of 150 megapixels has in
colours of 16 bits that are not compressed."""
_MARKS_OF_CHANGE = (
    "ETag",
    "etag",
    "mtime",
    "LastModified",
    "last_modified",
    "Last-Modified",
    "created",
)
"""Names under which file systems of fsspec state what changes with an object."""
_OF_EXTRA = ("fsspec", "aiohttp")
"""Packages for addresses that the extra batch installs; users choose any others."""


@dataclass(frozen=True, slots=True)
class Photograph:
    """A photograph, wherever it is."""

    name: str
    """Its path, or its address."""
    state: str
    """What changes when it is written to; empty if that is not known without reading it."""


def check_address(address: str) -> None:
    """Refuse an address of another protocol than those of `PROTOCOLS`, or one within another.

    Raises:
        CalibrationError: if it is refused.
    """
    if _CHAIN in address:
        raise CalibrationError(
            f"The address {address} is several in one, joined by {_CHAIN}, which are not read.",
            "Name the photographs themselves, as https://host/folder.",
        )
    protocol = address.partition("://")[0]
    if protocol not in PROTOCOLS:
        raise CalibrationError(
            f"The address {address} is of the protocol {protocol!r}, which is not read.",
            f"Addresses begin with {', '.join(f'{one}://' for one in PROTOCOLS)}; files and "
            "folders here are named without any.",
        )


def list_photographs(paths: Iterable[str]) -> tuple[Photograph, ...]:
    """List the photographs that paths and addresses mean, naturally sorted.

    Raises:
        CalibrationError: if a path means none, or an address cannot be read.
    """
    paths = list(paths)
    found = {
        photograph.name: photograph
        for path in paths
        if is_remote(path)
        for photograph in _list_remote(path)
    }
    if local := [path for path in paths if not is_remote(path)]:
        found |= {
            str(path): Photograph(str(path), _read_state(path)) for path in find_images(local)
        }
    return tuple(sorted(found.values(), key=lambda one: make_natural_key(one.name)))


def compute_digest(path: Path) -> str:
    """Return the SHA-256 of a photograph's content; empty if it cannot be read."""
    try:
        return compute_file_digest(path)
    except OSError:
        return ""


def read_exif_date(files: Iterable[Path]) -> str:
    """Return the median of the dates that photographs state in EXIF; empty if none states one.

    It is a local time in ISO's form, of one of them: an even number has no mean of the middle two.
    """
    dates = []
    for file in files:
        try:
            date = read_image_header(file).exif.date
        except CalibrationError:
            continue  # the search of the photograph says what is wrong with it
        if date is not None:
            dates.append(date)
    return statistics.median_low(dates).isoformat(timespec="seconds") if dates else ""


def combine_digests(parts: Iterable[str]) -> str:
    """Return the SHA-256 of a sequence of texts."""
    digest = hashlib.sha256()
    for part in parts:
        digest.update(f"{len(part)} ".encode() + part.encode("utf-8", "surrogatepass"))
    return digest.hexdigest()


@contextmanager
def fetch_photographs(photographs: Sequence[Photograph]) -> Iterator[list[Path]]:
    """Give the files of photographs: their own, or copies for as long as the block lasts.

    Raises:
        CalibrationError: if one cannot be copied.
    """
    if not any(is_remote(photograph.name) for photograph in photographs):
        yield [Path(photograph.name) for photograph in photographs]
        return
    with tempfile.TemporaryDirectory(prefix="calibgui-") as folder:
        yield [
            _fetch(photograph.name, Path(folder, str(k)))
            if is_remote(photograph.name)
            else Path(photograph.name)
            for k, photograph in enumerate(photographs)
        ]


def _read_state(path: Path) -> str:
    """Return the size and time of a file; empty if it cannot be read."""
    try:
        state = path.stat()
    except OSError:
        return ""
    return f"{state.st_size} {state.st_mtime_ns}"


def _list_remote(address: str) -> list[Photograph]:
    """List the photographs that an address means."""
    with _explain_remote(address):
        system, path = _open_file_system(address)
        if PurePosixPath(path).suffix.lower() in FORMATS and "*" not in path:
            infos = [system.info(path)]
        else:
            pattern = path if "*" in path else f"{path.rstrip('/')}/*"
            # A web server's list of a folder is names alone: each file is asked for its state.
            infos = [
                info if _describe_state(info) else system.info(info["name"])
                for info in system.glob(pattern, detail=True).values()
                if info["type"] == "file" and PurePosixPath(info["name"]).suffix.lower() in FORMATS
            ]
        names = [system.unstrip_protocol(info["name"]) for info in infos]
    if not names:
        raise CalibrationError(f"{address} holds no images.", "Check the address.")
    return [
        Photograph(name, _describe_state(info)) for name, info in zip(names, infos, strict=True)
    ]


def _describe_state(info: dict[str, Any]) -> str:
    """Return the size of an object with what changes with it; empty if nothing is stated."""
    marks = [str(info[name]) for name in _MARKS_OF_CHANGE if info.get(name)]
    return " ".join([str(info.get("size")), *marks]) if marks else ""


def _fetch(address: str, folder: Path) -> Path:
    """Copy an object to a folder of its own, under its own name.

    Raises:
        CalibrationError: if it cannot be read, or is larger than a photograph.
    """
    folder.mkdir()
    copy = folder / re.split(r"[/\\:]", address)[-1]
    with _explain_remote(address):
        system, path = _open_file_system(address)
        system.get_file(path, str(copy), callback=_make_limit(address))
    return copy


def _make_limit(address: str) -> Any:
    """Return what fsspec tells how much of an object there is and has come, and which stops it.

    What has come is counted as well, as servers may state no size, or a wrong one.
    """
    from fsspec.callbacks import Callback

    def refuse_above_limit(size: int | None, come: int, **_: Any) -> None:
        if max(size or 0, come) > _MAX_BYTES:
            raise CalibrationError(
                f"{address} is larger than {_MAX_BYTES >> 20} MB, the limit of a photograph that "
                "is fetched.",
                "Check the address; copy photographs that are as large to this machine.",
            )

    return Callback(hooks={"limit": refuse_above_limit})


def _open_file_system(address: str) -> tuple[Any, str]:
    """Return the file system of an address, and the path in it.

    Raises:
        CalibrationError: as `check_address`: a server's list may name addresses, too.
    """
    check_address(address)
    import fsspec.core

    # A worker that lives on would miss photographs that are added between two runs.
    return fsspec.core.url_to_fs(address, use_listings_cache=False)


@contextmanager
def _explain_remote(address: str) -> Iterator[None]:
    """Turn what file systems raise into errors that the user can act on."""
    try:
        yield
    except CalibrationError:
        raise
    except ImportError as error:
        # fsspec raises an error of its own because of the one that names the package.
        missing = error.name or getattr(error.__cause__, "name", None)
        if missing in _OF_EXTRA:
            raise CalibrationError(
                f"{address} cannot be read: {missing} is not installed.",
                f"{describe_missing_extra('batch')}.",
            ) from error
        raise CalibrationError(
            f"{address} cannot be read: {str(error).rstrip('.')}.",
            "pip install what is missing: fsspec has a package for each kind of address.",
        ) from error
    except Exception as error:  # each file system raises errors of its own
        raise CalibrationError(
            f"{address} cannot be read: {str(error) or type(error).__name__}.",
            "Check the address, your rights and the network.",
        ) from error
