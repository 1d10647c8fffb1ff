"""calibgui completion: the script completes in the shell that it is for."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from calibgui.cli.completion import SHELLS
from calibgui.cli.main import main
from calibgui.cli.parser import COMMANDS

ASK = """
source {script}
COMP_WORDS=({words} "$1")
COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1))
_shtab_calibgui
printf '%s\\n' "${{COMPREPLY[@]}}"
"""


@pytest.fixture(scope="module", params=SHELLS)
def shell(request: pytest.FixtureRequest) -> str:
    return str(request.param)


def test_every_command_and_option_is_in_the_script(
    shell: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["completion", shell]) == 0
    script = capsys.readouterr().out
    for word in (*COMMANDS, "square", "board", "asymmetric-circles", "overwrite"):
        assert word in script


@pytest.mark.skipif(shutil.which("bash") is None, reason="needs bash")
@pytest.mark.parametrize(
    ("words", "begun", "offered"),
    [
        ("calibgui", "cal", "calibrate"),
        ("calibgui calibrate", "--squ", "--square"),
        ("calibgui calibrate photos --target", "cha", "charuco"),
        ("calibgui calibrate photos -o", "resu", "result.json"),
        ("calibgui detect", "phot", "photos"),
        ("calibgui calibrate photos --model", "rat", "rational"),
        ("calibgui convert result.json --model", "rat", "rational"),
        ("calibgui calibrate photos --export", "ros", "ros=camera.yaml"),
        ("calibgui calibrate photos --for", "kal", "kalibr=camera.yaml"),
        ("calibgui calibrate photos --board-shape", "aff", "affine"),
        ("calibgui detect photos --dictionary", "DICT_5X5_25", "DICT_5X5_250"),
        ("calibgui detect photos --frames-folder", "phot", "photos"),
        ("calibgui undistort result.json photos -o", "", "photos"),
        ("calibgui undistort result.json", "phot", "photos"),
    ],
)
def test_bash_completes(
    words: str,
    begun: str,
    offered: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert main(["completion", "bash"]) == 0
    script = tmp_path / "script"
    script.write_text(capsys.readouterr().out)
    (tmp_path / "photos").mkdir()
    (tmp_path / "result.json").touch()
    monkeypatch.chdir(tmp_path)
    answer = subprocess.run(
        ["bash", "-c", ASK.format(script=script, words=words), "bash", begun],
        capture_output=True,
        text=True,
        check=True,
    )
    assert answer.stdout.split() == [offered]


def test_another_shell_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["completion", "cmd"])
    assert "invalid choice: 'cmd'" in capsys.readouterr().err
