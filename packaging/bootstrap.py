"""Set up calibgui on a machine that has only Python 3.11 or newer, then run it or its tests.

    python3 packaging/bootstrap.py run     the main job on the bundled sample
    python3 packaging/bootstrap.py test    the whole test suite; further arguments go to pytest
    python3 packaging/bootstrap.py setup   only the set-up, with the developers' tools

Everything lands in a virtual environment, `.venv` in the checkout (in the user's cache where the
checkout is read-only, or the folder that CALIBGUI_VENV names); the Python that runs this file is
left as it is. A second call finds the environment ready and starts at once.

Debian packages that are missing are unpacked inside the environment, which needs no rights and
changes nothing else. Where the user may install them for the whole system (root, or sudo without a
password) the script asks on a terminal, and does so without asking with `--yes`; where neither can
be done the command to give is printed.

Python packages come in the versions, and with the SHA-256, of `packaging/constraints`, if there is
a file for this Python (`packaging/refresh_constraints.py` writes them). A constraint file of the
user's own (PIP_CONSTRAINT, which may name an empty file) takes its place.

Only this file's syntax must suit older Pythons, so that they reach the message that says so.
"""

from __future__ import annotations

import argparse
import hashlib
import itertools
import json
import os
import shlex
import shutil
import subprocess
import sys
from pathlib import Path
from xml.sax.saxutils import escape

ROOT = Path(__file__).resolve().parents[1]
OLDEST = (3, 11)
WINDOWS = os.name == "nt"
LINUX = sys.platform.startswith("linux")
WINDOW = ROOT / "calibgui" / "gui" / "__main__.py"
CONSTRAINTS = ROOT / "packaging" / "constraints"
NEXT_EXTRA = "# What the next extra needs besides:\n"
"""Line between the parts of a constraint file, one for each of EXTRAS."""
SYSTEM = Path("/")
SYSTEM_CERTIFICATES = Path("/etc/ssl/certs/ca-certificates.crt")

LACKING = """
import ctypes, sys
for name in sys.argv[1:]:
    try:
        ctypes.CDLL(name)
    except OSError:
        print(name)
"""
EXTRAS = ("", "gui", "dev")
"""What can be installed, each with all before it: no extra is the command line alone."""
COMPLETE = """
import sys
from importlib.metadata import requires, version
from pip._vendor.packaging.requirements import Requirement
for need in map(Requirement, requires("calibgui")):
    if need.marker is None or any(need.marker.evaluate({"extra": name}) for name in sys.argv[1:]):
        assert need.specifier.contains(version(need.name), prereleases=True)
"""
PIP_IN_WHEEL = """
import runpy, sys
wheel, certificates, *arguments = sys.argv[1:]
sys.path.insert(0, wheel)
from pip._vendor import certifi
certifi.where = lambda: certificates
sys.argv[1:] = arguments
runpy.run_module("pip", run_name="__main__", alter_sys=True)
"""
# Slight hinting is Debian's: with full hinting letters are 3 % wider, and texts do not fit.
FONTS_CONF = """<?xml version="1.0"?>
<!DOCTYPE fontconfig SYSTEM "fonts.dtd">
<fontconfig><dir>/usr/share/fonts</dir><dir>{}</dir><cachedir prefix="xdg">fontconfig</cachedir>
<match target="pattern">
<edit name="hintstyle" mode="append"><const>hintslight</const></edit>
</match></fontconfig>
"""
OPENS_WINDOW = "from PySide6.QtGui import QGuiApplication; QGuiApplication([])"


class SetupError(Exception):
    """The set-up cannot go on; the text says why and what to do."""


def say(text: str) -> None:
    print("calibgui: " + text, flush=True)


def succeeds(*command: str | Path, env: dict[str, str] | None = None) -> bool:
    """Return whether `command` can be started and ends well; its output is dropped."""
    try:
        return (
            subprocess.run(
                command, env=env, capture_output=True, check=False, stdin=subprocess.DEVNULL
            ).returncode
            == 0
        )
    except OSError:
        return False


def output(*command: str | Path, env: dict[str, str] | None = None) -> str:
    """Return what `command` prints."""
    return subprocess.run(command, env=env, capture_output=True, text=True, check=False).stdout


