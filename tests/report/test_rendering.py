"""Reports as HTML and PDF: complete, the same each time, and readable anywhere."""

from __future__ import annotations

import hashlib
import json
import re
import shutil
import subprocess
from collections.abc import Iterator
from dataclasses import asdict, replace
from datetime import date
from html import unescape
from pathlib import Path

import numpy as np
import PIL.Image
import pytest

from calibgui.app.outputs.report_files import ReportStyle, format_command, write_report
from calibgui.dataset import Result
from calibgui.dataset.details import Details
from calibgui.dataset.limits import LengthLimit, Limits
from calibgui.engine.errors import CalibrationError
from calibgui.formats.result_json import encode_result, read_result
from calibgui.report.calibration_report import Layout
from calibgui.report.document import Document, Facts, Mood, Section, Table
from calibgui.report.rendering import render_html, render_pdf
from calibgui.report.report_tables import tabulate_parameters
from tests.engine import scenes
from tests.formats.conftest import solved

DETAILS = Details(
    operator="Zoë Łukasiewicz", place="Ĝenève, Αθήνα", customer="Завод № 7", remarks="<b>&x</b>"
)
ISSUED = date(2026, 3, 1)


@pytest.fixture(scope="module")
def judged() -> Result:
    """A result with limits of which one is broken, and a board of known scale."""
    result = solved(scenes.barrel())
    assert result.board is not None
    limits = Limits(fewest_views=99, length=LengthLimit(5.0, 50.0, 600.0), name="example")
    board = replace(result.board, square_sigma=0.02)
    # Not every computer has a font for the names of these photographs.
    views = tuple(replace(view, image=view.image.replace("日本", "")) for view in result.views)
    return replace(result, limits=limits, board=board, views=views)


