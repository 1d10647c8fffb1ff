"""Options and checks of the subcommands that write files."""

from __future__ import annotations

import argparse
from collections.abc import Iterable
from pathlib import Path

from calibgui.app.outputs.export_folder import PAGE, export_all
from calibgui.app.outputs.output_files import check_outputs
from calibgui.cli.arguments import list_input_files
from calibgui.dataset import Result
from calibgui.engine.errors import CalibrationError
from calibgui.formats import EXPORTERS


def add_overwrite_option(parser: argparse.ArgumentParser) -> None:
    """Add the option that lets outputs replace files which this program did not write."""
    parser.add_argument(
        "--overwrite",
        action="store_true",
        help="replace files that calibgui did not write, or wrote as something else; never files "
        "that are read",
    )


def refuse_other_format(path: Path) -> None:
    """Refuse an output in JSON that is named as a file of another format.

    Raises:
        CalibrationError: with the formats that have such files.
    """
    suffix = path.suffix.lower()
    formats = [name for name, exporter in EXPORTERS.items() if suffix in exporter.suffixes]
    if formats and suffix != ".json":
        raise CalibrationError(
            f"{path} is not named as JSON, which -o writes.",
            "Give it the suffix .json. Other formats are written by calibgui calibrate with "
            f"{' or '.join(f'--export {name}={path}' for name in formats)}.",
        )


def export_to_folder(result: Result, options: argparse.Namespace) -> str:
    """Write a result in all formats to the folder of --export-all, and describe what is there.

    Raises:
        CalibrationError: as `export_all`.
    """
    outcomes = export_all(result, options.export_all, options.overwrite)
    written = sum(one.report is not None for one in outcomes)
    return (
        f"Wrote {written} of {len(outcomes)} formats to {options.export_all}: its {PAGE} tells who "
        "reads which file."
    )


def check_corner_outputs(
    options: argparse.Namespace,
    outputs: Iterable[tuple[Path, str]],
    others: Iterable[str | Path] = (),
) -> None:
    """Refuse outputs of a command that reads photographs or corners, as `check_outputs` does.

    Args:
        options: those of `add_image_paths`, `add_search_options` and `add_overwrite_option`.
        outputs: files to write, each with its kind.
        others: further files that will be read.

    Raises:
        CalibrationError: as `check_outputs`.
    """
    regions = [options.roi] if options.roi else []
    read = [*list_input_files(options.paths), *regions, *others]
    check_outputs(outputs, read, options.overwrite)
