"""The add-on's own bake of a small scene, without Blender: `addon_bake.py contact|tearing OUT [--resume] [--side N]`.

Exit codes as those of bake.py, and one line on standard error.
"""

from __future__ import annotations

import argparse
import json
import sys
import types
from array import array
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
END = 14
SIDE = 9

package = types.ModuleType("boucle_addon")
package.__path__ = [str(ROOT / "addon")]
sys.modules["boucle_addon"] = package
"""The add-on without its own start, which needs Blender."""


def grid(side: int, height: float) -> tuple[array, array, array]:
    """A square of so many vertices a side, 1 m, at a height (m), as the module takes it."""
    positions, corners = array("d"), array("i")
    for number in range(side**2):
        row, column = divmod(number, side)
        positions.extend([column / (side - 1), row / (side - 1), height])
        if row < side - 1 and column < side - 1:
            corners.extend([number, number + 1, number + side + 1, number + side])
    return positions, array("i", range(0, len(corners), 4)), corners


def scene(kind: str, side: int) -> tuple[dict[str, Any], list[tuple[array, array, array]]]:
    """Two sheets that fall on a ball, or one that is torn in the middle."""
    frames = {"frames": [1, END], "fps": 24.0, "gravity": [0.0, 0.0, -9.81]}
    if kind == "tearing":
        middle = side // 2 * side
        pairs = [[middle + column, middle + column + 1] for column in range(side // 2)]
        pins = {"vertices": [*range(side), *range(side * (side - 1), side * side)]}
        tear = {"enabled": True, "strain": 0.3, "openings": [{"frame": 5, "pairs": pairs}]}
        cloth = {"name": "A", "density": 0.2, "pins": pins, "tear": tear}
        return {"scene": frames, "cloth": [cloth], "collision": {"thickness": 0.01}}, [
            grid(side, 0.0)
        ]
    cloths = [{"name": name, "density": 0.2} for name in "AB"]
    ball = {"name": "ball", "sphere": {"center": [0.5, 0.5, -0.55], "radius": 0.5}}
    description = {"scene": frames, "cloth": cloths, "collider": [ball]}
    return {**description, "collision": {"thickness": 0.02}}, [grid(side, 0.0), grid(side, 0.06)]


def apart(corners: array) -> list[int]:
    """The point of each corner where every face has its own: the first of a vertex keeps its number."""
    seen: set[int] = set()
    points, count = [], max(corners) + 1
    for vertex in corners:
        if vertex in seen:
            points.append(count)
            count += 1
        else:
            seen.add(vertex)
            points.append(vertex)
    return points


def torn_points(corners: array, torn: set[frozenset[int]]) -> list[int]:
    """The point of each corner where faces hang together but at torn edges."""
    parent = list(range(len(corners)))

    def root(corner: int) -> int:
        while parent[corner] != corner:
            corner = parent[corner]
        return corner

    sides: dict[frozenset[int], dict[int, int]] = {}
    for start in range(0, len(corners), 4):
        face = range(start, start + 4)
        for corner, after in zip(face, [*face[1:], face[0]], strict=True):
            edge = frozenset((corners[corner], corners[after]))
            ends = {corners[corner]: corner, corners[after]: after}
            if edge in sides and edge not in torn:
                for vertex, own in ends.items():
                    parent[root(own)] = root(sides[edge][vertex])
            sides[edge] = ends
    points: dict[int, int] = {}
    taken: set[int] = set()
    count = max(corners) + 1
    for corner, vertex in enumerate(corners):
        if root(corner) not in points:
            points[root(corner)] = count if vertex in taken else vertex
            count += vertex in taken
            taken.add(vertex)
    return [points[root(corner)] for corner in range(len(corners))]


def stores(folder: Path, names: list[str], meshes: list[Any], tears: bool) -> Any:
    """The files of the bake."""
    from boucle_addon.core import report
    from boucle_addon.core.cache_paths import files_of
    from boucle_addon.core.store import Plan, Store, Stores
    from boucle_addon.core.torn import Layout

    each = []
    for name, (positions, _, corners) in zip(names, meshes, strict=True):
        count = len(positions) // 3
        points = apart(corners)
        layout = Layout(count, max(points) + 1, array("i", points), None) if tears else None
        rows = report.Report("0.1.0", "", 1, {"name": name})
        plan = Plan(
            1, 1, END, count, "d", keeps=("strain",), corner_count=len(corners), layout=layout
        )
        files = files_of(str(folder / f"{name}.pc2"))
        each.append(Store(files, plan, rows, keeps_previous=False))
    return Stores(each)


def bake(kind: str, folder: Path, resume: bool, side: int) -> None:
    """Bake, and give a torn cloth the points that it needs."""
    import boucle_core
    from boucle_addon.core import bake as core_bake
    from boucle_addon.core import points, torn
    from boucle_addon.core.bake import Moment, Pose
    from boucle_addon.core.torn import Layout

    description, meshes = scene(kind, side)
    simulation = boucle_core.Simulation(json.dumps(description), meshes, 1)
    names = [cloth["name"] for cloth in description["cloth"]]
    kept = stores(folder, names, meshes, kind == "tearing")
    moment = Moment([Pose(None, points.IDENTITY) for _ in names])
    running = core_bake.bake(
        simulation, kept, lambda _frame: moment, resume, boucle_core.InternalError
    )
    for step in running:
        step.run()
    for number, store in enumerate(kept.each):
        full = store.plan.layout
        if full is not None:
            torn_edges = simulation.torn_edges(number)
            edges = array("i", (end for edge in torn_edges for end in edge))
            placed = torn_points(meshes[number][2], {frozenset(edge) for edge in torn_edges})
            least = Layout(full.vertex_count, max(placed) + 1, array("i", placed), edges)
            torn.arrange(store.files.pc2, store.files.tear, full, least)


def main() -> int:
    """Bake what the command line asks for and return the exit code."""
    lines = argparse.ArgumentParser(description=__doc__)
    lines.add_argument("kind", choices=["contact", "tearing"])
    lines.add_argument("out", type=Path)
    lines.add_argument("--resume", action="store_true")
    lines.add_argument("--side", type=int, default=SIDE)
    options = lines.parse_args()
    import boucle_core
    from boucle_addon.core.refusal import CacheRefusal, Refusal, sentence_of

    try:
        bake(options.kind, options.out, options.resume, options.side)
    except CacheRefusal as refusal:
        print(refusal, file=sys.stderr)
        return 4
    except (Refusal, boucle_core.BoucleError) as refusal:
        print(sentence_of(refusal), file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
