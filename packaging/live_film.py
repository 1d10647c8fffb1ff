"""Draw the film of the live page that the README links: a hand follows what the picture asks for.

    python packaging/live_film.py [FILE]

A rendered hand brings a board to where it is wanted, holds it, and a picture is taken, until the
camera is known well enough. What is shown is what the window shows; waiting is shortened.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from tempfile import TemporaryDirectory
from unittest import mock

from film import SIZE, Film
from screenshots import Hand, open_window, pause, wait

from calibgui.app.photographs import recording
from calibgui.gui.widgets import theme
from calibgui.gui.window.main_window import MainWindow

FILE = Path(__file__).resolve().parents[1] / "resources" / "images" / "live.webp"
_FRAME_MS = 100
"""Time between two frames."""
_EVERY = 2
"""Number of frames of the camera from one that is shown to the next."""
_LIMIT = 0.3
"""Uncertainty at which the capture is complete, px, so that the film is short."""
_QUALITY = 45
"""Quality of the frames in WebP: the noise of the camera's images takes most of the space."""
_END_MS = 2500
"""Time for which the end is shown."""


def act(window: MainWindow, film: Film, folder: Path) -> None:
    """Photograph live to the end."""
    window.own_pages.photograph_live()
    page = window.own_pages.live
    assert page is not None
    page.folder = folder / "pictures"
    page.limit.setValue(_LIMIT)
    pause(0.3)
    film.shoot(600)
    film.click(page.start)
    shown = [page.view.shown[0]]
    while page.is_running:
        wait(lambda: page.view.shown[0] is not shown[-1] or not page.is_running)
        shown.append(page.view.shown[0])
        if len(shown) % _EVERY == 0:
            film.shoot(_FRAME_MS)
    pause(0.3)
    film.move_to(page.view.views[0])
    film.shoot(_END_MS)


def main() -> None:
    """Draw the film."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("file", nargs="?", type=Path, default=FILE)
    path = parser.parse_args().file
    with TemporaryDirectory() as folder, open_window(*SIZE, theme.Scheme.LIGHT) as window:
        film = Film(window)
        with mock.patch.object(recording, "open_source", lambda *_: Hand(window, 100)):
            act(window, film, Path(folder))
        film.save(path, _QUALITY)


if __name__ == "__main__":
    main()