@pytest.fixture(scope="module")
def pdf(judged: Result, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The report as PDF."""
    pytest.importorskip("typst", reason="the extra report is not installed")
    file = tmp_path_factory.mktemp("report") / "report.pdf"
    write_report(judged, file, DETAILS, issued=ISSUED)
    return file


def run(program: str, *arguments: str | Path) -> str:
    """Return what a program of poppler-utils prints."""
    if shutil.which(program) is None:
        pytest.skip(f"no {program}: install poppler-utils")
    done = subprocess.run([program, *map(str, arguments)], capture_output=True, check=True)
    return done.stdout.decode()


def squeeze(text: str) -> str:
    """Return a text without any white space, soft hyphens and the like."""
    return re.sub(r"[\s\u200b\u00ad]+", "", text)


def list_numbers(result: Result) -> Iterator[str]:
    """Yield numbers of result.json as they have to be printed: sigma has two digits."""
    content = json.loads(json.dumps(encode_result(result), default=np.ndarray.tolist))
    camera = content["camera"]
    for name, value in camera["params"].items():
        sigma = camera["sigma"][name]
        if sigma and sigma > 1e-3:
            decimals = 1 - int(np.floor(np.log10(float(f"{sigma:.1e}"))))
            yield f"{value:.{max(decimals, 0)}f}"
            yield f"{sigma:.{max(decimals, 0)}f}"
    for view in content["views"]:
        if view["tvec_mm"] is None:
            continue
        yield f"{view['rms_px']:.3f}px"
        for value, sigma in zip(view["tvec_mm"], view["sigma_tvec_mm"], strict=True):
            decimals = 1 - int(np.floor(np.log10(float(f"{sigma:.1e}"))))
            yield f"{value:.{decimals}f}±{sigma:.{decimals}f}"
    yield f"{content['residuals']['rms_px']:.4f}px"
    yield f"{content['residuals']['count']:,}"
    yield content["inputs_sha256"]


def test_every_number_stands_in_the_pdf(judged: Result, pdf: Path) -> None:
    text = squeeze(run("pdftotext", "-layout", pdf, "-"))
    numbers = list(list_numbers(judged))
    assert len(numbers) > 25
    assert [number for number in numbers if squeeze(number) not in text] == []
    for words in (
        "ZoëŁukasiewicz",
        "Ĝenève,Αθήνα",
        "Завод№7",
        "FAIL:example",
        "25mm" * 0 + "page1of",
    ):
        assert words in text, words


def test_the_pdf_has_its_fonts_and_the_result(judged: Result, pdf: Path, tmp_path: Path) -> None:
    rows = run("pdffonts", pdf).splitlines()[2:]
    assert rows and all(row.split()[-5] == "yes" for row in rows), rows
    run("pdfdetach", "-saveall", "-o", tmp_path, pdf)
    attached = read_result(tmp_path / "result.json")
    assert attached.calibration.camera.params.tolist() == judged.calibration.camera.params.tolist()
    assert attached.limits == judged.limits
    assert b"pdfaid" in pdf.read_bytes() or "PDF/A" in run("pdfinfo", pdf)


def test_two_runs_differ_in_nothing_but_the_date(judged: Result, pdf: Path, tmp_path: Path) -> None:
    for name in ("again.pdf", "one.html", "two.html"):
        write_report(judged, tmp_path / name, DETAILS, issued=ISSUED)
    assert (tmp_path / "again.pdf").read_bytes() == pdf.read_bytes()
    assert (tmp_path / "one.html").read_bytes() == (tmp_path / "two.html").read_bytes()
    write_report(judged, tmp_path / "later.html", DETAILS, issued=date(2027, 4, 2))
    later = (tmp_path / "later.html").read_text(encoding="utf-8")
    later = later.replace("2027-04-02", "2026-03-01").replace("20270402", "20260301")
    assert later == (tmp_path / "one.html").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("paper", "size"), [("a4", "595.276 x 841.89"), ("us-letter", "612 x 792")]
)
def test_paper_has_its_size(judged: Result, paper: str, size: str, tmp_path: Path) -> None:
    pytest.importorskip("typst", reason="the extra report is not installed")
    style = ReportStyle(Layout.CERTIFICATE, paper)
    write_report(judged, tmp_path / "c.pdf", DETAILS, style, issued=ISSUED)
    assert size in run("pdfinfo", tmp_path / "c.pdf")
    assert len(run("pdftotext", tmp_path / "c.pdf", "-").split("\f")) > 2


def test_the_certificate_states_what_the_standard_asks(judged: Result, tmp_path: Path) -> None:
    details = replace(DETAILS, laboratory="Optical Lab", signatory="N. N.", board_certificate="B-1")
    style = ReportStyle(Layout.CERTIFICATE)
    write_report(judged, tmp_path / "c.html", details, style, issued=ISSUED)
    page = unescape((tmp_path / "c.html").read_text(encoding="utf-8"))
    for words in (
        "Optical Lab",
        "Завод № 7",
        "relate only to the item",
        "coverage factor k = 2",
        "B-1",
        "Statement of conformity",
        "Authorised by: N. N.",
        "No interval of recalibration is recommended",
        "degrees of freedom",
    ):
        assert words in page, words
    assert "accredit" not in page.lower()


def test_html_stands_by_itself(judged: Result, tmp_path: Path) -> None:
    write_report(judged, tmp_path / "r.html", DETAILS, issued=ISSUED)
    page = (tmp_path / "r.html").read_text(encoding="utf-8")
    assert len(page.encode()) < 3_000_000
    assert "<script" not in page and "<link" not in page and "@import" not in page
    addresses = re.findall(r"""(?:src|href|url)\s*[=(]\s*["']?([^"')\s>]+)""", page)
    assert addresses and all(a.startswith(("#", "data:")) for a in addresses)
    assert "&lt;b&gt;&amp;x&lt;/b&gt;" in page
    text = squeeze(unescape(re.sub(r"<[^>]*>", " ", page)))
    assert [number for number in list_numbers(judged) if squeeze(number) not in text] == []


def test_a_users_template_gets_the_same_record(judged: Result, tmp_path: Path) -> None:
    template = tmp_path / "mine.html"
    template.write_text("{{ document.title }}|{{ document.sections | length }}|{{ mark }}")
    style = ReportStyle(template=template)
    write_report(judged, tmp_path / "r.html", DETAILS, style, issued=ISSUED)
    assert (tmp_path / "r.html").read_text().startswith("Camera calibration|12|")
    for wrong in ("{{ document.nothing }}", "{% if %}", "{{ mark.__class__.__mro__ }}"):
        template.write_text(wrong)
        with pytest.raises(CalibrationError, match=r"mine\.html cannot be rendered"):
            write_report(judged, tmp_path / "r.html", DETAILS, style)
    pytest.importorskip("typst", reason="the extra report is not installed")
    template = tmp_path / "mine.typ"
    template.write_text('#let doc = json("document.json")\n#doc.title by mine')
    write_report(judged, tmp_path / "r.pdf", style=ReportStyle(template=template))
    assert "Camera calibration by mine" in run("pdftotext", tmp_path / "r.pdf", "-")
    template.write_text("#nothing")
    with pytest.raises(CalibrationError, match="unknown variable: nothing"):
        write_report(judged, tmp_path / "r.pdf", style=ReportStyle(template=template))


def test_texts_are_texts_in_every_format(tmp_path: Path) -> None:
    """What markup means to jinja2 and typst is printed as it is."""
    odd = "#let x = 1 *bold* _low_ $x$ <a> {{ y }} \\ @ref"
    document = Document(
        title=odd,
        subtitle="",
        id="1",
        issued="2026-03-01",
        mood=Mood.GOOD,
        headline=odd,
        reason=odd,
        stamp="",
        stamp_mood=Mood.GOOD,
        tiles=(),
        sections=(Section(odd, (Facts(((odd, odd),)), Table((odd,), ((odd,),)))),),
        footer=odd,
    )
    page = render_html(document, "mark", "a4")
    assert unescape(page).count(odd) == 10 and "<a>" not in page
    pytest.importorskip("typst", reason="the extra report is not installed")
    (tmp_path / "odd.pdf").write_bytes(render_pdf(document, b"{}", "mark", "a4"))
    text = squeeze(run("pdftotext", "-layout", tmp_path / "odd.pdf", "-"))
    assert text.count(squeeze(odd)) >= 7
    assert json.dumps(asdict(document))


def test_other_suffixes_are_refused(judged: Result, tmp_path: Path) -> None:
    with pytest.raises(CalibrationError, match="not named as a report") as caught:
        write_report(judged, tmp_path / "r.docx")
    assert ".html or .pdf" in caught.value.hint


def test_the_command_names_what_was_asked(judged: Result) -> None:
    command = format_command(judged)
    assert command.startswith("calibgui calibrate")
    for words in (
        "--board 6x8",
        "--square 30+-0.02",
        "--as-asked --cost image --model lucchese",
        "--exclude",
    ):
        assert words in command, words


def test_letters_without_a_font_are_named_and_not_printed_as_boxes(
    judged: Result, tmp_path: Path
) -> None:
    pytest.importorskip("typst", reason="the extra report is not installed")
    unknown = "\U0001343c"  # a joiner of hieroglyphs, for which hardly anybody has a font
    with pytest.raises(CalibrationError, match="could not be displayed") as caught:
        write_report(judged, tmp_path / "r.pdf", replace(DETAILS, place=unknown))
    assert "install fonts" in caught.value.hint


def test_the_expanded_uncertainty_is_twice_the_standard_one(judged: Result) -> None:
    (_, table) = tabulate_parameters(judged)
    assert isinstance(table, Table)
    sigmas = dict(
        zip(judged.calibration.camera.names, judged.calibration.sigma.tolist(), strict=True)
    )
    rows = [row for row in table.rows if row[2] not in ("held", "undetermined")]
    assert len(rows) >= 8
    for name, _, u, expanded, _ in rows:
        digits, _, power = u.partition("e")
        last_place = 10.0 ** (int(power or 0) - len(digits.partition(".")[2]))
        assert float(u) == pytest.approx(sigmas[name], abs=0.51 * last_place)
        assert float(expanded) == pytest.approx(2 * sigmas[name], abs=0.51 * last_place)


def test_photographs_tell_of_camera_and_date(judged: Result, tmp_path: Path) -> None:
    exif = PIL.Image.Exif()
    exif[0x010F], exif[0x0110] = "Canon", "Canon EOS R5"
    exif.get_ifd(0x8769)[0x9003] = "2026:02:03 10:20:30"
    PIL.Image.new("L", (64, 48), 128).save(tmp_path / "a.jpg", exif=exif)
    views = (replace(judged.views[0], image="a.jpg"), *judged.views[1:])
    write_report(replace(judged, views=views), tmp_path / "r.html", folder=tmp_path, issued=ISSUED)
    page = (tmp_path / "r.html").read_text(encoding="utf-8")
    digest = hashlib.sha256((tmp_path / "a.jpg").read_bytes()).hexdigest()
    for words in ("<dd>Canon EOS R5</dd>", "<dd>2026-02-03</dd>", digest, "data:image/jpeg"):
        assert words in page, words


@pytest.mark.slow
def test_a_browser_prints_the_page_whole(judged: Result, tmp_path: Path) -> None:
    if (browser := shutil.which("chromium") or shutil.which("google-chrome")) is None:
        pytest.skip("no chromium")
    write_report(judged, tmp_path / "r.html", DETAILS, issued=ISSUED)
    without_network = ("--headless", "--no-sandbox", "--host-resolver-rules=MAP * ~NOTFOUND")
    subprocess.run(
        [
            browser,
            *without_network,
            f"--user-data-dir={tmp_path / 'profile'}",
            "--no-pdf-header-footer",
            f"--print-to-pdf={tmp_path / 'r.pdf'}",
            (tmp_path / "r.html").as_uri(),
        ],
        check=True,
        capture_output=True,
        timeout=120,
    )
    text = squeeze(run("pdftotext", tmp_path / "r.pdf", "-"))
    missing = [number for number in list_numbers(judged) if squeeze(number) not in text]
    assert missing == []
    # A figure that is cut by a page's end would stand on two.
    assert text.count("RMSoftheresidualsineachview") == 1
