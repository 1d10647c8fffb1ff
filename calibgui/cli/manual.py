"""Write the manual as one page for a browser: all chapters and pictures in one file.

The page needs no network. The window shows the same chapters: Help, Manual, or F1.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from calibgui.app.outputs.manual import write_manual
from calibgui.app.outputs.output_files import check_outputs
from calibgui.cli.console import Console
from calibgui.cli.outputs import add_overwrite_option
from calibgui.formats.origin import MANUAL


def configure(parser: argparse.ArgumentParser) -> None:
    """Describe the arguments."""
    parser.add_argument(
        "-o",
        "--output",
        type=Path,
        default=Path("manual.html"),
        metavar="FILE",
        help="the page (default ./manual.html)",
    )
    add_overwrite_option(parser)


def run(options: argparse.Namespace, console: Console) -> None:
    """Write the page, and say where it is."""
    check_outputs([(options.output, MANUAL)], [], options.overwrite)
    write_manual(options.output)
    console.print_json({"file": str(options.output)})
    console.print_text(f"Wrote the manual to {options.output.resolve()}: open it in a browser.")
