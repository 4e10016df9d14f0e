"""Figures 4, 5 and 6: hanging cloth with and without limits, with low and high stretch and shear stiffness."""

from __future__ import annotations

from dataclasses import dataclass, replace

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.colors import Normalize

from .looks import LOAD_MAP, Plate, page
from .sheet import Recipe, Sheet, hang, shear_angles
from .view import Pictures, Shot, View

SECONDS = 8.0
INWARD = 0.2
"""The part of the width by which the pins come together."""
TILT = 60.0
HOW = (
    f"The sheet starts {TILT:.0f}° off the vertical, its pins come together by {100 * INWARD:.0f} % of its width, and "
    f"after {SECONDS:g} s it hangs as shown"
)


@dataclass(frozen=True)
class Load:
    """What the colours of a comparison show."""

    words: str
    unit: str
    largest: float
    """The value of the last colour."""


def compare(
    pictures: Pictures, sheets: dict[str, Sheet], view: View, load: Load
) -> tuple[object, dict[str, float]]:
    """Sheets side by side with one scale of colours; also the largest value of each."""
    count = len(sheets)
    width = 9.0 / count
    drawing = page(min(width, 3.6) * view.height / view.width + 1.3)
    panels = drawing.subplots(1, count)
    largest = {}
    for axes, (title, sheet) in zip(panels, sheets.items(), strict=True):
        values = shear_angles(sheet) if load.unit == "°" else 100.0 * sheet.strain()
        largest[title] = float(values.max())
        axes.set_title(
            f"{title}\nat most {largest[title]:.{0 if values.max() > 20 else 1}f}{gap(load)}"
        )
        view.frame(axes)
        pictures.show(axes, Shot.of(sheet, values, load.largest), view)
    add_scale(drawing, list(panels), load)
    return drawing, largest


def gap(load: Load) -> str:
    """The unit as it follows a number."""
    return load.unit if load.unit == "°" else f" {load.unit}"


def add_scale(drawing: object, panels: list[Axes], load: Load) -> None:
    """The scale of colours, to the right of the panels."""
    scale = mpl.cm.ScalarMappable(Normalize(0.0, load.largest), LOAD_MAP)
    bar = drawing.colorbar(scale, ax=panels, shrink=0.75, aspect=28, pad=0.01, extend="max")
    bar.set_label(f"{load.words} ({load.unit})")
    bar.outline.set_visible(False)


def with_and_without(pictures: Pictures, quick: bool) -> Plate:
    """Figure 4: no limit, the paper's equation 6, and position and velocity correction."""
    recipe = Recipe(vertices=10 if quick else 16, tilt=TILT)
    titles = {
        "none": "no limit",
        "stiffen": "stiffer springs (eq. 6)",
        "project": "project (our default)",
    }
    sheets = {
        title: hang(replace(recipe, limiter=limiter), SECONDS, INWARD)
        for limiter, title in titles.items()
    }
    view = View(center=(0.0, 0.0, -0.28), width=2.35, height=2.9, turn=18.0, lift=8.0)
    load = Load("elongation of edges", "%", 60.0)
    drawing, largest = compare(pictures, sheets, view, load)
    caption = (
        f"{recipe.words()}, deformation rate {100 * recipe.rate:.0f} %. {HOW}. Without a limit the edges at the pins "
        "stretch like rubber (superelasticity); equation 6 lessens it but passes the allowed 10 %; the correction of "
        "positions and velocities keeps to it."
    )
    numbers = {limiter: largest[title] for limiter, title in titles.items()}
    title = "hanging cloth without and with limits of its elongation"
    return Plate(4, "adjustment", title, caption, drawing, {"largest_elongation_percent": numbers})


def stretch_stiffness(pictures: Pictures, quick: bool) -> Plate:
    """Figure 5: low and high stretch k."""
    recipe = Recipe(vertices=10 if quick else 16, mass=0.02, damping=0.2, tilt=TILT)
    sheets = {
        f"stretch k = {k:g} N/m": hang(replace(recipe, stretch=k), SECONDS, INWARD)
        for k in (50.0, 2000.0)
    }
    view = View(center=(0.0, 0.0, -0.36), width=2.4, height=2.95, turn=18.0, lift=8.0)
    drawing, largest = compare(pictures, sheets, view, Load("elongation of edges", "%", 60.0))
    caption = (
        f"{recipe.words('stretch')}, no limit of the elongation. {HOW}. A low stretch k gives a sheet of rubber, a high "
        "one a cloth, at the price of a smaller safe step."
    )
    steps = {title: sheet.simulation.safe_time_step for title, sheet in sheets.items()}
    return Plate(
        5,
        "stretch",
        "low and high stretch k",
        f"{caption} Safe steps: {steps_in_words(steps)}.",
        drawing,
        {"largest_elongation_percent": largest, "safe_time_step_s": steps},
    )


def shear_stiffness(pictures: Pictures, quick: bool) -> Plate:
    """Figure 6: low and high shear k."""
    recipe = Recipe(vertices=10 if quick else 16, mass=0.02, damping=0.2, stretch=1000.0, tilt=TILT)
    sheets = {
        f"shear k = {k:g} N/m": hang(replace(recipe, shear=k), SECONDS, INWARD)
        for k in (5.0, 500.0)
    }
    view = View(center=(0.0, 0.0, -0.33), width=2.4, height=2.9, turn=18.0, lift=8.0)
    drawing, largest = compare(pictures, sheets, view, Load("shear of corners", "°", 60.0))
    caption = (
        f"{recipe.words('shear')}, no limit of the elongation. {HOW}. With a low shear k the squares lean over under "
        "their own weight and the sheet loses its shape; with a high one they stay nearly square."
    )
    numbers = {"largest_shear_degrees": largest}
    return Plate(6, "shear", "low and high shear k", caption, drawing, numbers)


def steps_in_words(steps: dict[str, float]) -> str:
    """Safe steps of sheets, for a caption."""
    return ", ".join(
        f"{1000.0 * step:.1f} ms at {title.partition('= ')[2]}" for title, step in steps.items()
    )
