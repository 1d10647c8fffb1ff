"""The pages of a fleet: read as HTML, every figure in them is the ledger's."""

from __future__ import annotations

import re
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote

import numpy as np
import pytest

from calibgui.cli.main import main
from calibgui.dataset.fleet import (
    Change,
    Estimate,
    FleetCamera,
    FleetEntry,
    FleetFigures,
    FleetStatus,
)
from calibgui.engine.assessment import Grade, PixelError
from calibgui.formats.fleet_ledger import open_ledger
from calibgui.report.fleet_figures import Measured, draw_history, make_histogram
from calibgui.report.fleet_overview import make_overview
from calibgui.report.fleet_page import FleetPages

Capture = pytest.CaptureFixture[str]
OUTLIER, BAD_NAME = "odd one", '<script>alert("x")</script> & Ärger'
NAMES = ("fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3", "skew")


class Page(HTMLParser):
    """Text, tables, links and plots of a page; every element that is opened must be closed."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tables: list[list[list[str]]] = []
        self.links: list[tuple[str, str]] = []
        self.text, self.plots, self.scripts = "", 0, 0
        self._open: list[str] = []
        self.feed(text)
        self.close()
        assert not self._open

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.scripts += tag == "script"
        self.plots += tag == "svg"
        if tag == "table":
            self.tables.append([])
        elif tag == "tr":
            self.tables[-1].append([])
        elif tag in ("td", "th"):
            self.tables[-1][-1].append("")
        elif tag == "a":
            self.links.append((dict(attrs)["href"] or "", ""))
        if tag != "meta":
            self._open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        pass

    def handle_endtag(self, tag: str) -> None:
        assert self._open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.text += data
        if {"td", "th"} & set(self._open):
            self.tables[-1][-1][-1] += data
        if "a" in self._open:
            self.links[-1] = (self.links[-1][0], self.links[-1][1] + data)

    def find_table(self, *head: str) -> list[list[str]]:
        """The rows of the table whose first headings these are."""
        (rows,) = [t[1:] for t in self.tables if tuple(t[0][: len(head)]) == head]
        return rows


def make_figures(rng: np.random.Generator, k1: float = -0.2) -> FleetFigures:
    f = 650 + rng.normal(0, 1)
    values = [f, f, *rng.normal([320, 240], 2), k1 + rng.normal(0, 0.002), 0.05, 0, 0, 0, 0]
    sigmas = [0.3, 0.3, 0.4, 0.4, 0.001, 0.003, 1e-4, 1e-4, 0, 0]
    estimates = (Estimate(float(v), s) for v, s in zip(values, sigmas, strict=True))
    return FleetFigures(
        size=(640, 480),
        board="checkerboard 6x7, 30 mm",
        lens_model="brown-conrady",
        views=int(rng.integers(8, 13)),
        corners=460,
        rms=float(rng.uniform(0.05, 0.15)),
        noise=0.055,
        coverage=float(rng.uniform(0.5, 1.0)),
        grade=Grade.USABLE,
        reason="Nothing is wrong.",
        times_better=1.0,
        error=PixelError(0.01, float(rng.uniform(0.02, 0.2)), float("inf"), 0.1, 0.03, 0.09),
        parameters=dict(zip(NAMES, estimates, strict=True)),
    )


@pytest.fixture(scope="module")
def fleet() -> list[FleetCamera]:
    """Thirty cameras: two outliers, one that has changed, one that fails, one without a result."""
    rng = np.random.default_rng(5)
    cameras = [
        FleetCamera(
            FleetEntry(f"camera {k:02d}", f"S{k % 20:02d}", f"2026-0{1 + k // 20}-01", 20.5),
            FleetStatus.DONE,
            photographs=12,
            figures=make_figures(rng),
            result=f"fleet.results/camera {k}#.json",
            versions={"calibgui": "0.1.0"},
        )
        for k in range(30)
    ]
    cameras[7] = replace(
        cameras[7],
        entry=FleetEntry(OUTLIER, "S07", "2026-01-01"),
        figures=make_figures(rng, k1=-0.15),
    )
    cameras[3] = replace(cameras[3], figures=make_figures(rng, k1=-0.17))
    changed = Change("camera 05", "ab", 0.412, 0.923, 0.031, 2e-7)
    cameras[25] = replace(cameras[25], change=changed)
    unchanged = Change("camera 06", "ab", 0.021, 0.043, 0.031, 0.71)
    cameras[26] = replace(cameras[26], change=unchanged)
    cameras[11] = replace(
        cameras[11], failures=("The edge is known to 0.2 px, beyond the limit of 0.1 px.",)
    )
    refused = "The board was found in none of the images."
    cameras.append(
        FleetCamera(
            FleetEntry(BAD_NAME),
            FleetStatus.REFUSED,
            refused,
            "Photograph the whole board.",
            failures=(refused,),
        )
    )
    return sorted(cameras, key=lambda camera: camera.id)


@pytest.fixture(scope="module")
def page(fleet: list[FleetCamera], tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("fleet")
    with open_ledger(folder / "fleet.db", create=True) as ledger:
        ledger.write(fleet)
    assert main(["fleet", str(folder / "fleet.db"), "-o", str(folder / "page.html"), "-q"]) == 0
    return folder / "page.html"


def test_every_figure_is_the_ledgers(page: Path, fleet: list[FleetCamera]) -> None:
    rows = Page(page.read_text()).find_table("Camera", "Serial number", "Date", "Verdict")
    assert [row[0] for row in rows] == [camera.id for camera in fleet]
    for row, camera in zip(rows, fleet, strict=True):
        _, serial, date, verdict, grade, views, rms, edge, coverage, *_, changed = row
        assert (serial, date) == (camera.entry.serial, camera.entry.date)
        assert verdict == ("pass" if camera.passed else "fail")
        if (found := camera.figures) is not None:
            assert (grade, int(views)) == (found.grade, found.views)
            assert float(rms) == pytest.approx(found.rms, abs=5e-4)
            assert float(edge) == pytest.approx(found.error.edge, abs=5e-4)
            assert coverage == f"{found.coverage:.0%}"
        assert changed == (f"{camera.change.rms:.3f}" if camera.change else changed.strip("0.9"))


def test_the_camera_that_is_unlike_the_others_is_first(
    page: Path, fleet: list[FleetCamera]
) -> None:
    rows = Page(page.read_text()).find_table(
        "Camera", "Serial number", "Date", "Difference [px rms]"
    )
    assert [row[0] for row in rows[:2]] == [OUTLIER, "camera 03"], "which comes first by its name"
    overview = make_overview(fleet)
    assert float(rows[0][5]) == pytest.approx(overview.outliers[0].z, abs=0.05)
    assert overview.outliers[0].z > 10
    assert len(overview.outliers) < 5


def with_error(camera: FleetCamera, error: PixelError) -> FleetCamera:
    assert camera.figures is not None
    return replace(camera, figures=replace(camera.figures, error=error))


def test_what_a_camera_does_not_know_of_itself_makes_it_no_outlier(
    fleet: list[FleetCamera],
) -> None:
    (place,) = [k for k, camera in enumerate(fleet) if camera.id == OUTLIER]
    known, poor, none = (PixelError(*[px] * 6) for px in (0.3, 5.0, float("inf")))
    for error, is_outlier, is_compared in (
        (known, True, True), (poor, False, True), (none, False, False),
    ):  # fmt: skip
        cameras = [*fleet[:place], with_error(fleet[place], error), *fleet[place + 1 :]]
        overview = make_overview(cameras)
        assert overview.placed[place].is_outlier is is_outlier
        assert (overview.placed[place] not in overview.undetermined) is is_compared
        page = FleetPages(overview, "fleet", "cameras", "fleet.html", {}).make_first()
        assert ("do not determine them" in page) is not is_compared


def test_failures_and_changes_are_listed_with_their_reasons(page: Path) -> None:
    read = Page(page.read_text())
    why = {row[0]: row[3] for row in read.find_table("Camera", "Serial number", "Date", "Why")}
    assert why == {
        "camera 11": "The edge is known to 0.2 px, beyond the limit of 0.1 px.",
        BAD_NAME: "The board was found in none of the images.",
    }
    (row,) = read.find_table("Camera", "Serial number", "Date", "Against")
    assert row[3:] == ["camera 05", "0.412", "0.923", "0.031", "2e-07"]


def test_names_are_text_and_nothing_is_fetched(page: Path) -> None:
    text = page.read_text()
    read = Page(text)
    assert BAD_NAME in read.text and not read.scripts
    assert not re.search(r"(src=|url\(|@import|https?://)", text)
    assert "prefers-color-scheme: dark" in text


def test_each_camera_has_its_page_a_click_away(page: Path, fleet: list[FleetCamera]) -> None:
    links = dict(reversed([(name, href) for href, name in Page(page.read_text()).links]))
    assert len({links[camera.id] for camera in fleet}) == len(fleet)
    for camera in fleet:
        own = Page((page.parent / unquote(links[camera.id])).read_text())
        assert camera.id in own.text
        back, *_ = ((page.parent / unquote(links[camera.id])).parent / own.links[0][0],)
        assert back.resolve() == page.resolve()
        if (found := camera.figures) is None:
            assert "Photograph the whole board." in own.text
            continue
        values = {row[0]: row[1] for row in own.find_table("Parameter")}
        for name, estimate in found.parameters.items():
            value = float(values[name].removeprefix("held at ").partition(" ")[0].strip("("))
            if "e" not in values[name]:
                assert value == pytest.approx(estimate.value, abs=max(estimate.sigma, 1e-9))
        assert own.plots >= 9, "a histogram for each quantity"
        (address,) = [href for href, name in own.links if name == "result.json"]
        target = (page.parent / unquote(links[camera.id])).parent / unquote(address)
        assert target.resolve() == (page.parent / camera.result).resolve()


def test_a_page_of_another_program_is_not_replaced(page: Path, tmp_path: Path) -> None:
    (tmp_path / "mine.html").write_text("<html>mine</html>")
    ledger = page.parent / "fleet.db"
    assert main(["fleet", str(ledger), "-o", str(tmp_path / "mine.html"), "-q"]) != 0
    assert (tmp_path / "mine.html").read_text() == "<html>mine</html>"
    assert main(["fleet", str(ledger), "-o", str(page), "-q"]) == 0, "its own page it replaces"


def test_cameras_are_compared_with_their_kind_only(fleet: list[FleetCamera]) -> None:
    small = [
        replace(camera, figures=replace(camera.figures, size=(320, 240)))
        for camera in fleet[:6]
        if camera.figures is not None
    ]
    undetermined = replace(fleet[8].figures, parameters={"fx": Estimate(650.0, float("nan"))})
    overview = make_overview([*small, *fleet[6:], replace(fleet[8], figures=undetermined)])
    assert [size for size, _ in overview.kinds] == [(640, 480), (320, 240)]
    assert len(overview.kinds[(320, 240), "brown-conrady"]) == len(small)
    assert np.isnan(overview.placed[-1].difference)


def test_a_histogram_counts_every_value() -> None:
    rng = np.random.default_rng(0)
    values = [*rng.normal(10, 1, 300).tolist(), 1e6, float("nan"), float("inf")]
    histogram = make_histogram(values, "x")
    assert histogram is not None
    counts = [int(n) for n in re.findall(r"<title>(\d+) from", histogram.draw())]
    assert sum(counts) == 300
    assert "1 beyond, 2 unknown" in histogram.draw()
    assert histogram.draw(11.0).count('class="mark"') == 1
    assert make_histogram([float("nan")], "x") is None


def test_a_history_needs_two_dates() -> None:
    points = [Measured(f"2026-0{k}-01", 1.0 * k, 0.1, k < 3, "<a>") for k in (1, 2, 3)]
    drawn = draw_history(points, "fx")
    assert drawn.count("<circle") == 3 and drawn.count('class="bad"') == 1
    assert "&lt;a&gt;" in drawn and draw_history(points[:1], "fx") == ""
