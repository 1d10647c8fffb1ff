"""The README's examples do what it says."""

from __future__ import annotations

import json
import re
import shlex
import shutil
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from calibgui.app.calibrating.settings import MODEL_CHOICES
from calibgui.app.outputs.export_folder import PAGE
from calibgui.cli.main import main
from calibgui.engine.assessment import Grade
from calibgui.engine.assessment.choices import method_comparison
from calibgui.engine.assessment.choices.lens_choice import choose_lens
from calibgui.engine.boards import KINDS
from calibgui.formats import EXPORTERS
from tests.faults.causes import CLEAN, FAULTS

ROOT = Path(__file__).resolve().parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")


def blocks(language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```$", README, re.MULTILINE | re.DOTALL)


@pytest.fixture
def elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A working folder with half the sample where the README has it."""
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


@pytest.mark.slow
@pytest.mark.usefixtures("search_here", "few_candidates")
def test_command_lines(elsewhere: Path, capsys: pytest.CaptureFixture[str]) -> None:
    lines = re.findall(r"^calibgui (.+)$", "".join(blocks("sh")), re.MULTILINE)
    window, *lines = lines
    assert Path(window).is_dir()
    # The paper's images, those of other boards, robots, rigs, of many cameras and of a board that
    # stands still are not bundled; see cli/test_boards.py, cli/test_hand_eye.py, cli/test_rig.py,
    # cli/test_batch.py and cli/test_quality.py. A capture needs a camera; see cli/test_capture.py.
    left_out = (
        *("paper", "calibrate photographs", "hand-eye photographs", "batch", "fleet", "noise"),
        *("capture", "calibrate pictures", "rig", "stereo", "triangulate"),
    )
    lines = [line for line in lines if not line.startswith(left_out)]
    for line in lines:
        assert main(shlex.split(line)) == 0, capsys.readouterr().err
    written = {path.name for path in elsewhere.iterdir()}
    named = re.findall(r"(?:-o |--next |=)(\S+)", "\n".join(lines))
    assert set(named) <= written


@pytest.mark.slow
@pytest.mark.usefixtures("elsewhere")
def test_python() -> None:
    short, example = blocks("python")
    scope: dict[str, Any] = {}
    exec(short, scope)
    assert scope["camera"].verdict.grade is Grade.GOOD and scope["K"].shape == (3, 3)
    assert Path("camera.json").exists() and Path("camera.yaml").exists()
    assert scope["figure"].axes
    exec(example, scope)
    truth = json.loads(Path("resources/sample/truth.json").read_text(encoding="utf-8"))
    true_values = list(truth["camera"]["params"].values())
    result = scope["result"]
    fx, fx_sigma = result.camera.params[0], result.sigma[0]
    assert abs(fx - true_values[0]) < 4 * fx_sigma
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
    (printed,) = (block for block in blocks("text") if "fx" in block)
    assert main(["calibrate", str(ROOT / "resources/sample"), "--square", "25"]) == 0
    computed = read_values(capsys.readouterr().out)
    stated = read_values(printed)
    assert len(stated) == 9 and stated.keys() == computed.keys()
    for name, (value, sigma) in stated.items():
        assert value == pytest.approx(computed[name][0], abs=0.1 * sigma), name
        assert sigma == pytest.approx(computed[name][1], rel=0.05), name


def test_every_export_format_is_in_the_table() -> None:
    rows = "".join(re.findall(r"^\|.*--export.*$", README, re.MULTILINE))
    assert set(re.findall(r"([\w-]+)=`", rows)) == set(EXPORTERS)


def list_format_rows() -> dict[str, list[str]]:
    """List the cells of the table of formats by the formats' names."""
    rows = re.findall(r"^\| (.* \| `--export ([\w-]+)=` \| .*) \|$", README, re.MULTILINE)
    return {name: row.split(" | ") for row, name in rows}


def test_the_table_of_formats_says_what_the_window_says() -> None:
    for name, (title, _, _, *facts, _) in list_format_rows().items():
        exporter = EXPORTERS[name]
        assert title == exporter.title
        assert facts == [exporter.readers, exporter.keeps, exporter.loses], name


@pytest.mark.slow
@pytest.mark.usefixtures("search_here")
def test_the_table_of_formats_has_the_samples_errors(tmp_path: Path) -> None:
    arguments = [str(ROOT / "resources/sample"), "--square", "25"]
    assert main(["calibrate", *arguments, "--export-all", str(tmp_path)]) == 0
    page = (tmp_path / PAGE).read_text(encoding="utf-8")
    for name, cells in list_format_rows().items():
        (error,) = re.findall(rf"^\| {name}[./].* \| (.*) \|$", page, re.MULTILINE)
        if error == "none":
            assert cells[-1] == "none", name
        else:
            assert float(cells[-1]) == pytest.approx(float(error), rel=0.1), name


def test_every_board_and_every_lens_model_is_in_a_table() -> None:
    rows = "".join(re.findall(r"^\|.*$\n", README, re.MULTILINE))
    for kind in KINDS:
        assert f"| `{kind}` |" in rows, kind
    for model in MODEL_CHOICES:
        assert re.search(rf"^\| `{model}(-30x20-150)?` \|", rows, re.MULTILINE), model


def test_every_method_is_in_the_table() -> None:
    rows = "".join(re.findall(r"^\| (`.*?) \|", README, re.MULTILINE))
    named = set(re.findall(r"`([\w-]+)`", rows))
    methods = set(method_comparison.list_compared_methods()) - {method_comparison.AS_PRINTED}
    assert methods <= named


def test_the_table_of_faults_is_that_of_the_campaign_and_adds_up() -> None:
    """Every fault has its row, whose shares are whole draws; what is said of all is their sum."""
    (command,) = re.findall(r"`python -m tests\.faults (.*?)` injects (\d+) causes", README)
    draws = int(re.findall(r"--draws (\d+)", command[0])[0])
    table = README[README.index("| fault | named |") :].partition("\n\n")[0]
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
        README,
    )
    assert stated is not None
    words = ["none", "one", "two", "three", "four", "five", "six"]
    numbers = [int(t) if t.isdigit() else words.index(t) for t in stated.groups()]
    assert numbers == [draws * len(names), *counts]


def test_files_named_exist() -> None:
    for name in re.findall(r"`((?:[\w.-]+/)*[\w-]+\.(?:md|py|txt)|[\w/]+/)`", README):
        assert (ROOT / name).exists(), name
    for picture in re.findall(r"!\[.*?\]\((.*?)\)", README):
        assert (ROOT / picture).is_file(), picture
