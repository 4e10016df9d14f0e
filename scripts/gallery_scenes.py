"""What the gallery shows: which scene, in which size, which frame, from where, and the line under its picture."""

from __future__ import annotations

from dataclasses import dataclass

from paper.view import View


@dataclass(frozen=True)
class Exhibit:
    """One picture of the gallery: a scene of tests/scenes at one of its frames."""

    scene: str
    words: str
    frame: int
    view: View
    overrides: tuple[str, ...] = ()
    clear: tuple[str, ...] = ()
    """Colliders that are seen through."""
    plane: float = 12.0
    """m, half the side of what stands for an endless plane."""


def grid(cloth: str, side: int, thickness: float, *more: str) -> tuple[str, ...]:
    """Overrides for a finer grid of so many vertices a side and a thickness (m) that suits it."""
    vertices = f"cloth.{cloth}.grid.vertices=[{side},{side}]"
    return (vertices, f"collision.thickness={thickness}", *more)


EXHIBITS = (
    Exhibit(
        "sphere",
        "A sheet falls on a ball and on itself",
        22,
        View(center=(0.0, 0.0, -0.1), width=2.0, height=1.5, turn=25.0, lift=18.0),
        grid("sheet", 64, 0.008),
    ),
    Exhibit(
        "box_corner",
        "The corner of a box, on which three folds meet",
        20,
        View(center=(0.0, 0.0, 0.1), width=1.6, height=1.2, turn=25.0, lift=22.0),
        grid("sheet", 56, 0.007),
    ),
    Exhibit(
        "needles",
        "At 30 m/s on a bed of needles: none pierces it",
        3,
        View(center=(0.0, 0.0, 0.2), width=1.4, height=1.05, turn=25.0, lift=20.0),
        grid("sheet", 56, 0.0055),
    ),
    Exhibit(
        "folding_strip",
        "A strip that lands end-on and folds into a stack",
        12,
        View(center=(0.0, 0.0, 0.5), width=1.6, height=1.2, turn=62.0, lift=10.0),
        ("cloth.strip.grid.vertices=[8,141]", "collision.thickness=0.0035"),
    ),
    Exhibit(
        "two_sheets",
        "A sheet on another, which hangs by its corners",
        26,
        View(center=(0.0, 0.0, -0.15), width=2.0, height=1.5, turn=25.0, lift=28.0),
        (
            "cloth.lower.grid.vertices=[48,48]",
            "cloth.upper.grid.vertices=[32,32]",
            "collision.thickness=0.008",
        ),
    ),
    Exhibit(
        "twist",
        "A tube whose rim turns: rope-making",
        43,
        View(center=(0.0, 0.0, 0.25), width=1.8, height=1.35, turn=20.0, lift=8.0),
        ("scene.frames=[1,43]",),
    ),
    Exhibit(
        "funnel",
        "Through a funnel as thin as paper",
        22,
        View(center=(0.0, 0.0, 0.1), width=1.6, height=1.2, turn=20.0, lift=22.0),
        grid("sheet", 40, 0.006),
        ("funnel",),
    ),
    Exhibit(
        "tablecloth",
        "A table-cloth, pulled away",
        17,
        View(center=(0.42, 0.0, -0.1), width=2.4, height=1.8, turn=25.0, lift=26.0),
        grid("cloth", 52, 0.006),
    ),
    Exhibit(
        "closing_plates",
        "Between plates that close to three thicknesses",
        13,
        View(center=(0.0, 0.0, 0.07), width=1.8, height=1.35, turn=20.0, lift=10.0),
        ("cloth.sheet.grid.vertices=[40,40]", "collision.thickness=0.01"),
        ("upper",),
    ),
    Exhibit(
        "layers",
        "Fifty sheets, dropped as a pile",
        11,
        View(center=(0.0, 0.0, 0.22), width=0.95, height=0.7125, turn=25.0, lift=14.0),
    ),
    Exhibit(
        "fast_sphere",
        "A ball of 60 m/s, which takes the sheet along",
        3,
        View(center=(0.0, 0.45, 0.0), width=3.3, height=2.475, turn=70.0, lift=12.0),
    ),
    Exhibit(
        "moving_body",
        "On a body that sways and breathes",
        29,
        View(center=(0.0, 0.0, -0.1), width=1.7, height=1.275, turn=25.0, lift=18.0),
        grid("sheet", 56, 0.0065),
    ),
    Exhibit(
        "incline",
        "A patch that slides down 35° at friction 0.5",
        20,
        View(center=(0.15, 0.0, -0.1), width=1.9, height=1.425, turn=20.0, lift=16.0),
        grid("patch", 32, 0.004, "cloth.patch.grid.center=[0,0,0.004]"),
        plane=0.9,
    ),
    Exhibit(
        "cs184_plane",
        "Berkeley's CS184: on a plane",
        20,
        View(center=(0.5, 0.5, 0.0), width=1.6, height=1.2, turn=25.0, lift=24.0),
    ),
    Exhibit(
        "cs184_sphere",
        "CS184: on a ball",
        25,
        View(center=(0.5, 0.5, 0.2), width=1.3, height=0.975, turn=25.0, lift=20.0),
    ),
    Exhibit(
        "cs184_self_collision",
        "CS184: an upright sheet on a plane and on itself",
        25,
        View(center=(0.5, 0.0, 0.08), width=1.3, height=0.975, turn=40.0, lift=20.0),
    ),
)