# --- Python -------------------------------------------------------------------------------------


def hand_over_to_newer_python() -> None:
    """Start again under a Python that is new enough; return if this one is."""
    if sys.version_info >= OLDEST:
        return
    found = f"{sys.version_info[0]}.{sys.version_info[1]}"
    for minor in range(20, OLDEST[1] - 1, -1):
        newer = shutil.which(f"python3.{minor}")
        if newer and succeeds(newer, "-c", ""):
            say(f"this is Python {found}; going on with {newer}")
            sys.exit(subprocess.call([newer, *sys.argv]))
    sys.exit(
        f"calibgui: needs Python 3.11 or newer and this is {found}. Install a newer one, for "
        "example with\n    sudo apt-get install python3.11 python3.11-venv"
    )


def base_python() -> str:
    """Return the Python outside any virtual environment, which can rebuild ours from within."""
    return getattr(sys, "_base_executable", None) or sys.executable


def venv_package() -> list[str]:
    """Return the Debian package that `python -m venv` lacks, if it does."""
    if not LINUX or succeeds(base_python(), "-c", "import venv, ensurepip"):
        return []
    return [f"python3.{sys.version_info[1]}-venv"]


# --- the virtual environment ----------------------------------------------------------------------


def place() -> Path:
    """Return the folder of the virtual environment, whether it exists or not."""
    if "CALIBGUI_VENV" in os.environ:
        return Path(os.environ["CALIBGUI_VENV"]).absolute()
    here = ROOT / ".venv"
    if os.access(here if here.exists() else ROOT, os.W_OK):
        return here
    cache = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    return cache / "calibgui" / hashlib.sha256(os.fsencode(ROOT)).hexdigest()[:12]


