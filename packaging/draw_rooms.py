"""Draw the picture of the rooms from the imports: resources/images/rooms.svg.

    python packaging/draw_rooms.py [FILE]

A room is a folder of the package, or one of the files on the engine's ground floor. The rows are
the layers that import-linter enforces (pyproject.toml). An arrow is an import that no chain of
other arrows stands for. The words in a room are the first sentence of its docstring.
"""

from __future__ import annotations

import argparse
import ast
import textwrap
import tomllib
from collections.abc import Mapping
from pathlib import Path
from xml.sax.saxutils import escape

import grimp

ROOT = Path(__file__).resolve().parents[1]
PICTURE = ROOT / "resources" / "images" / "rooms.svg"

WIDTH, ROW = 1080, 96
"""Width of the picture and height of a row, px."""
BOX_WIDTH, BOX_HEIGHT = 236, 66
"""Size of a room, px."""
LETTERS = 38
"""Letters in a line of a room's words."""
MARGIN, HEADING = 20, 26
"""Space around the engine's frame, and above it for its name, px."""

STYLE = """
text { font-family: sans-serif; fill: #1d2733; }
.name { font-size: 15px; font-weight: bold; text-anchor: middle; }
.words { font-size: 11px; text-anchor: middle; }
.room { fill: #ffffff; stroke: #4a6785; stroke-width: 1.2; }
.floor { fill: #eef1f4; stroke: #8b99a8; }
.engine { fill: #dfe8f1; stroke: none; }
.import { fill: none; stroke: #4a6785; stroke-width: 1.2; marker-end: url(#tip); }
"""


def read_imports() -> dict[str, set[str]]:
    """Return for each room the other rooms that it imports from."""
    graph = grimp.build_graph("calibgui", cache_dir=None)
    imports: dict[str, set[str]] = {}
    for module in graph.modules:
        room = room_of(module)
        if room is None:
            continue
        named = map(room_of, graph.find_modules_directly_imported_by(module))
        imports.setdefault(room, set()).update(name for name in named if name)
    return {room: found - {room} for room, found in imports.items()}


def room_of(module: str) -> str | None:
    """Return the room that a module belongs to; None for the faces of package and engine."""
    _, *names = module.split(".")
    if names[:1] == ["engine"]:
        return ".".join(names[:2]) if len(names) > 1 else None
    folder = names and (ROOT / "calibgui" / names[0]).is_dir()
    return names[0] if folder else None


def reduce_imports(imports: Mapping[str, set[str]]) -> dict[str, set[str]]:
    """Return the imports without those that a chain of others stands for."""

    def reach(room: str) -> set[str]:
        return set().union(*({name} | reach(name) for name in imports[room]))

    return {
        room: {name for name in found if not any(name in reach(other) for other in found)}
        for room, found in imports.items()
    }


def read_rows() -> list[list[str]]:
    """Return the rooms of each row from the top: the layers that import-linter enforces."""
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    outer, inner = (c["layers"] for c in settings["tool"]["importlinter"]["contracts"][:2])
    rows = [[name.removeprefix("calibgui.") for name in row.split(" | ")] for row in outer]
    rows += [[f"engine.{name}" for name in row.split(" | ")] for row in inner]
    return [row for row in rows if row not in (["__main__"], ["engine"])]


def place_rooms() -> dict[str, tuple[float, float]]:
    """Return the centre (x, y) px of each room; alone in a row, they stand left and right in turn.

    So an arrow across a row finds its way past the room in it.
    """
    places = {}
    side = 1
    for number, rooms in enumerate(read_rows()):
        frame = HEADING if rooms[0].startswith("engine.") else 0
        y = MARGIN + frame + number * ROW + BOX_HEIGHT / 2
        step = (WIDTH - 2 * MARGIN) / len(rooms)
        if len(rooms) == 1:
            side = -side
        shift = side * BOX_WIDTH * 0.62 if len(rooms) == 1 else 0
        for i, room in enumerate(rooms):
            places[room] = (MARGIN + (i + 0.5) * step + shift, y)
    return places


def read_words(room: str) -> list[str]:
    """Return the first sentence of a room's docstring in lines of `LETTERS` letters."""
    file = ROOT / "calibgui" / Path(*room.split("."))
    file = file / "__init__.py" if file.is_dir() else file.with_suffix(".py")
    docstring = ast.get_docstring(ast.parse(file.read_text(encoding="utf-8"))) or ""
    sentence = " ".join(docstring.split("\n\n")[0].split()).rstrip(".")
    lines = textwrap.wrap(sentence, LETTERS)
    return [*lines[:2], lines[2] + " ..."] if len(lines) > 3 else lines


def draw() -> str:
    """Return the picture as SVG."""
    imports = reduce_imports(read_imports())
    places = place_rooms()
    height = max(y for _, y in places.values()) + BOX_HEIGHT / 2 + 2 * MARGIN
    inside = [y for room, (_, y) in places.items() if room.startswith("engine.")]
    frame = min(inside) - BOX_HEIGHT / 2 - HEADING
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height:.0f}">',
        f"<style>{STYLE}</style>",
        '<defs><marker id="tip" viewBox="0 0 8 8" refX="8" refY="4" markerWidth="8" '
        'markerHeight="8" orient="auto">',
        '<path d="M0,0 L8,4 L0,8 z" fill="#4a6785"/></marker></defs>',
        f'<rect width="{WIDTH}" height="{height:.0f}" fill="#ffffff"/>',
        f'<rect class="engine" x="4" y="{frame:.0f}" width="{WIDTH - 8}" '
        f'height="{height - frame - 6:.0f}" rx="8"/>',
        f'<text class="name" x="48" y="{frame + 19:.0f}">engine</text>',
    ]
    for room, found in sorted(imports.items()):
        for name in sorted(found):
            (x, y), (to_x, to_y) = places[room], places[name]
            y, to_y = y + BOX_HEIGHT / 2, to_y - BOX_HEIGHT / 2
            bend = (to_y - y) / 2
            parts.append(
                f'<path class="import" d="M{x:.0f},{y:.0f} C{x:.0f},{y + bend:.0f} '
                f'{to_x:.0f},{to_y - bend:.0f} {to_x:.0f},{to_y:.0f}"/>'
            )
    for room, (x, y) in sorted(places.items()):
        is_file = not (ROOT / "calibgui" / Path(*room.split("."))).is_dir()
        kind = "room floor" if is_file else "room"
        parts.append(
            f'<rect class="{kind}" x="{x - BOX_WIDTH / 2:.0f}" y="{y - BOX_HEIGHT / 2:.0f}" '
            f'width="{BOX_WIDTH}" height="{BOX_HEIGHT}" rx="6"/>'
        )
        name = room.removeprefix("engine.") + (".py" if is_file else "/")
        parts.append(f'<text class="name" x="{x:.0f}" y="{y - 15:.0f}">{name}</text>')
        for i, line in enumerate(read_words(room)):
            place = f'x="{x:.0f}" y="{y + 1 + 13 * i:.0f}"'
            parts.append(f'<text class="words" {place}>{escape(line)}</text>')
    return "\n".join([*parts, "</svg>"]) + "\n"


def main() -> None:
    """Write the picture."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file", nargs="?", type=Path, default=PICTURE)
    parser.parse_args().file.write_text(draw(), encoding="utf-8")


if __name__ == "__main__":
    main()
