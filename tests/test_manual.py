"""README and manual: their examples do what they say, and what they name is there."""

from __future__ import annotations

import ast
import json
import re
import shlex
import shutil
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from calibgui.app.calibrating.settings import MODEL_CHOICES
from calibgui.app.outputs.manual import list_chapters, make_address
from calibgui.cli.main import main
from calibgui.cli.parser import COMMANDS
from calibgui.engine.assessment import Cause, Grade
from calibgui.engine.assessment.choices import method_comparison
from calibgui.engine.assessment.choices.lens_choice import choose_lens
from calibgui.engine.boards import KINDS
from calibgui.formats import EXPORTERS
from tests.faults.causes import CLEAN, FAULTS

ROOT = Path(__file__).resolve().parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")
CHAPTERS = {each.name: each.file.read_text(encoding="utf-8") for each in list_chapters()}
ALL = "\n".join([README, *CHAPTERS.values()])
ELSEWHERE = {
    # A camera, the paper's images, those of other boards, robots, rigs, of many cameras and of a
    # board that stands still are not bundled.
    "calibgui capture": "cli/test_capture.py",
    "calibgui calibrate pictures": "cli/test_capture.py",
    "calibgui calibrate photographs": "cli/test_boards.py",
    "calibgui noise": "cli/test_quality.py",
    "calibgui paper": "cli/test_paper.py",
    "calibgui hand-eye": "cli/test_hand_eye.py",
    "calibgui rig": "cli/test_rig.py",
    "calibgui triangulate": "cli/test_rig.py",
    "calibgui stereo": "cli/test_rig.py",
    "calibgui batch": "cli/test_batch.py",
    "calibgui fleet": "cli/test_batch.py",
    # What changes the system.
    "python3 packaging/bootstrap.py": "packaging/test_bootstrap.py",
    "xdg-mime": "packaging/test_desktop_entry.py",
    "install -Dm644": "packaging/test_desktop_entry.py",
}
"""Tests of the commands that are not run here, by the commands' beginnings."""


def list_blocks(language: str, text: str = ALL) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)


def list_commands() -> list[str]:
    """List the commands of all documents, in reading order."""
    lines = "".join(list_blocks("sh")).splitlines()
    return [line for line in lines if line and not line.startswith("#")]


