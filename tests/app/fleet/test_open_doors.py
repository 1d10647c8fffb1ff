"""Doors of a batch: while it works on this machine, no other user reaches any process of it."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from pathlib import Path
from typing import NamedTuple

import pytest

from calibgui.app.fleet import schedulers

pytestmark = [
    pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc"),
    pytest.mark.slow,
]

_LISTENS = "0A"
"""State of a TCP socket that waits for connections."""
_ACCEPTS = 1 << 16
"""Flag of a Unix socket that does."""
_STRANGER = """
import os, socket, sys
"".encode("idna")  # what is loaded later may not be read then
os.setgroups([]), os.setgid(65534), os.setuid(65534)
for door in sys.argv[1:]:
    try:
        if door.startswith("/proc/"):
            os.close(os.open(door, os.O_RDWR | os.O_NONBLOCK))
        else:
            host, _, port = door.rpartition(":")
            socket.create_connection((host, int(port)), 5).close()
    except OSError:
        continue
    print(door)
"""
"""A program that gives up all rights, and prints which of the doors that it is told of it opens."""


class Seen(NamedTuple):
    """What was seen of a batch while it ran."""

    processes: set[int]
    listening: set[str]
    """Sockets on which one of the processes waits for connections."""
    entered: set[str]
    """Doors that another user could open."""


def list_family(parent: int) -> set[int]:
    """Return the numbers of a process and of all that come from it."""
    parents = {}
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            stat = (folder / "stat").read_text()
        except OSError:
            continue
        parents[int(folder.name)] = int(stat.rpartition(")")[2].split()[1])
    family = {parent}
    while more := {child for child, of in parents.items() if of in family} - family:
        family |= more
    return family


def list_descriptors(process: int) -> dict[str, str]:
    """Return what the descriptors of a process lead to, by their paths in /proc."""
    found = {}
    for entry in Path(f"/proc/{process}/fd").iterdir():
        try:
            found[str(entry)] = str(entry.readlink())
        except OSError:  # closed meanwhile
            continue
    return found


def list_listening(process: int, targets: set[str]) -> set[str]:
    """Return the sockets of a process on which it waits for connections, or for datagrams."""
    found = set()
    for kind in ("tcp", "tcp6", "udp", "udp6"):
        for line in Path(f"/proc/{process}/net/{kind}").read_text().splitlines()[1:]:
            cells = line.split()
            waits = cells[3] == _LISTENS or kind.startswith("udp")
            if waits and f"socket:[{cells[9]}]" in targets:
                host = "::1" if kind.endswith("6") else "127.0.0.1"
                found.add(f"{host}:{int(cells[1].rpartition(':')[2], 16)}")
    for line in Path(f"/proc/{process}/net/unix").read_text().splitlines()[1:]:
        cells = line.split()
        if int(cells[3], 16) & _ACCEPTS and f"socket:[{cells[6]}]" in targets:
            found.add(" ".join(cells[7:]) or "a Unix socket without a name")
    return found


def try_doors(doors: set[str]) -> set[str]:
    """Return those of the doors that a user without any rights can open."""
    done = subprocess.run(
        [sys.executable, "-I", "-c", _STRANGER, *sorted(doors)],
        capture_output=True,
        text=True,
        check=True,
    )
    return set(done.stdout.split())


def watch(command: list[str]) -> Seen:
    """Run a command; look at its processes until it ends."""
    seen = Seen(set(), set(), set())
    tried: set[str] = set()
    with subprocess.Popen(command, stdout=subprocess.DEVNULL) as driver:
        while driver.poll() is None:
            doors = set()
            for process in list_family(driver.pid):
                try:
                    descriptors = list_descriptors(process)
                    listening = list_listening(process, set(descriptors.values()))
                except OSError:  # it has ended
                    continue
                seen.processes.add(process)
                seen.listening.update(listening)
                pipes = {path for path, to in descriptors.items() if to.startswith("pipe:")}
                doors |= {door for door in listening if ":" in door} | pipes
            if os.geteuid() == 0 and doors - tried:
                seen.entered.update(try_doors(doors - tried))
                tried |= doors
            time.sleep(0.1)
    assert driver.returncode == 0
    return seen


def test_nobody_can_reach_a_batch_on_this_machine(fleet: Path, tmp_path: Path) -> None:
    assert schedulers.has_dask(), "it would prove nothing"
    command = [sys.executable, "-m", "calibgui", "batch", str(fleet), "--workers", "2"]
    command += ["-o", str(tmp_path / "fleet.db"), "--square", "30", "--board", "6x7"]
    seen = watch(command)
    assert len(seen.processes) >= 3, "the driver and two workers"
    assert (seen.listening, seen.entered) == (set(), set())
