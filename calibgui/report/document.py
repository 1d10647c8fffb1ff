"""A document as data: sections of paragraphs, facts, tables, figures and photographs.

Every page that leaves the program is one, and the templates (``templates/``) know nothing else: the
same record becomes HTML by jinja2 and PDF by typst (``rendering.py``). A user's own template gets
it as it is here.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import StrEnum


class Mood(StrEnum):
    """The mood in which the reader should take something."""

    GOOD = "good"
    CAUTION = "caution"
    BAD = "bad"
    PLAIN = "plain"


@dataclass(frozen=True, slots=True)
class Paragraph:
    """A few sentences."""

    text: str
    mood: Mood = Mood.PLAIN
    kind: str = field(default="paragraph", init=False)


@dataclass(frozen=True, slots=True)
class Bullets:
    """A list of sentences."""

    items: Sequence[str]
    kind: str = field(default="bullets", init=False)


@dataclass(frozen=True, slots=True)
class Facts:
    """Pairs of a label and what is known of it."""

    rows: Sequence[tuple[str, str]]
    kind: str = field(default="facts", init=False)


@dataclass(frozen=True, slots=True)
class Table:
    """A table of texts."""

    head: Sequence[str]
    rows: Sequence[Sequence[str]]
    texts: Sequence[int] = (0,)
    """Columns that are aligned on the left; the others hold numbers."""
    note: str = ""
    """What has to be known to read it."""
    is_fine: bool = False
    """True if it is set small, as a table of digests is."""
    kind: str = field(default="table", init=False)


@dataclass(frozen=True, slots=True)
class Picture:
    """A figure with its caption."""

    svg: str
    caption: str


@dataclass(frozen=True, slots=True)
class Pictures:
    """Figures side by side."""

    items: Sequence[Picture]
    columns: int = 2
    kind: str = field(default="pictures", init=False)


@dataclass(frozen=True, slots=True)
class Photograph:
    """A small picture of a photograph."""

    name: str
    jpeg: str
    """Content of a JPEG file in base64; empty if there is no picture."""
    caption: str
    mood: Mood = Mood.PLAIN


@dataclass(frozen=True, slots=True)
class Photographs:
    """Small pictures of photographs."""

    items: Sequence[Photograph]
    kind: str = field(default="photographs", init=False)


@dataclass(frozen=True, slots=True)
class Signatures:
    """Lines to sign on."""

    items: Sequence[tuple[str, str]]
    """What each is for, and the name below it."""
    kind: str = field(default="signatures", init=False)


Block = Paragraph | Bullets | Facts | Table | Pictures | Photographs | Signatures


@dataclass(frozen=True, slots=True)
class Section:
    """A part of a document under a heading."""

    title: str
    blocks: Sequence[Block]


@dataclass(frozen=True, slots=True)
class Document:
    """All that a template is told."""

    title: str
    subtitle: str
    id: str
    """What every page is marked with."""
    issued: str
    """Date of issue, as YYYY-MM-DD."""
    mood: Mood
    headline: str
    """The verdict in a few words; empty if there is none."""
    reason: str
    stamp: str
    """PASS or FAIL by limits; empty without them."""
    stamp_mood: Mood
    tiles: Sequence[tuple[str, str]]
    """The few numbers that matter most, each with what it is."""
    sections: Sequence[Section]
    footer: str
    """What stands at the foot of every page."""
