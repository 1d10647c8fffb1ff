"""The families of AprilTags: black squares with a coded number inside.

A tag of a family NhD shows N data cells in a square of k x k, and two tags of it, however they are
turned by quarters, differ in D cells at least. Around the data runs a black border, two cells wide
on the boards of Kalibr and one elsewhere. E. Olson, "AprilTag: A robust and flexible visual
fiducial system", ICRA 2011.

OpenCV knows most families, each tag upside down. The codes of the family 25h7, which it lacks, are
those of the AprilTag library: the highest of 25 bits is the upper left cell, set bits are white.
"""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np

from calibgui.engine import opencv
from calibgui.engine.arrays import BoolArray

_OPENCV_FAMILIES = {
    "t36h11": "DICT_APRILTAG_36H11",
    "t25h9": "DICT_APRILTAG_25H9",
    "t16h5": "DICT_APRILTAG_16H5",
    "t36h10": "DICT_APRILTAG_36H10",
}
"""Families that OpenCV knows, with its names."""
_CODES_25H7 = (
    "04b770d 11693e6 1a599ab 0c3a535 152aafa 0accd98 1cad922 02c2fad 0bb3572 14a3b37 186524b "
    "0c99d4c 023bfea 141cb74 1d0d139 1670aeb 0851675 150334e 06e3ed8 0fd449d 0aa55ec 1c86176 "
    "15e9b28 07ca6b2 147c38b 1d6c950 08b0e8c 11a1451 1562b65 13f53c8 0d58d7a 0829ec9 0faccf1 "
    "136e405 07a2f06 10934cb 16a8b56 1a6a26a 0f85545 195c2e4 024c8a9 12bfc96 16813aa 1a42abe "
    "1573424 1044573 0b156c2 05e6811 1659bfe 1d55a63 05bf065 0e28667 1e9ba54 17d7c5a 1f5aa82 "
    "1a2bbd1 01ae9f9 1259e51 134062b 0e1177a 0ed07a8 162be24 059128b 1663e8f 01a83cb 045bb59 "
    "189065a 04bb370 16fb711 122c077 0eca17a 0dbc1f4 088d343 058ac5d 0ba02e8 01a1d9d 1c72eec "
    "0924bc5 0dccab3 0886d15 178c965 05bc69a 1716261 174e2cc 1ed10f4 0156aa8 03e2a8a 02752ed "
    "153c651 1741670 0765b05 119c0bb 172a783 04faca1 0f31257 12441fc 00d3748 0c21f15 0ac5037 "
    "180e592 07d3210 0a27187 02beeaf 026ff57 0690e82 077765c 1a9e1d7 140be1a 1aa1e3a 1944f5c "
    "19b5032 0169897 1068eb9 0f30dbc 106a151 1d53e95 1348cee 0cf4fca 1728bb5 0dc1eec 069e8db "
    "16e1523 105fa25 18abb0c 0c4275d 06d8e76 0e8d6db 0e16fd7 1ac2682 077435b 0a359dd 03a9c4e "
    "123919a 1e25817 002a836 01545a4 1209c8d 0bb5f69 1dc1f02 05d5f7e 12d0581 13786c2 0e15409 "
    "1aa3599 139aad8 0b09d2a 054488f 13c351c 0976079 0b25b12 1addb34 1cb23ae 1175738 1303bb8 "
    "0d47716 188ceea 0baf967 1226d39 135e99b 034adc5 02e384d 090d3fa 0232713 17d49b1 0aa84d6 "
    "0c2ddf8 1665646 04f345f 02276b1 1255dd7 16f4ccc 04aaffc 0c46da6 085c7b3 1311fcb 09c6c4f "
    "187d947 08578e4 0e2bf0b 0a01b4c 0a1493b 07ad766 0ccfe82 1981b5b 1cacc85 0562cdb 15b0e78 "
    "08f66c5 03332bf 12ce754 0096a76 1d5e3ba 027ea41 14412df 067b9b4 0daa51a 01dcb17 04d4afd "
    "06335d5 0ee2334 17d4e55 1b8b0f0 14999e3 1513dfa 0765cf2 056af90 12e16ac 1d3d86c 0ff279b "
    "18822dd 099d478 08dc0d2 034b666 0cf9526 186443d 07a8e29 19c6aa5 1f2a27d 12b2136 0d0cd0d "
    "12cb320 17ddb0b 005353b 15b2caf 1e5a507 120f1e5 114605a 14efe4c 0568134 11b9f92 174d2a7 "
    "0692b1d 039e4fe 0aaff3d 096224c 13c9f77 110ee8f 0f17bea 099fb5d 0337141 002b54d 1233a70"
)
"""The codes of the family 25h7, hexadecimal."""
FAMILIES = ("t36h11", "t25h9", "t25h7", "t16h5", "t36h10")
"""Names of the families, the most common first."""


class TagFamily(NamedTuple):
    """The tags of one family."""

    cells: BoolArray
    """(n, k, k) the data cells of every tag as it stands upright, True where dark."""
    distance: int
    """D, least number of cells by which two tags differ."""

    @property
    def side(self) -> int:
        """k, number of data cells along a side."""
        return self.cells.shape[1]


@cache
def load_family(name: str) -> TagFamily:
    """Load the family called `name`, one of `FAMILIES`."""
    distance = int(name.rpartition("h")[2])
    if name in _OPENCV_FAMILIES:
        dictionary = _OPENCV_FAMILIES[name]
        count = opencv.list_dictionaries()[dictionary]
        drawn = np.array([opencv.draw_marker_cells(dictionary, k) for k in range(count)])
        cells = np.rot90(drawn[:, 1:-1, 1:-1], 2, axes=(1, 2))
    else:
        codes = np.array([int(code, 16) for code in _CODES_25H7.split()])
        bits = (codes[:, None] >> np.arange(24, -1, -1)) & 1
        cells = (bits == 0).reshape(-1, 5, 5)
    cells = np.ascontiguousarray(cells)
    cells.flags.writeable = False
    return TagFamily(cells, distance)


def draw_tag(family: str, number: int, border: int) -> BoolArray:
    """Draw a tag upright: (k + 2 border)^2 cells, True where dark."""
    return np.pad(load_family(family).cells[number], border, constant_values=True)
