"""The manual: chapters in Markdown that come with the program, as HTML.

The chapters are the files of resources/manual/ in the order of their names. A heading's address is
the chapter's name, a full stop and the heading as sites of repositories write it, so that the same
links lead to it there, in the window and on the page.
"""

from __future__ import annotations

import base64
import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from markdown_it import MarkdownIt
from markdown_it.token import Token

from calibgui.app.system.resources import find_resource
from calibgui.engine.files import write_atomically
from calibgui.formats.origin import MANUAL, make_mark
from calibgui.report.rendering import render_page
from calibgui.version import __version__

_MEDIA_TYPES = {".png": "image/png", ".svg": "image/svg+xml", ".webp": "image/webp"}
"""Types of the manual's pictures by their suffixes."""


@dataclass(frozen=True, slots=True)
class Chapter:
    """A chapter of the manual."""

    file: Path
    title: str

    @property
    def name(self) -> str:
        """The chapter's address."""
        return self.file.stem


def list_chapters() -> list[Chapter]:
    """List the chapters in reading order.

    Raises:
        CalibrationError: if the manual is missing.
    """
    files = sorted(find_resource("manual").glob("*.md"))
    return [Chapter(file, _read_title(file)) for file in files]


def write_manual(path: Path) -> None:
    """Write the whole manual as one HTML page that needs no other file and no network.

    Raises:
        CalibrationError: if the manual is missing, or the page cannot be written.
    """
    chapters = [(each, render_chapter(each, _embed_picture)) for each in list_chapters()]
    page = render_page("manual.html", make_mark(MANUAL), chapters=chapters, version=__version__)
    write_atomically(path, page.encode())


def render_chapter(chapter: Chapter, find_picture: Callable[[Path], str]) -> str:
    """Return a chapter as a part of HTML, in which links within the manual begin with #.

    Args:
        chapter: the chapter.
        find_picture: returns the address of a picture's file.
    """
    parser = MarkdownIt("commonmark").enable("table")  # with HTML: comments mark what is generated
    tokens = parser.parse(chapter.file.read_text(encoding="utf-8"))
    for number, token in enumerate(tokens):
        if token.type == "heading_open":
            address = make_address(tokens[number + 1].content)
            token.attrSet("id", f"{chapter.name}.{address}" if token.tag != "h1" else chapter.name)
        for part in token.children or ():
            _lead_elsewhere(part, chapter, find_picture)
    html: str = parser.renderer.render(tokens, parser.options, {})
    # Qt shows the line feed after the last line of code as a line.
    html = html.replace("\n</code></pre>", "</code></pre>")
    return html.replace("<table>", '<div class="scroll"><table>').replace(
        "</table>", "</table></div>"
    )


def make_address(heading: str) -> str:
    """Return the address of a heading in Markdown on its page, as sites of repositories write it.

    >>> make_address("The error, in `px`: what is it?")
    'the-error-in-px-what-is-it'
    """
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


def _lead_elsewhere(part: Token, chapter: Chapter, find_picture: Callable[[Path], str]) -> None:
    """Give a link or a picture the address that it has in HTML."""
    if part.type == "image":
        part.attrSet("src", find_picture(chapter.file.parent / str(part.attrGet("src"))))
    elif part.type == "link_open":
        file, _, heading = str(part.attrGet("href")).partition("#")
        if ":" not in file:
            name = file.removesuffix(".md") or chapter.name
            part.attrSet("href", f"#{name}.{heading}" if heading else f"#{name}")


def _embed_picture(file: Path) -> str:
    """Return a picture as an address that holds its content."""
    content = base64.b64encode(file.read_bytes()).decode()
    return f"data:{_MEDIA_TYPES[file.suffix]};base64,{content}"


def _read_title(file: Path) -> str:
    """Return the title of a chapter: its first line without the sign of a heading."""
    with file.open(encoding="utf-8") as lines:
        return next(lines).removeprefix("# ").strip()
