"""What is said while work goes on: to people who watch, and to nobody else."""

from __future__ import annotations

import sys

import pytest

from calibgui.cli.console import Console


@pytest.mark.parametrize("quiet", [False, True])
@pytest.mark.parametrize("watched", [False, True])
def test_a_wait_is_explained_to_who_watches(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, quiet: bool, watched: bool
) -> None:
    monkeypatch.setattr(sys.stderr, "isatty", lambda: watched)
    console = Console(quiet=quiet)
    with console.show_progress("searching") as advance:
        advance(0, 2)
        console.print_notice("Preparing…")
    printed, problems = capsys.readouterr()
    assert printed == ""
    assert ("Preparing…\n" in problems) is (watched and not quiet)
    assert (problems == "") is (quiet or not watched)


def test_no_count_is_shown_without_its_end(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """What is not known to end is a sentence; a bar once the number of all is known."""
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    with Console().show_progress("looking", "step") as advance:
        for done in range(3):
            advance(done, 0)
    shown = capsys.readouterr().err
    assert "looking: 00:00" in shown
    assert "step" not in shown
    with Console().show_progress("looking", "step") as advance:
        assert "step" not in capsys.readouterr().err
        advance(1, 2)
        assert "/2" in capsys.readouterr().err
