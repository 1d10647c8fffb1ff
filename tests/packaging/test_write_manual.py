"""The manual's tables say what the code says, and the README's chart what the manual says."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

import pytest

FOLDER = Path(__file__).resolve().parents[2] / "packaging"
CHAPTERS = FOLDER.parent / "resources" / "manual"
with pytest.MonkeyPatch.context() as patch:
    patch.setattr(sys, "path", [str(FOLDER), *sys.path])
    import draw_comparison
    import write_manual


@pytest.mark.parametrize(
    ("chapter", "name", "describe"),
    [
        ("05-window", "panels", write_manual.describe_panels),
        ("10-several-cameras", "rig_formats", write_manual.describe_rig_formats),
        ("11-scripts", "commands", write_manual.describe_commands),
        ("13-words", "terms", write_manual.describe_terms),
    ],
)
def test_a_chapter_says_what_the_code_says(
    chapter: str, name: str, describe: Callable[[], str]
) -> None:
    text = (CHAPTERS / f"{chapter}.md").read_text(encoding="utf-8")
    assert f"<!-- {name}: " in text
    assert write_manual.fill(text, {name: describe}) == text


def test_the_table_of_formats_is_the_exporters() -> None:
    text = (CHAPTERS / "08-formats.md").read_text(encoding="utf-8")
    errors = write_manual.read_errors(text)
    parts = {"formats": lambda: write_manual.describe_formats(errors)}
    assert write_manual.fill(text, parts) == text


@pytest.mark.slow
def test_the_table_of_formats_has_the_samples_errors() -> None:
    text = (CHAPTERS / "08-formats.md").read_text(encoding="utf-8")
    for stated, error in zip(
        write_manual.read_errors(text), write_manual.measure_errors(), strict=True
    ):
        if stated == "none":
            assert error == "none"
        else:
            assert float(stated) == pytest.approx(float(error), rel=0.1)


def test_a_part_that_is_stale_is_written_anew() -> None:
    stale = "# T\n\n<!-- terms: x -->\n\nold\n\n<!-- end -->\n\nrest\n"
    assert write_manual.fill(stale, {"terms": lambda: "new"}) == stale.replace("old", "new")


def test_the_chart_shows_the_manuals_figures() -> None:
    drawn = draw_comparison.draw(draw_comparison.FIGURES.read_text(encoding="utf-8"))
    assert drawn == draw_comparison.PICTURE.read_text(encoding="utf-8")
