"""The option --limits: what a calibration has to keep."""

from __future__ import annotations

import argparse

BROKEN = 3
"""Exit code if a limit is not kept."""


def add_limits_option(parser: argparse.ArgumentParser, others: str = "") -> None:
    """Add --limits, the name that ``app/system/limit_presets.py`` finds; help adds `others`."""
    parser.add_argument(
        "--limits",
        metavar="NAME|FILE",
        help="what has to be kept, or the exit code is 3: a preset (hobby-robot, photogrammetry, "
        "metrology, or one of your own) or a TOML file with largest_edge_error_px, fewest_views, "
        "least_coverage (0 to 1), or largest_length_sigma_mm, length_mm and distance_mm"
        f"{others}",
    )