class Environment:
    """The virtual environment and the record of what it was built from."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.python = folder / ("Scripts/python.exe" if WINDOWS else "bin/python")
        self.stamp = folder / "calibgui-bootstrap.json"
        """Present: this script made the folder. Empty: it was interrupted."""
        self.debian = folder / "debian"
        """Debian packages unpacked for a user who may not install them."""
        self.fonts = self.debian / "fonts.conf"
        """Tells where their fonts are, if there are any among them."""

    def variables(self) -> dict[str, str]:
        """Return the caller's variables without what would lead Python or pip astray, in UTF-8.

        pip's own settings, and so the package index chosen for the machine, stay.
        """
        env = {k: v for k, v in os.environ.items() if k not in ("PYTHONHOME", "PYTHONPATH")}
        env.update(PYTHONUTF8="1", PIP_USER="0", PIP_DISABLE_PIP_VERSION_CHECK="1")
        if self.debian.is_dir():
            libraries = self.debian.glob("**/lib/*-linux-gnu*")
            inherited = [env["LD_LIBRARY_PATH"]] if env.get("LD_LIBRARY_PATH") else []
            env["LD_LIBRARY_PATH"] = os.pathsep.join([*map(str, libraries), *inherited])
            if self.fonts.exists():
                env["FONTCONFIG_FILE"] = str(self.fonts)
            if not Path("/usr/share/X11/xkb").exists():
                env["XKB_CONFIG_ROOT"] = str(self.debian / "usr/share/X11/xkb")
        return env

    def source(self) -> str:
        """Return the digest of what the environment is built from: if it differs, so must that."""
        python = Path(base_python()).resolve()
        digest = hashlib.sha256(f"{sys.version}\n{python}\n{ROOT}\n".encode())
        files = [ROOT / "pyproject.toml", ROOT / "calibgui" / "__init__.py", constraint_file()]
        for file in filter(None, files):
            digest.update(file.read_bytes())
        return digest.hexdigest()

    def holds(self) -> str | None:
        """Return what is installed, one of EXTRAS; None if nothing of use."""
        try:
            stamp = json.loads(self.stamp.read_text(encoding="utf-8"))
        except (OSError, ValueError):
            return None
        if stamp["source"] != self.source():
            return None
        extra: str = stamp["extra"]
        extras = EXTRAS[: EXTRAS.index(extra) + 1]
        complete = succeeds(self.python, "-c", COMPLETE, *extras, env=self.variables())
        return extra if complete else None

    def begin(self) -> None:
        """Make an empty folder, marked as this script's and not yet usable."""
        if self.folder.exists() and any(self.folder.iterdir()) and not self.stamp.exists():
            raise SetupError(
                f"{self.folder} was made by something else and is left alone. Move it away, or "
                "name another folder in the environment variable CALIBGUI_VENV."
            )
        say(f"making a virtual environment in {self.folder}")
        shutil.rmtree(self.folder, ignore_errors=True)
        self.folder.mkdir(parents=True, exist_ok=True)
        self.stamp.touch()

    def create(self) -> None:
        """Put Python and pip in the folder that `begin` left."""
        wheel = self.find_pip_wheel() if venv_package() else None
        options = ["--without-pip"] if wheel else []
        command = [base_python(), "-m", "venv", *options, str(self.folder)]
        made = subprocess.run(
            command, env=self.variables(), capture_output=True, text=True, check=False
        )
        if made.returncode:
            raise SetupError(f"no virtual environment could be made:\n{made.stdout}{made.stderr}")
        if wheel:
            self.pip_from(wheel)

    def find_pip_wheel(self) -> Path | None:
        """Return Debian's copy of pip: unpacked here, unless the system has it already."""
        wheels = (root.glob("usr/share/python-wheels/pip-*.whl") for root in (self.debian, SYSTEM))
        return next(itertools.chain.from_iterable(wheels), None)

    def pip_from(self, wheel: Path) -> None:
        """Install pip by its copy in Debian's `wheel`, which insists on Debian's certificates."""
        certificates = SYSTEM_CERTIFICATES
        if not certificates.exists():
            certificates = self.debian / "certificates.crt"
            each = sorted((self.debian / "usr/share/ca-certificates").rglob("*.crt"))
            certificates.write_bytes(b"".join(file.read_bytes() for file in each))
        self.pip("-c", PIP_IN_WHEEL, str(wheel), str(certificates), "install", "pip")

    def install(self, extra: str) -> None:
        """Install the project, editable, with its dependencies."""
        say("installing calibgui and what it needs (700 to 1,200 MB on the disk)")
        project = f"{ROOT}[{extra}]" if extra else str(ROOT)
        options = []
        if (constraints := constraint_file()) is not None:
            parts = constraints.read_text(encoding="utf-8").split(NEXT_EXTRA)
            pinned = self.folder / "requirements.txt"
            pinned.write_text("".join(parts[: EXTRAS.index(extra) + 1]), encoding="utf-8")
            hashes = ["--require-hashes", "--no-deps", "--requirement", str(pinned)]
            self.pip("-m", "pip", "install", *hashes)
            options = ["--no-build-isolation"]  # what builds the project is among them
        self.pip("-m", "pip", "install", *options, "--editable", project)
        stamp = {"source": self.source(), "extra": extra}
        self.stamp.write_text(json.dumps(stamp), encoding="utf-8")

    def lead_commands_to_libraries(self) -> None:
        """Make the program's commands find the libraries that were unpacked here, as `run` does."""
        if not self.debian.is_dir():
            return
        settings = [
            f"export {name}={shlex.quote(value)}"
            for name, value in self.variables().items()
            if name in ("LD_LIBRARY_PATH", "FONTCONFIG_FILE", "XKB_CONFIG_ROOT")
        ]
        for name, function in (("calibgui", "main"), ("calibgui-window", "open_window")):
            program = (
                f"import sys; sys.argv[0] = '{name}'; "
                f"from calibgui.cli.main import {function}; sys.exit({function}())"
            )
            start = f'exec {shlex.quote(str(self.python))} -c {shlex.quote(program)} "$@"'
            text = "\n".join(["#!/bin/sh", *settings, start, ""])
            command = self.python.with_name(name)
            if command.exists() and command.read_text(encoding="utf-8") != text:
                command.write_text(text, encoding="utf-8")

    def compile(self) -> None:
        """Compile the kernels, so that the first calibration need not wait for them.

        Nothing is lost if that fails: readable functions do their work.
        """
        say("compiling what is slow in Python (about a minute, once)")
        succeeds(self.python, "-m", "calibgui", "prepare", "--quiet", env=self.variables())

    def pip(self, *arguments: str) -> None:
        """Run pip; if nobody watches it work, only its messages on a failure are shown."""
        watched = sys.stdout.isatty()
        command = [str(self.python), *arguments, *([] if watched else ["--quiet"])]
        done = subprocess.run(
            command,
            cwd=ROOT,
            env=self.variables(),
            stderr=None if watched else subprocess.PIPE,
            text=True,
            check=False,
        )
        if done.returncode:
            print(done.stderr or "", end="", file=sys.stderr)
            raise SetupError(
                "pip could not install what is needed; its messages above say why. Without a "
                "network, point pip at an index that can be reached (PIP_INDEX_URL, or "
                "PIP_NO_INDEX and PIP_FIND_LINKS for a folder of wheels) and try again. If that "
                "lacks the versions of packaging/constraints, name an empty file in "
                "PIP_CONSTRAINT, and others are taken."
            )


