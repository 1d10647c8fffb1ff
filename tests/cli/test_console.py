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