@pytest.fixture
def elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A working folder with half the sample where the documents have it."""
    half = shutil.ignore_patterns("view*[13579].png")  # is enough
    shutil.copytree(ROOT / "resources/sample", tmp_path / "resources/sample", ignore=half)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def few_candidates(monkeypatch: pytest.MonkeyPatch) -> None:
    """Lens models and methods to compare are few, which is quick; tests/cli compares all."""
    few_lenses = partial(choose_lens, candidates=("lucchese", "pinhole"))
    monkeypatch.setattr("calibgui.app.calibrating.lens_comparison.choose_lens", few_lenses)
    listed = method_comparison.list_compared_methods()
    few_methods = {name: listed[name] for name in ("lucchese", "bouguet", "stein")}
    monkeypatch.setattr(method_comparison, "list_compared_methods", lambda: few_methods)


def test_every_command_is_run_here_or_elsewhere() -> None:
    for begins, file in ELSEWHERE.items():
        assert any(line.startswith(begins) for line in list_commands()), begins
        assert (ROOT / "tests" / file).is_file(), file
    for line in list_commands():
        assert line.startswith(("calibgui ", *ELSEWHERE)), line


@pytest.mark.slow
@pytest.mark.usefixtures("search_here", "few_candidates")
def test_commands(elsewhere: Path, capsys: pytest.CaptureFixture[str]) -> None:
    lines = [line for line in list_commands() if not line.startswith(tuple(ELSEWHERE))]
    for line in lines:
        program, *arguments = shlex.split(line, comments=True)
        assert program == "calibgui"
        if arguments[0] in COMMANDS:
            assert main(arguments) == 0, f"{line}: {capsys.readouterr().err}"
        else:  # opens the window
            assert all(Path(argument).exists() for argument in arguments)
    written = {path.name for path in elsewhere.iterdir()}
    named = re.findall(r"(?:-o |--next |--export \S+=|--export-all )(\S+)", "\n".join(lines))
    assert len(named) > 30 and set(named) <= written


@pytest.mark.slow
@pytest.mark.usefixtures("elsewhere")
def test_python() -> None:
    scope: dict[str, Any] = {}
    for block in list_blocks("python"):
        exec(block, scope)
    camera = scope["camera"]
    assert camera.verdict.grade is Grade.GOOD and scope["K"].shape == (3, 3)
    assert Path("camera.json").exists() and Path("camera.yaml").exists()
    assert scope["figure"].axes and scope["rays"].shape == (1, 3)
    truth = json.loads(Path("resources/sample/truth.json").read_text(encoding="utf-8"))
    result, true_fx = scope["result"], truth["camera"]["params"]["fx"]
    for fx, sigma in ((result.camera.params[0], result.sigma[0]), (scope["fx"], scope["sigma"])):
        assert abs(fx - true_fx) < 4 * sigma
    assert scope["straight"].shape == scope["views"][0][0].shape
    assert scope["picture"].ndim == 2


def read_values(table: str) -> dict[str, tuple[float, float]]:
    """Read the values that stand in a table of a camera, each with its standard deviation."""
    found = re.findall(r"([a-z]+\d?) +\(?(-?[\d.]+) ± ([\d.]+)(?:\)(e-?\d+))?", table)
    return {
        name: (float(value + power), float(sigma + power)) for name, value, sigma, power in found
    }


@pytest.mark.slow
@pytest.mark.usefixtures("search_here")
def test_samples_camera(capsys: pytest.CaptureFixture[str]) -> None:
    (printed,) = (block for block in list_blocks("text") if "fx" in block)
    (verdict,) = (block for block in list_blocks("text") if "GOOD" in block)
    assert main(["calibrate", str(ROOT / "resources/sample"), "--square", "25"]) == 0
    found = capsys.readouterr().out
    computed, stated = read_values(found), read_values(printed)
    assert len(stated) == 9 and stated.keys() == computed.keys()
    for name, (value, sigma) in stated.items():
        assert value == pytest.approx(computed[name][0], abs=0.1 * sigma), name
        assert sigma == pytest.approx(computed[name][1], rel=0.05), name
    number = re.compile(r"\d+\.\d+")
    assert number.sub("#", found).startswith(number.sub("#", verdict))


def test_every_board_and_every_lens_model_is_in_a_table() -> None:
    rows = "".join(re.findall(r"^\|.*$\n", ALL, re.MULTILINE))
    for kind in KINDS:
        assert f"| `{kind}` |" in rows, kind
    for model in MODEL_CHOICES:
        assert re.search(rf"^\| `{model}(-30x20-150)?` \|", rows, re.MULTILINE), model


@pytest.mark.parametrize("chapter", ["07-lenses", "12-figures"])
def test_every_method_is_in_the_tables(chapter: str) -> None:
    rows = "".join(re.findall(r"^\| (`.*?) \|", CHAPTERS[chapter], re.MULTILINE))
    named = set(re.findall(r"`([\w-]+)`", rows))
    methods = set(method_comparison.list_compared_methods()) - {method_comparison.AS_PRINTED}
    assert methods <= named


def test_every_cause_is_explained() -> None:
    rows = re.findall(r"^\| `([\w-]+)` \| .+ \| .+ \|$", CHAPTERS["06-messages"], re.MULTILINE)
    assert rows == list(Cause)


def list_texts(node: ast.AST) -> list[str]:
    """List the texts of a module, with an ellipsis for what is put into them."""
    texts = []
    for part in ast.walk(node):
        if isinstance(part, ast.JoinedStr):
            pieces = [p.value if isinstance(p, ast.Constant) else "…" for p in part.values]
            texts.append("".join(map(str, pieces)))
        elif isinstance(part, ast.Constant) and isinstance(part.value, str):
            texts.append(part.value)
    return texts


def test_messages_are_those_of_the_program() -> None:
    quoted = re.findall(r'\*\*"(.+?)"\*\*', CHAPTERS["06-messages"])
    assert len(quoted) > 25
    texts = "\n".join(
        text
        for file in (ROOT / "calibgui").rglob("*.py")
        if "Error(" in (source := file.read_text(encoding="utf-8")) or "missing" in source
        for text in list_texts(ast.parse(source))
        if " " in text
    )
    for message in quoted:
        pattern = ".*".join(map(re.escape, message.removeprefix("… ").split("…")))
        assert re.search(pattern, texts), message


def test_the_table_of_faults_is_that_of_the_campaign_and_adds_up() -> None:
    """Every fault has its row, whose shares are whole draws; what is said of all is their sum."""
    text = CHAPTERS["12-figures"]
    (command,) = re.findall(r"`python -m tests\.faults (.*?)` injects (\d+) causes", text)
    draws = int(re.findall(r"--draws (\d+)", command[0])[0])
    table = text[text.index("| fault | named |") :].partition("\n\n")[0]
    rows = [[cell.strip(" *") for cell in line.split("|")[1:-1]] for line in table.splitlines()[2:]]
    names = [name for name in FAULTS if name != CLEAN]
    assert [row[0] for row in rows] == [*names, "all", CLEAN]
    assert int(command[1]) == len(names)
    shares = {row[0]: [float(cell.rstrip("%")) / 100 for cell in row[1:5]] for row in rows[:-1]}
    counts = [round(draws * sum(shares[name][k] for name in names)) for k in range(4)]
    assert all(round(sum(draws * share for share in shares[name])) == draws for name in names)
    assert shares["all"] == [round(count / draws / len(names), 2) for count in counts]
    stated = re.search(
        r"Of (\d+) faults (\d+) are named, (\d+) are harmless, (\S+) (?:is|are) given another "
        r"cause, (\S+) (?:is|are) wrong in silence",
        text,
    )
    assert stated is not None
    words = ["none", "one", "two", "three", "four", "five", "six"]
    numbers = [int(t) if t.isdigit() else words.index(t) for t in stated.groups()]
    assert numbers == [draws * len(names), *counts]


def test_the_readme_fits_on_a_few_screens_and_counts_right() -> None:
    assert len(README.splitlines()) <= 200
    models = [model for model in MODEL_CHOICES if model != "auto"]
    counts = {"causes": len(Cause), "lens models": len(models), "formats": len(EXPORTERS)}
    for what, number in counts.items():
        assert re.search(rf"\b{number} {what}", README), f"{number} {what}"


def test_files_named_exist() -> None:
    for name in re.findall(r"`((?:[\w.-]+/)+[\w-]+\.(?:md|py|txt)|[A-Z]+\.md|[\w/]+/)`", ALL):
        assert (ROOT / name).exists(), name


def test_links_and_pictures_lead_somewhere() -> None:
    places = {ROOT / "README.md": README} | {c.file: CHAPTERS[c.name] for c in list_chapters()}
    headings = {
        place: {make_address(line) for line in re.findall(r"^#+ (.+)$", text, re.MULTILINE)}
        for place, text in places.items()
    }
    shown = set()
    for place, text in places.items():
        prose = re.sub(r"^```.*?^```$|`[^`\n]+`", "", text, flags=re.MULTILINE | re.DOTALL)
        for link in re.findall(r"\]\(([^)\s]+)\)", prose):
            file, _, heading = link.partition("#")
            target = (place.parent / file).resolve() if file else place
            assert target.is_file(), f"{place.name}: {link}"
            assert not heading or heading in headings[target], f"{place.name}: {link}"
            shown.add(target)
    assert set(places) - {ROOT / "README.md"} <= shown, "README lists every chapter"
    pictures = set((ROOT / "resources/manual/images").iterdir())
    assert pictures <= shown, "every picture is shown"