def constraint_file() -> Path | None:
    """Return the file with the versions for this Python; None for none, or the user's own."""
    file = CONSTRAINTS / f"python{sys.version_info[0]}.{sys.version_info[1]}.txt"
    return None if os.environ.get("PIP_CONSTRAINT") or not file.exists() else file


# --- Debian packages ------------------------------------------------------------------------------


def missing_libraries(environment: Environment, purposes: set[str]) -> list[str]:
    """Return the Debian packages of the libraries for `purposes` that cannot be loaded."""
    if not LINUX or not purposes:
        return []
    text = (ROOT / "resources" / "system" / "debian-packages.txt").read_text(encoding="utf-8")
    rows = [line.split() for line in text.splitlines() if line and not line.startswith("#")]
    packages = {library: package for package, library, purpose in rows if purpose in purposes}
    lacking = output(base_python(), "-c", LACKING, *packages, env=environment.variables())
    return list(dict.fromkeys(packages[library] for library in lacking.split()))


def administrator() -> list[str] | None:
    """Return what to put before a command to give it root's rights; None if that cannot be."""
    if os.geteuid() == 0:
        return []
    return ["sudo", "-n"] if succeeds("sudo", "-n", "apt-get", "--version") else None


def agrees(packages: list[str], by_hand: str) -> bool:
    """Ask whether packages may be installed for the whole system; nobody there means no."""
    if not (sys.stdin and sys.stdin.isatty()):
        return False
    say(f"these Debian packages are missing: {' '.join(packages)}")
    question = f"Install them for the whole system with\n    {by_hand}\n(else they are unpacked in"
    try:
        return input(f"{question} the virtual environment)? [y/N] ").strip().lower() in ("y", "yes")
    except EOFError:
        return False


def provide(environment: Environment, packages: list[str], yes: bool = False) -> None:
    """Unpack Debian packages inside the environment, or install them if the user agrees."""
    if not packages:
        return
    command = ["apt-get", "install", "-y", "--no-install-recommends", *packages]
    by_hand = "sudo " + shlex.join(command)
    if not shutil.which("apt-get"):
        raise SetupError(
            f"please install your system's counterparts of the Debian packages {packages}"
        )
    prefix = administrator()
    if prefix is not None and (yes or agrees(packages, by_hand)):
        say(f"installing Debian packages: {' '.join(packages)}")
        settings = ["env", "DEBIAN_FRONTEND=noninteractive", "LC_ALL=C.UTF-8"]
        patience = ["-qq", "-o", "DPkg::Lock::Timeout=300"]
        succeeds(*prefix, *settings, "apt-get", "update", *patience)
        if succeeds(*prefix, *settings, *command, *patience):
            return
    elif unpack(environment, packages):
        say(f"unpacked in the environment. To install them for the whole system:\n    {by_hand}")
        return
    raise SetupError(
        f"missing Debian packages. Please give this command, then this one again:\n    {by_hand}"
    )


