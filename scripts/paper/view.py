"""From where a cloth is seen, and pictures of it: rendered by Blender, or plotted."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection

from .looks import INK, LOAD_MAP

if TYPE_CHECKING:
    from .sheet import Sheet


@dataclass(frozen=True)
class View:
    """A parallel projection that looks along +y, turned and lifted.

    A picture's coordinates are metres from `center`, right and up.
    """

    center: tuple[float, float, float] = (0.0, 0.0, 0.0)
    width: float = 2.0  # m
    height: float = 2.0  # m
    turn: float = 20.0  # degrees, the camera goes to the right
    lift: float = 10.0  # degrees, the camera goes up

    def axes(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Unit vectors to the right, up, and towards the camera."""
        turn, lift = math.radians(self.turn), math.radians(self.lift)
        right = np.array([math.cos(turn), math.sin(turn), 0.0])
        back = np.array([math.sin(turn), -math.cos(turn), 0.0]) * math.cos(lift)
        back[2] = math.sin(lift)
        return right, np.cross(back, right), back

    def project(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Coordinates in the picture (m), (..., 2), and nearness to the camera (m), (...)."""
        right, up, back = self.axes()
        points = np.asarray(points) - self.center
        return np.stack([points @ right, points @ up], axis=-1), points @ back

    def frame(self, axes: Axes) -> None:
        """Make matplotlib's axes show what this view shows."""
        axes.set_xlim(-0.5 * self.width, 0.5 * self.width)
        axes.set_ylim(-0.5 * self.height, 0.5 * self.height)
        axes.set_aspect("equal")
        axes.set_axis_off()


@dataclass
class Shot:
    """A cloth at one moment, to be pictured."""

    positions: np.ndarray  # (n, 3) m
    faces: np.ndarray  # (f, 4)
    values: np.ndarray  # (n,) what the colours show
    largest: float  # the value of the last colour
    pins: list[int] = field(default_factory=list)

    @classmethod
    def of(cls, sheet: Sheet, values: np.ndarray, largest: float) -> Shot:
        """A sheet as it is now."""
        return cls(sheet.positions(), sheet.faces, values, largest, sheet.pins)

    def vertex_colors(self) -> np.ndarray:
        """Colour of each vertex, (n, 4), sRGB."""
        return LOAD_MAP(np.clip(self.values / self.largest, 0.0, 1.0))


class Pictures(Protocol):
    """Whatever puts a picture of a cloth into axes."""

    def show(self, axes: Axes, shot: Shot, view: View) -> None:
        """Fill the axes with the shot as the view sees it."""


class Plotted:
    """Pictures drawn by matplotlib: quick, and without Blender."""

    def show(self, axes: Axes, shot: Shot, view: View) -> None:
        """Draw the faces from far to near."""
        flat, nearness = view.project(shot.positions)
        order = np.argsort(nearness[shot.faces].mean(axis=1))
        fill = shot.vertex_colors()[shot.faces].mean(axis=1)
        faces = flat[shot.faces[order]]
        axes.add_collection(
            PolyCollection(faces, facecolors=fill[order], edgecolors=INK, linewidths=0.4)
        )
        axes.plot(*flat[shot.pins].T, "o", color=INK, ms=5, clip_on=False)
        view.frame(axes)


class Rendered:
    """Pictures rendered by Blender's Cycles on the processor.

    Raises:
        ModuleNotFoundError: There is no `bpy` package.
    """

    def __init__(self, folder: Path, pixels_per_inch: float) -> None:
        from .studio import Studio

        self.folder = folder
        self.pixels_per_inch = pixels_per_inch
        self.studio = Studio()
        self.count = 0

    def show(self, axes: Axes, shot: Shot, view: View) -> None:
        """Render the shot for the size that the axes will have."""
        import matplotlib.image

        self.count += 1
        path = self.folder / f"shot{self.count}.png"
        figure = axes.get_figure(root=True)
        figure.draw_without_rendering()
        inches = axes.get_window_extent().width / figure.dpi
        self.studio.render(shot, view, round(inches * self.pixels_per_inch), path)
        half = 0.5 * view.width, 0.5 * view.height
        extent = (-half[0], half[0], -half[1], half[1])
        axes.imshow(on_white(matplotlib.image.imread(path)), extent=extent)
        view.frame(axes)


def on_white(image: np.ndarray) -> np.ndarray:
    """A picture (h, w, 4) with its transparent parts white, (h, w, 3)."""
    cover = image[..., 3:]
    return image[..., :3] * cover + (1.0 - cover)
