"""The manual as one page."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from calibgui.app.outputs.manual import list_chapters, make_address, write_manual
from calibgui.cli.main import main


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> str:
    path = tmp_path_factory.mktemp("manual") / "manual.html"
    write_manual(path)
    return path.read_text(encoding="utf-8")


def test_it_needs_no_other_file_and_no_network(page: str) -> None:
    sources = re.findall(r'\bsrc="([^"]{0,30})', page)
    assert len(sources) > 10
    assert all(source.startswith("data:image/") for source in sources)
    assert "<script" not in page and "http" not in re.sub(r"<code>.*?</code>", "", page)
    assert len(page) < 5_000_000


def test_every_link_leads_to_a_heading(page: str) -> None:
    links = re.findall(r'href="([^"]*)"', page)
    places = re.findall(r'\bid="([^"]*)"', page)
    assert len(places) == len(set(places))
    assert len(links) > 2 * len(list_chapters())
    assert {link.removeprefix("#") for link in links} <= set(places)


def test_every_chapter_and_its_tables_are_there(page: str) -> None:
    for chapter in list_chapters():
        assert f'<h1 id="{chapter.name}">{chapter.title}</h1>' in page
    assert not re.search(r"^\| ", page, re.MULTILINE), "a table is not read as one"


@pytest.mark.parametrize(
    ("heading", "address"),
    [("The error, in `px`: what is it?", "the-error-in-px-what-is-it"), ("3-D", "3-d")],
)
def test_addresses_are_those_of_repositories(heading: str, address: str) -> None:
    assert make_address(heading) == address


def test_the_command_writes_its_own_page_anew_and_no_other(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    for _ in range(2):
        assert main(["manual"]) == 0
        assert str(tmp_path / "manual.html") in capsys.readouterr().out
    Path("notes.html").write_text("mine")
    assert main(["manual", "-o", "notes.html"]) == 1
    assert "is not a manual that calibgui wrote" in capsys.readouterr().err