def unpack(environment: Environment, packages: list[str]) -> bool:
    """Unpack Debian packages and what they depend on inside the environment, with no rights."""
    say(f"unpacking Debian packages: {' '.join(packages)}")
    store = environment.debian / "apt"
    for folder in ("lists/partial", "cache/archives/partial"):
        (store / folder).mkdir(parents=True, exist_ok=True)
    private = ["-o", f"Dir::State::Lists={store / 'lists'}", "-o", f"Dir::Cache={store / 'cache'}"]
    # As root apt-get would download as another user, who may not write here.
    private += ["-o", "Debug::NoLocking=1", "-o", "APT::Sandbox::User=root"]
    options = [*private, "-qq", "-y", "--no-install-recommends"]
    done = (
        succeeds("apt-get", *options, "update")
        and succeeds("apt-get", *options, "--download-only", "install", *packages)
        and all(
            succeeds("dpkg-deb", "-x", archive, environment.debian)
            for archive in (store / "cache/archives").glob("*.deb")
        )
    )
    shutil.rmtree(store)
    fonts = environment.debian / "usr/share/fonts"
    if fonts.is_dir():
        environment.fonts.write_text(FONTS_CONF.format(escape(str(fonts))), encoding="utf-8")
    return done


# --- the commands ---------------------------------------------------------------------------------


def set_up(extra: str, purposes: set[str], yes: bool) -> Environment:
    """Return the environment with `extra` installed and the libraries for `purposes`.

    With `yes`, missing Debian packages are installed for the whole system without a question.
    """
    environment = Environment(place())
    held = environment.holds()
    if held is None:
        environment.begin()
        provide(environment, venv_package() + missing_libraries(environment, purposes), yes)
        environment.create()
        environment.install(extra)
        environment.lead_commands_to_libraries()
        environment.compile()
        return environment
    provide(environment, missing_libraries(environment, purposes), yes)
    if EXTRAS.index(extra) > EXTRAS.index(held):
        environment.install(extra)
    environment.lead_commands_to_libraries()
    return environment


def has_display() -> bool:
    return not LINUX or bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))


def run(yes: bool) -> int:
    """Open the window on the bundled sample, or calibrate the sample where there is none."""
    window = WINDOW.exists() and has_display()
    environment = set_up("gui" if window else "", {"qt", "window"} if window else set(), yes)
    env = environment.variables()
    if window:
        if succeeds(environment.python, "-c", OPENS_WINDOW, env=env):
            sample = str(ROOT / "resources" / "sample")
            return subprocess.call([environment.python, "-m", "calibgui.gui", sample], env=env)
        say("no window can be opened on this display; calibrating the sample without one")
    else:
        say("there is no display for the window; calibrating the sample without it")
    folder = Path.cwd() if os.access(Path.cwd(), os.W_OK) else Path.home()
    demo = ["demo", "-o", str(folder / "calibgui-demo")]
    code = subprocess.call([environment.python, "-m", "calibgui", *demo], env=env)
    if code == 0:
        program = shlex.quote(str(environment.python.with_name("calibgui")))
        say(f"to calibrate a camera of yours:\n    {program} calibrate PHOTOGRAPHS --square MM")
    return code


def test(arguments: list[str], yes: bool) -> int:
    """Run the test suite on all processors and return pytest's exit code."""
    environment = set_up("dev", {"qt"}, yes)
    env = {"QT_QPA_PLATFORM": "offscreen", **environment.variables()}
    # Each of the many processes that tests start would compile the whole program anew.
    env.pop("PYTHONDONTWRITEBYTECODE", None)
    cache = [] if os.access(ROOT, os.W_OK) else ["-p", "no:cacheprovider"]
    parallel = ["-n", "auto", "--maxprocesses", "8", "--dist", "worksteal"]
    command = [environment.python, "-m", "pytest", *parallel, *cache, *arguments]
    return subprocess.call(command, cwd=ROOT, env=env)


def main() -> int:
    hand_over_to_newer_python()
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("command", choices=["run", "test", "setup"])
    parser.add_argument(
        "--yes",
        action="store_true",
        help="install missing Debian packages for the whole system without asking, where the user "
        "may; otherwise they are unpacked in the virtual environment",
    )
    options, rest = parser.parse_known_args()
    if rest and options.command != "test":
        parser.error(f"{options.command} takes no further arguments")
    try:
        if options.command == "run":
            return run(options.yes)
        if options.command == "test":
            return test(rest, options.yes)
        set_up("dev", {"qt"}, options.yes)
    except (SetupError, OSError) as reason:
        print(f"calibgui: {reason}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130
    return 0


if __name__ == "__main__":
    sys.exit(main())
