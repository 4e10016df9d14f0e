"""Plots of rows as SVG that takes the page's colours."""

from __future__ import annotations

import io
import re

import matplotlib as mpl

mpl.use("Agg")

import matplotlib.pyplot as plt

from .row import Curve, Plot

INK, REFERENCE, RESULT = "#222222", "#0072b2", "#d55e00"
"""Of words and axes, of references, of results: two colours that every eye tells apart (Okabe & Ito 2008)."""
STYLE = {
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans"],
    "font.size": 8.0,
    "axes.prop_cycle": mpl.cycler(color=[REFERENCE, RESULT, "#009e73", "#cc79a7", "#e69f00"]),
    "axes.edgecolor": INK,
    "axes.labelcolor": INK,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.formatter.limits": (-3, 4),
    "axes.formatter.useoffset": False,
    "legend.frameon": False,
    "legend.fontsize": 7.0,
    "text.color": INK,
    "xtick.color": INK,
    "ytick.color": INK,
    "svg.fonttype": "none",
    "savefig.dpi": 200,
}
PAGE_COLOURS = {INK: "currentColor", REFERENCE: "var(--reference)", RESULT: "var(--result)"}
SIZE = (3.4, 2.3)
"""Inches of a plot."""


def svg(plot: Plot, name: str) -> str:
    """A plot as an SVG element for a page, without ids that another plot may have, nor addresses."""
    with mpl.rc_context({**STYLE, "svg.hashsalt": name}):
        figure, axes = plt.subplots(figsize=SIZE, layout="constrained")
        plot(axes)
        if isinstance(plot, Curve):
            axes.legend()
        file = io.StringIO()
        figure.savefig(file, format="svg", transparent=True, metadata={"Date": None})
        plt.close(figure)
    text = file.getvalue()
    text = text[text.index("<svg") :]
    text = re.sub(r"<metadata>.*?</metadata>", "", text, flags=re.DOTALL)
    text = re.sub(r' xmlns(:xlink)?="[^"]*"', "", text).replace("xlink:href", "href")
    text = re.sub(r' id="[a-zA-Z0-9.]+_\d+"', "", text)
    text = re.sub(r'(<svg[^>]*?) width="[^"]*"', r"\1", text)
    text = re.sub(r'(<svg[^>]*?) height="[^"]*"', r"\1", text)
    for colour, of_page in PAGE_COLOURS.items():
        text = text.replace(colour, of_page)
    return text.strip()
