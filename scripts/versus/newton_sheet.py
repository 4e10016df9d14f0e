"""Newton on the sheet: `python -m versus.newton_sheet '{"side": 64, "frames": 24, "solver": "vbd", ...}'`."""

from __future__ import annotations

import json
import sys
import time
from typing import Any

import newton
import numpy as np
import warp as wp
from newton.solvers import style3d

from .child import follow, tell
from .sheet import FPS, Sheet


def builder(sheet: Sheet, solver: str, material: dict[str, Any]) -> newton.ModelBuilder:
    """The sheet as a grid of Newton's, two particles of it held."""
    cloth = newton.ModelBuilder()
    grid = {
        "pos": wp.vec3(*sheet.rest[0]),
        "rot": wp.quat_identity(),
        "vel": wp.vec3(0.0, 0.0, 0.0),
        "dim_x": sheet.side - 1,
        "dim_y": sheet.side - 1,
        "cell_x": sheet.spacing,
        "cell_y": sheet.spacing,
        "mass": sheet.mass_per_vertex,
        "particle_radius": 0.25 * sheet.spacing,
        **material,
    }
    if solver == "style3d":
        newton.solvers.SolverStyle3D.register_custom_attributes(cloth)
        grid["tri_aniso_ke"] = wp.vec3(*material["tri_aniso_ke"])
        grid["edge_aniso_ke"] = wp.vec3(*material["edge_aniso_ke"])
        style3d.add_cloth_grid(cloth, **grid)
    else:
        cloth.add_cloth_grid(**grid)
    for pin in sheet.pins:
        cloth.particle_mass[pin] = 0.0
        cloth.particle_flags[pin] &= ~int(newton.ParticleFlags.ACTIVE)
    if solver == "vbd":
        cloth.color(include_bending=True)
    return cloth


def solver_of(name: str, model: newton.Model, iterations: int, relaxation: float) -> Any:
    """One of Newton's solvers for cloth; XPBD alone has a relaxation."""
    if name == "vbd":
        return newton.solvers.SolverVBD(model, iterations=iterations)
    if name == "xpbd":
        return newton.solvers.SolverXPBD(
            model, iterations=iterations, soft_body_relaxation=relaxation
        )
    config = newton.solvers.SolverStyle3D.Config(iterations=iterations)
    return newton.solvers.SolverStyle3D(model, config=config)


def main(
    side: int,
    frames: int,
    seconds: float,
    solver: str,
    substeps: int,
    iterations: int,
    material: dict[str, Any],
    relaxation: float = 0.9,
) -> None:
    """Measure on the processor; kernels are compiled before the first frame."""
    wp.config.quiet = True
    wp.set_device("cpu")
    sheet = Sheet(side)
    started = time.perf_counter()
    model = builder(sheet, solver, material).finalize()
    runner = solver_of(solver, model, iterations, relaxation)
    states = [model.state(), model.state()]
    control, contacts = model.control(), newton.CollisionPipeline(model).contacts()
    runner.step(states[0], states[1], control, contacts, 1e-9)  # compiles the kernels
    states[0].assign(model.state())
    set_up = time.perf_counter() - started

    def step() -> np.ndarray:
        for _ in range(substeps):
            states[0].clear_forces()
            runner.step(states[0], states[1], control, contacts, 1.0 / FPS / substeps)
            states.reverse()
        return states[0].particle_q.numpy()

    result = follow(sheet, frames, step, seconds=seconds)
    counts = {"substeps": [substeps] * frames, "iterations": [substeps * iterations] * frames}
    tell({**result, **counts, "set_up_ms": 1e3 * set_up})


if __name__ == "__main__":
    main(**json.loads(sys.argv[1]))
