"""What work beside the window took of the memory goes back to the system."""

from __future__ import annotations

import contextlib
import ctypes
import sys

_LARGE_BYTES = 1 << 22
"""Size from which a block goes back when it is freed, bytes: a photograph of 4 megapixels. From
1 MB on, a calibration of 300 views took a sixth longer."""
_M_MMAP_THRESHOLD = -3
"""The option of glibc's ``mallopt`` for that size."""


def return_large_blocks() -> None:
    """Let large blocks of memory go back to the system as soon as they are freed.

    glibc, the C library of most Linux systems, keeps blocks of up to 32 MB for later ones, apart
    for each thread, from when it first saw one that is freed. Photographs that several threads
    read leave holes between them that nothing fits into. Other C libraries are left as they are.
    """
    if sys.platform == "linux":
        with contextlib.suppress(AttributeError):  # only glibc has it
            ctypes.CDLL(None).mallopt(_M_MMAP_THRESHOLD, _LARGE_BYTES)


def return_free_memory() -> None:
    """Give the system back whatever is free, between what is in use as well.

    It takes some milliseconds, in which other threads go on. The window with 300 photographs of 12
    megapixels had 230 MB of it after an hour (``tests.benchmarks.responsiveness``).
    """
    if sys.platform == "linux":
        with contextlib.suppress(AttributeError):
            ctypes.CDLL(None).malloc_trim(0)
