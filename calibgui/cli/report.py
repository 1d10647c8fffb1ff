"""Write the report on a calibration, or its certificate, as HTML or PDF.

RESULT is a result.json, or a project, of which the newest result is taken with what the project
states of it. PDF needs the extra `report`. A template of your own gets the same record as those of
the program (report/document.py): for .html by jinja2, for .pdf by typst.
"""

from __future__ import annotations

import argparse
from dataclasses import fields, replace
from datetime import date
from pathlib import Path

from calibgui.app.outputs.output_files import check_outputs
from calibgui.app.outputs.report_files import ReportStyle, check_report_name, write_report
from calibgui.app.projects.project_file import is_project, read_project
from calibgui.cli.console import Console
from calibgui.cli.outputs import add_overwrite_option
from calibgui.cli.result import read_result_and_warn
from calibgui.dataset import Result
from calibgui.dataset.details import NO_DETAILS, Details
from calibgui.engine.errors import CalibrationError
from calibgui.formats.origin import REPORT
from calibgui.report.calibration_report import Layout
from calibgui.report.rendering import PAPERS


def configure(parser: argparse.ArgumentParser) -> None:
    """Describe the arguments."""
    parser.add_argument("result", type=Path, metavar="RESULT", help="result.json or a project")
    parser.add_argument(
        "-o",
        "--output",
        type=Path,
        action="append",
        required=True,
        metavar="FILE",
        help="write the report as .html or .pdf; may be repeated",
    )
    parser.add_argument(
        "--layout",
        choices=list(Layout),
        default=Layout.REPORT,
        help="report: all that is known (default); certificate: after ISO/IEC 17025",
    )
    parser.add_argument(
        "--paper", choices=list(PAPERS), default="a4", help="size of the pages (default a4)"
    )
    parser.add_argument("--template", type=Path, metavar="FILE", help="a template of your own")
    parser.add_argument(
        "--issued",
        type=_parse_date,
        metavar="DATE",
        help="date of issue, as 2026-03-01 (default: today)",
    )
    group = parser.add_argument_group("details", "What the program cannot know, as it is printed.")
    for field in fields(Details):
        group.add_argument(
            f"--{field.name.replace('_', '-')}",
            metavar="TEXT",
            help=field.metadata["label"][:1].lower() + field.metadata["label"][1:],
        )
    add_overwrite_option(parser)


def run(options: argparse.Namespace, console: Console) -> None:
    """Read and write."""
    for path in options.output:
        check_report_name(path)
    read = [options.result, *filter(None, [options.template])]
    check_outputs([(path, REPORT) for path in options.output], read, options.overwrite)
    result, details = _read(options.result, console)
    stated = {
        field.name: text
        for field in fields(Details)
        if (text := getattr(options, field.name)) is not None
    }
    style = ReportStyle(Layout(options.layout), options.paper, options.template)
    for path in options.output:
        write_report(
            result,
            path,
            replace(details, **stated),
            style,
            options.result.parent,
            options.issued,
        )
    written = [str(path) for path in options.output]
    console.print_json({"written": written})
    console.print_text(f"Wrote {' and '.join(written)}.")


def _read(path: Path, console: Console) -> tuple[Result, Details]:
    """Read a result, or the newest one of a project, with what is stated of it."""
    if not is_project(path):
        return read_result_and_warn(path, console), NO_DETAILS
    project = read_project(path)
    if not project.results:
        raise CalibrationError(f"{path} holds no result.", "Calibrate first, and save it.")
    return list(project.results.values())[-1], project.details


def _parse_date(text: str) -> date:
    """Read a date such as 2026-03-01."""
    try:
        return date.fromisoformat(text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(f"{text!r} is not a date as 2026-03-01") from error
