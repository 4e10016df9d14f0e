"""What an exploration leaves: pictures, tables in index.md, numbers.json."""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Callable
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from paper.looks import RESOLUTION, shrink

from . import integrators, limiters, meshes, ranges, stability, stability_picture
from .boundary import Runs
from .stability import QUICK, Size


class Report:
    """Runs parts of the exploration and collects what they show."""

    def __init__(
        self, folder: Path, say: Callable[[str, int, int], None], options: argparse.Namespace
    ) -> None:
        self.runs = Runs(folder, say, options.threads)
        self.out: Path = options.out
        self.is_quick: bool = options.quick
        self.pieces = ["# Exploration"]
        self.numbers: dict[str, object] = {}
        self.ranges: dict[str, dict[str, object]] = {}

    def add(self, part: str) -> None:
        """Run a part, and save its picture."""
        began = time.perf_counter()
        picture, words, numbers = getattr(self, f"_{part}")()
        picture.savefig(self.out / f"{part}.png", dpi=RESOLUTION, facecolor="white")
        plt.close(picture)
        seconds = time.perf_counter() - began
        title = f"## {part.capitalize()}"
        self.pieces += [title, f"![{part}]({part}.png)", *words, f"Took {seconds:.0f} s."]
        self.numbers[part] = numbers

    def write(self) -> Path:
        """Write index.md and numbers.json, and return the path of the first."""
        self.numbers["runs"] = self.runs.count
        index = self.out / "index.md"
        index.write_text("\n\n".join(self.pieces) + "\n", encoding="utf-8")
        text = json.dumps(self.numbers, indent=1, allow_nan=False) + "\n"
        (self.out / "numbers.json").write_text(text, encoding="utf-8")
        return index

    def keep(self, pictures: Path, ranges_file: Path) -> None:
        """Renew the README's picture and the ranges of the add-on."""
        shrink(self.out / "stability.png", pictures / "stability.png")
        ranges.keep(self.ranges, ranges_file)

    def _stability(self) -> tuple[Figure, list[str], object]:
        size = QUICK if self.is_quick else Size()
        runs, before = self.runs, (self.runs.count, self.runs.seconds)
        undamped, damped = stability.undamped(runs, size), stability.damped(runs, size)
        maps, falling = stability.maps(runs, size), stability.falling(runs, size)
        self.ranges = ranges.ranges(damped)
        count, seconds = runs.count - before[0], runs.seconds - before[1]
        worst = [100 * float(np.abs(each.errors).max()) for each in (undamped, damped)]
        reach = undamped.safe / undamped.theory
        words = [
            f"{count} runs in {seconds:.0f} s. Measured boundaries are off theory by at most "
            f"{worst[0]:.2f} % undamped ({len(undamped.points)} points) and {worst[1]:.2f} % damped "
            f"({len(damped.points)} points). The panel's safe step, which holds in any shape, is "
            f"{reach.min():.2f} to {reach.max():.2f} of the undamped boundary.",
            "Recommended ranges. Damping ratio: of the fastest oscillation, those that leave half of the "
            "longest stable step. Step: stable with every one of them.",
            ranges.table(self.ranges),
        ]
        numbers = {
            "runs": count,
            "worst_error_percent": {"undamped": worst[0], "damped": worst[1]},
            "ranges": self.ranges,
            "undamped": stability.numbers(undamped),
            "damped": stability.numbers(damped),
            "falling": {
                "stretch_N_m": falling.stiffness.tolist(),
                "measured_s": falling.measured.tolist(),
                "safe_time_step_s": falling.safe.tolist(),
            },
        }
        return stability_picture.draw(undamped, damped, maps, falling), words, numbers

    def _limiters(self) -> tuple[Figure, list[str], object]:
        found = limiters.measure(12 if self.is_quick else 48)
        return limiters.draw(found), [limiters.table(found)], limiters.numbers(found)

    def _integrators(self) -> tuple[Figure, list[str], object]:
        swings, reference = integrators.measure(3 if self.is_quick else 6)
        words = [
            "The cheapest run within an error:",
            integrators.table(swings),
            "What a step costs in quality where any is stable:",
            integrators.quality(swings, reference),
        ]
        return integrators.draw(swings, reference), words, integrators.numbers(swings)

    def _meshes(self) -> tuple[Figure, list[str], object]:
        found = meshes.measure(self.runs)
        return meshes.draw(found), [meshes.table(found)], meshes.numbers(found)
