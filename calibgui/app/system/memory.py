"""Large blocks of memory go back to the system when they are freed."""

from __future__ import annotations

import contextlib
import ctypes
import sys

_LARGE_BYTES = 1 << 20
"""Size from which a block goes back, bytes: photographs, their halves, and most of what a solve of
hundreds of views takes for a while. Such a solve takes a sixth longer for it, some 10 ms."""
_M_MMAP_THRESHOLD = -3
"""The option of glibc's ``mallopt`` for that size."""


def return_large_blocks() -> None:
    """Let large blocks of memory go back to the system as soon as they are freed.

    glibc, the C library of most Linux systems, keeps blocks of up to 32 MB for later ones, apart
    for each thread, from when it first saw one that is freed. Photographs that several threads
    read leave holes between them that nothing fits into: of the window with 300 photographs of 12
    megapixels they were 130 to 230 MB (``tests.benchmarks.responsiveness``). Other C libraries are
    left as they are.
    """
    if sys.platform == "linux":
        with contextlib.suppress(AttributeError):  # only glibc has it
            ctypes.CDLL(None).mallopt(_M_MMAP_THRESHOLD, _LARGE_BYTES)
