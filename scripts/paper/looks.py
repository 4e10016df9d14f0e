"""How the figures look: colours that every eye tells apart (Okabe & Ito 2008), type, captions, files."""

from __future__ import annotations

import textwrap
from dataclasses import dataclass, field
from pathlib import Path

import matplotlib as mpl

mpl.use("Agg")

import matplotlib.pyplot as plt
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure

INK = "#222222"
PALE = "#c9c9c9"
KIND_COLORS = ("#0072B2", "#D55E00", "#009E73")
"""Stretch, shear and bend springs."""
LIMITER_COLORS = {
    "none": "#7a7a7a",
    "stiffen": "#D55E00",
    "provot": "#CC79A7",
    "project": "#0072B2",
}
LOAD_MAP = LinearSegmentedColormap.from_list(
    "load", ["#f4efe4", "#f3d489", "#e69f00", "#d55e00", "#9c2a4a", "#4a1942"]
)
"""From unloaded linen to most loaded; its lightness falls all the way."""

PAGE = 10.0
"""Width (inches) of every figure."""
LINE = 0.185
"""Height (inches) of a line of a caption."""
RESOLUTION = 130
"""Pixels an inch."""

STYLE = {
    "font.family": "DejaVu Sans",
    "font.size": 10.0,
    "axes.titlesize": 11.0,
    "axes.edgecolor": INK,
    "axes.labelcolor": INK,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "text.color": INK,
    "xtick.color": INK,
    "ytick.color": INK,
    "legend.frameon": False,
    "lines.solid_capstyle": "round",
    "figure.dpi": RESOLUTION,
}


@dataclass
class Plate:
    """One figure: its picture, its words and the numbers behind it."""

    number: int
    name: str
    title: str
    caption: str
    drawing: Figure
    numbers: dict[str, object] = field(default_factory=dict)

    @property
    def file_name(self) -> str:
        """The picture's file name."""
        return f"figure{self.number}_{self.name}.png"

    def save(self, folder: Path) -> Path:
        """Write title, picture and caption as a PNG file, and let the drawing go."""
        self.drawing.suptitle(
            f"Figure {self.number}: {self.title}", x=0.02, ha="left", fontsize=13, weight="bold"
        )
        lines = textwrap.wrap(self.caption, 132)
        height = self.drawing.get_size_inches()[1]
        foot = (len(lines) * LINE + 0.12) / height
        self.drawing.get_layout_engine().set(rect=(0.0, foot, 1.0, 1.0 - foot))
        self.drawing.text(
            0.02, foot - 0.02 / height, "\n".join(lines), va="top", fontsize=9.5, linespacing=1.35
        )
        path = folder / self.file_name
        self.drawing.savefig(path, dpi=RESOLUTION, facecolor="white")
        plt.close(self.drawing)
        return path


def page(height: float) -> Figure:
    """An empty figure of the common width and a height (inches)."""
    mpl.rcParams.update(STYLE)
    drawing = plt.figure(figsize=(PAGE, height), layout="constrained")
    drawing.get_layout_engine().set(w_pad=0.06, h_pad=0.06)
    return drawing


def shrink(picture: Path, target: Path, width: int = 1000) -> None:
    """Write a smaller copy with 256 colours, for a web page."""
    from PIL import Image

    with Image.open(picture) as image:
        height = round(image.height * width / image.width)
        small = image.convert("RGB").resize((width, height), Image.Resampling.LANCZOS)
    target.parent.mkdir(parents=True, exist_ok=True)
    palette = small.quantize(256, method=Image.Quantize.MEDIANCUT)
    dithered = small.quantize(palette=palette, dither=Image.Dither.FLOYDSTEINBERG)
    dithered.save(target, optimize=True)
