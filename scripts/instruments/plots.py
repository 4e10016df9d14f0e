"""The pictures of a lab sheet: force over strain, strips beside the elastica, discs from above."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from paper.looks import INK, KIND_COLORS, PALE, RESOLUTION, page

from . import drape, tensile
from .cantilever import Cantilever
from .drape import Drape
from .elastica import FLAT_TIP
from .sheet import Sheet, figure

COLORS = dict(zip(("warp", "weft", "bias"), KIND_COLORS, strict=True))
DASHED = (0, (5, 3))
SHADOW = ListedColormap(["white", "#d8d2c4"])


def save(sheet: Sheet, folder: Path) -> list[Path]:
    """Write the pictures of what was measured as PNG files."""
    paths = []
    for name, drawing in figures(sheet):
        title = f"{sheet.fabric.preset}, {sheet.order.kind} mesh"
        drawing.suptitle(title, x=0.02, ha="left", fontsize=13, weight="bold")
        paths.append(folder / f"{name}.png")
        drawing.savefig(paths[-1], dpi=RESOLUTION, facecolor="white")
        drawing.clear()
    return paths


def figures(sheet: Sheet) -> Iterator[tuple[str, Figure]]:
    """Each picture, with its name."""
    if sheet.tensile:
        yield "tensile", tensile_figure(sheet)
    if sheet.shear:
        yield "shear", shear_figure(sheet)
    if sheet.bending:
        yield "bending", bending_figure(sheet)
    if sheet.cantilever:
        yield "cantilever", cantilever_figure(sheet)
    if sheet.drapes:
        yield "drape", drape_figure(sheet)


def tensile_figure(sheet: Sheet) -> Figure:
    """Force over strain: what was read, and what the law of small strain says."""
    drawing = page(4.2)
    axes = drawing.subplots()
    top = max(tensile.FAST_LOADS) * tensile.GRAM_FORCE_PER_CENTIMETRE
    widest = 0.0
    for way, read in sheet.tensile.items():
        strain = 100.0 * np.array([0.0, *(pull.marks for pull in read.pulls)])
        tension = np.array([0.0, *(pull.tension for pull in read.pulls)])
        words = f"{way}: {figure(read.stiffness, 4)} N/m at 0.1 %"
        axes.plot(strain, tension, "o-", ms=4, color=COLORS[way], label=words)
        axes.axline((0.0, 0.0), slope=0.01 * read.expected, color=COLORS[way], ls=DASHED, lw=1.0)
        widest = max(widest, float(np.interp(top, tension, strain)))
    axes.set(xlabel="strain between the marks (%)", ylabel="force over width (N/m)")
    axes.set(xlim=(0.0, 1.1 * widest), ylim=(0.0, 1.1 * top))
    axes.set_title("strip test; dashed: the stiffness of the preset", fontsize=10.5)
    axes.legend()
    return drawing


def shear_figure(sheet: Sheet) -> Figure:
    """Shear stress over the angle of the frame."""
    drawing = page(3.6)
    axes = drawing.subplots()
    for way, read in sheet.shear.items():
        words = f"{way}: {read.stiffness:.4g} N/m"
        axes.plot(read.degrees, read.stresses, "o", color=COLORS[way], label=words)
        angles = np.linspace(0.0, max(read.degrees), 50)
        law = read.expected * np.sin(np.radians(angles))
    axes.plot(angles, law, color=INK, ls=DASHED, lw=1.0, label="G sin a of the preset")
    axes.set(xlabel="angle (degrees)", ylabel="shear stress (N/m)")
    axes.set_title("picture frame", fontsize=10.5)
    axes.legend()
    return drawing


def bending_figure(sheet: Sheet) -> Figure:
    """The loops of the moment over the curvature."""
    drawing = page(3.6)
    axes = drawing.subplots()
    for way, read in sheet.bending.items():
        words = (
            f"{way}: B {figure(1e6 * read.rigidity, 3)} µN·m, "
            f"2HB {figure(1e3 * read.width, 3)} mN·m/m"
        )
        moments = 1e3 * np.array(read.moments)
        axes.plot(0.01 * np.array(read.curvatures), moments, color=COLORS[way], label=words)
    axes.set(xlabel="curvature (1/cm)", ylabel="moment over width (mN·m/m)")
    axes.set_title("pure bending, KES-FB2", fontsize=10.5)
    axes.legend()
    return drawing


def cantilever_figure(sheet: Sheet) -> Figure:
    """Strips over the edge, and the line that they reach."""
    drawing = page(3.6)
    panels = drawing.subplots(1, len(sheet.cantilever), squeeze=False, sharex=True, sharey=True)
    for axes, (way, read) in zip(panels[0], sheet.cantilever.items(), strict=True):
        draw_strip(axes, way, read)
    panels[0, 0].legend(fontsize=9)
    return drawing


def draw_strip(axes: Axes, way: str, read: Cantilever) -> None:
    """One strip from the side, in centimetres."""
    length = 100.0 * read.strip.length
    axes.plot([-0.3 * length, 0.0], [0.0, 0.0], color=INK, lw=4, solid_capstyle="butt")
    out, down = 100.0 * read.strip.out, 100.0 * read.strip.down
    axes.plot(out, -down, "o", ms=3.5, color=COLORS[way], label="strip")
    exact = length * np.stack([read.exact.out, -read.exact.down])
    axes.plot(*exact, color=INK, lw=1.0, label="heavy elastica")
    slope = -np.tan(np.radians(FLAT_TIP))
    axes.plot([0.0, 0.8 * length], [0.0, 0.8 * length * slope], color=PALE, ls=DASHED)
    axes.set_aspect("equal")
    rigidity = f"B {1e6 * read.rigidity:.3g} µN·m, of the preset {1e6 * read.expected:.3g}"
    axes.set_title(f"{way}, c {100.0 * read.bending_length:.2f} cm\n{rigidity}", fontsize=10)
    axes.set_xlabel("cm")


def drape_figure(sheet: Sheet) -> Figure:
    """Discs from above with their shadows."""
    drawing = page(4.0)
    panels = drawing.subplots(1, len(sheet.drapes), squeeze=False, sharex=True, sharey=True)
    for axes, one in zip(panels[0], sheet.drapes, strict=True):
        draw_disc(axes, one)
    return drawing


def draw_disc(axes: Axes, one: Drape) -> None:
    """One disc: its shadow, its mesh, the plates, and the disc as it was cut."""
    half = 50.0 * drape.PIXEL * len(one.shadow)
    axes.imshow(one.shadow, SHADOW, origin="lower", extent=(-half, half, -half, half))
    x, y = 100.0 * one.resting.positions[:, :2].T
    height = 100.0 * one.resting.positions[:, 2]
    triangles = one.resting.specimen.cut.triangles
    axes.tripcolor(x, y, triangles, height, cmap="bone", shading="gouraud", alpha=0.75)
    for radius, style in ((drape.PLATE, "-"), (drape.DISC, DASHED)):
        axes.add_patch(Circle((0.0, 0.0), 100.0 * radius, fill=False, ls=style, ec=INK, lw=1.0))
    axes.set(xlim=(-half, half), ylim=(-half, half), aspect="equal", xlabel="cm")
    axes.set_title(f"drape coefficient {one.coefficient:.1f} %, {one.nodes} nodes", fontsize=10)
