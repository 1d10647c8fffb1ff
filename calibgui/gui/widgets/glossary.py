"""The window's terms, each explained in one plain sentence: for tooltips of headings and axes."""

from __future__ import annotations

import re

from PySide6.QtCore import QCoreApplication


def list_terms() -> dict[str, str]:
    """Return a sentence for each term, in the order in which a reader meets them."""
    translate = QCoreApplication.translate
    return {
        "fx": translate("glossary", "Focal length along the image's rows, in widths of a pixel."),
        "fy": translate(
            "glossary", "Focal length along the image's columns, in heights of a pixel."
        ),
        "cx": translate(
            "glossary", "Column of the principal point, where the lens's axis meets it, px."
        ),
        "cy": translate(
            "glossary", "Row of the principal point, where the lens's axis meets it, px."
        ),
        "skew": translate(
            "glossary", "Lean of the pixel's columns, px; 0 for every sensor of today."
        ),
        "k1": translate(
            "glossary", "First coefficient of the radial distortion, of the lowest power."
        ),
        "k2": translate("glossary", "Second coefficient of the radial distortion."),
        "k3": translate("glossary", "Third coefficient of the radial distortion."),
        "p1": translate(
            "glossary", "Decentering distortion, of a lens whose elements are out of line."
        ),
        "p2": translate(
            "glossary", "Decentering distortion, of a lens whose elements are out of line."
        ),
        "p3": translate(
            "glossary", "Growth of the decentering distortion with the radius squared."
        ),
        "± 1σ": translate(
            "glossary",
            "The value with its standard deviation: two times in three it is so far off or less.",
        ),
        "1σ": translate(
            "glossary", "Standard deviation: two times in three a value is so far off or less."
        ),
        translate("glossary", "in σ"): translate(
            "glossary", "A difference in standard deviations: more than 3 is hardly chance."
        ),
        translate("glossary", "SD of Table 2"): translate(
            "glossary",
            "The standard deviation as the paper computes it, which leaves the size of the "
            "residuals out.",
        ),
        "RMS": translate(
            "glossary",
            "Root mean square: the typical length of the residuals, in which large ones "
            "count most.",
        ),
        translate("glossary", "residual"): translate(
            "glossary", "What a corner was measured at, less where camera and board put it."
        ),
        "Δu": translate(
            "glossary", "Residual along the image's rows: measured less predicted column."
        ),
        "Δv": translate(
            "glossary", "Residual along the image's columns: measured less predicted row."
        ),
        "e": translate("glossary", "Length of a residual in the image."),
        translate("glossary", "reference px"): translate(
            "glossary",
            "The paper's unit on the board: a square has 30 of them, whatever its size in "
            "the image.",
        ),
        "Δx′": translate(
            "glossary", "Residual along the board's rows, on the paper's reference plane."
        ),
        "Δy′": translate(
            "glossary", "Residual along the board's columns, on the paper's reference plane."
        ),
        "e′": translate(
            "glossary",
            "Length of a residual on the paper's reference plane, where a square has 30 px.",
        ),
        translate("glossary", "aspect ratio"): translate(
            "glossary", "Width of a pixel over its height, fy over fx; 1 for square pixels."
        ),
        "g(r)": translate(
            "glossary",
            "The paper's equation of cosines: where it is 0, r is the aspect ratio that one "
            "view gives by itself.",
        ),
        translate("glossary", "cost c"): translate(
            "glossary", "The mean squared residual that the calibration makes as small as it can."
        ),
        translate("glossary", "iteration"): translate(
            "glossary", "One improvement of all parameters together."
        ),
        translate("glossary", "density"): translate(
            "glossary",
            "Share of the residuals for each px of their length, so that all bars have area 1.",
        ),
        translate("glossary", "distance"): translate(
            "glossary", "Distance from the camera to the middle of the board."
        ),
        translate("glossary", "tilt"): translate(
            "glossary",
            "Angle between the board and the image plane; 0 if the camera looks straight at it.",
        ),
        translate("glossary", "displacement d"): translate(
            "glossary",
            "How far the lens moves the image of a point from where a pinhole would put it.",
        ),
        translate("glossary", "one σ, worst direction"): translate(
            "glossary",
            "How uncertain the image of a point is along the direction in which that is worst.",
        ),
        translate("glossary", "correlated errors"): translate(
            "glossary",
            "Errors of neighbouring corners that point the same way, so that many corners "
            "tell less than their number.",
        ),
        translate("glossary", "share errors"): translate(
            "glossary",
            "Of corners: neighbours are off alike, so that many tell less than their number.",
        ),
        translate("glossary", "unseen views"): translate(
            "glossary",
            "Views that were left out of a calibration, to see how well it predicts them.",
        ),
        "BIC": translate(
            "glossary",
            "Bayesian information criterion: misfit plus a price for each parameter; the "
            "least is best.",
        ),
        "u": translate("glossary", "Column of a pixel: 0 at the middle of the leftmost one."),
        "v": translate(
            "glossary", "Row of a pixel: 0 at the middle of the topmost one, growing downwards."
        ),
    }


def explain(text: str) -> str:
    """Explain the terms in a heading or label, a line each; empty if there are none."""
    found: dict[str, str] = {}
    rest = text
    terms = {term: tip for term, tip in list_terms().items() if term.lower() in text.lower()}
    for term in sorted(terms, key=len, reverse=True):  # "± 1σ" before "1σ"
        pattern = rf"(?<![\w′]){re.escape(term)}(?![\w′])"
        if re.search(pattern, rest, re.IGNORECASE if len(term) > 3 else 0):
            found[term] = terms[term]
            rest = re.sub(pattern, " ", rest, flags=re.IGNORECASE if len(term) > 3 else 0)
    return "\n".join(f"{term}: {sentence}" for term, sentence in found.items())
