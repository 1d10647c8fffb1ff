"""Documents as HTML, by jinja2, and as PDF, by typst.

HTML is one file without a script that asks no network. PDF is PDF/A-3b with all fonts and with
result.json in it. The same document gives the same bytes.
"""

from __future__ import annotations

import base64
import json
import shutil
import tempfile
from dataclasses import asdict
from datetime import UTC, datetime
from functools import cache
from pathlib import Path
from typing import Any

from jinja2 import FileSystemLoader, StrictUndefined, TemplateError
from jinja2.sandbox import SandboxedEnvironment

from calibgui.engine.errors import CalibrationError
from calibgui.report.document import Document

TEMPLATES = Path(__file__).parent / "templates"
_FONTS = ("DejaVuSans.ttf", "DejaVuSans-Bold.ttf")
"""Fonts of matplotlib for letters that typst's own fonts lack; the system's fonts come last."""
PAPERS = {"a4": "A4", "us-letter": "letter"}
"""Sizes of paper by typst's names, with those of CSS."""


def render_page(template: str, mark: str, **members: Any) -> str:
    """Render an HTML page from a template of the program.

    Args:
        template: its name in ``templates/``.
        mark: what says that the program has written it (``formats/origin.py``).
        members: what the template is told.
    """
    return _make_environment(TEMPLATES).get_template(template).render(mark=mark, **members)


def render_html(document: Document, mark: str, paper: str, template: Path | None = None) -> str:
    """Render a document as an HTML page.

    Args:
        document: the document.
        mark: as for `render_page`.
        paper: size of paper to print it on, a key of `PAPERS`.
        template: a template of the user's own.

    Raises:
        CalibrationError: if the user's template cannot be read or is wrong.
    """
    folder = TEMPLATES if template is None else template.parent
    name = "document.html" if template is None else template.name
    try:
        page = _make_environment(folder, TEMPLATES).get_template(name)
        return page.render(document=asdict(document), mark=mark, paper=PAPERS[paper])
    except TemplateError as error:
        raise CalibrationError(
            f"The template {template or name} cannot be rendered: {error}.",
            f"Begin with a copy of {TEMPLATES / 'document.html'}.",
        ) from error


@cache
def _make_environment(*folders: Path) -> SandboxedEnvironment:
    """Make what renders templates of folders: every text is escaped, and none runs programs."""
    return SandboxedEnvironment(
        loader=FileSystemLoader(folders),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )


def render_pdf(
    document: Document, attached: bytes, mark: str, paper: str, template: Path | None = None
) -> bytes:
    """Render a document as PDF/A-3b.

    Args:
        document: the document.
        attached: content of result.json, which the file holds as well.
        mark: as for `render_page`; a comment near the file's end.
        paper: a key of `PAPERS`.
        template: a template of the user's own, for typst.

    Raises:
        CalibrationError: if typst is not installed, or the template is wrong.
    """
    try:
        import typst  # the extra `report`
    except ImportError as error:
        raise CalibrationError(
            "PDF needs the program typst, which is not installed.",
            "Install it: pip install 'calibgui[report]'. HTML needs nothing.",
        ) from error
    from matplotlib import get_data_path  # whose fonts have more alphabets than typst's own

    with tempfile.TemporaryDirectory(prefix="calibgui-") as name:
        folder = Path(name)
        content = asdict(document) | {"paper": paper}
        _write_pictures(content, folder)
        (folder / "document.json").write_text(json.dumps(content), encoding="utf-8")
        (folder / "result.json").write_bytes(attached)
        for font in _FONTS:
            shutil.copy(Path(get_data_path()) / "fonts" / "ttf" / font, folder)
        source = TEMPLATES / "document.typ" if template is None else template
        try:
            (folder / "document.typ").write_bytes(source.read_bytes())
            pdf: bytes = typst.compile(
                folder / "document.typ",
                root=folder,
                font_paths=[folder],
                format="pdf",
                pdf_standards="a-3b",
                timestamp=int(
                    datetime.fromisoformat(document.issued).replace(tzinfo=UTC).timestamp()
                ),
            )
        except OSError as error:
            raise CalibrationError(
                f"{source} cannot be read: {error.strerror}.", "Check its name."
            ) from error
        except typst.TypstError as error:
            hints = " ".join(error.hints)
            raise CalibrationError(
                f"The PDF cannot be made: {error.message}. {hints}".rstrip(),
                f"Begin with a copy of {TEMPLATES / 'document.typ'}."
                if template
                else "Write the report as .html, or install fonts of the texts' alphabet.",
            ) from error
    before, keyword, after = pdf.rpartition(b"\ntrailer\n")
    return before + keyword + f"% {mark}\n".encode() + after


def _write_pictures(content: dict[str, Any], folder: Path) -> None:
    """Write the pictures to files, and name these in their place."""
    count = 0
    for section in content["sections"]:
        for block in section["blocks"]:
            for item in (
                block.get("items", ()) if isinstance(block.get("items"), tuple | list) else ()
            ):
                if not isinstance(item, dict):
                    continue
                count += 1
                if "svg" in item:
                    item["file"] = f"{count}.svg"
                    (folder / item["file"]).write_text(item.pop("svg"), encoding="utf-8")
                elif "jpeg" in item:
                    jpeg = base64.b64decode(item.pop("jpeg"))
                    item["file"] = f"{count}.jpg" if jpeg else ""
                    if jpeg:
                        (folder / item["file"]).write_bytes(jpeg)
