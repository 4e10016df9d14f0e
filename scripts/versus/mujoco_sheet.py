"""MuJoCo's flex on the sheet: `python -m versus.mujoco_sheet '{"side": 64, "frames": 24, ...}'`."""

from __future__ import annotations

import json
import sys
import time

import mujoco
import numpy as np

from .child import follow, tell
from .sheet import DENSITY, FPS, SIZE, Sheet


def model_text(sheet: Sheet, substeps: int, iterations: int, inside: str) -> str:
    """The scene in MuJoCo's own format; its grid counts along y first."""
    pins = [sheet.side * sheet.side - 1, sheet.side - 1]
    side, mass = sheet.side, DENSITY * SIZE**2
    return f"""
<mujoco>
  <option timestep="{1.0 / FPS / substeps}" integrator="discrete" solver="CG"
          iterations="{iterations}" tolerance="1e-8" gravity="0 0 -9.81">
    <flag contact="disable"/>
  </option>
  <size memory="2G"/>
  <worldbody>
    <flexcomp name="sheet" type="grid" dim="2" count="{side} {side} 1" mass="{mass}"
              spacing="{sheet.spacing} {sheet.spacing} 1" radius="0.002">
      <contact selfcollide="none" contype="0" conaffinity="0"/>
      {inside}
      <pin id="{pins[0]} {pins[1]}"/>
    </flexcomp>
  </worldbody>
</mujoco>"""


def main(
    side: int, frames: int, seconds: float, substeps: int, iterations: int, inside: str
) -> None:
    """Measure."""
    sheet = Sheet(side)
    started = time.perf_counter()
    model = mujoco.MjModel.from_xml_string(model_text(sheet, substeps, iterations, inside))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    set_up = time.perf_counter() - started
    counted: list[int] = []

    def step() -> np.ndarray:
        total = 0
        for _ in range(substeps):
            mujoco.mj_step(model, data)
            total += int(data.solver_niter.sum())
        counted.append(total)
        mujoco.mj_kinematics(model, data)
        mujoco.mj_flex(model, data)
        return data.flexvert_xpos.reshape(-1, 3).copy()

    result = follow(sheet, frames, step, seconds=seconds)
    counts = {"substeps": [substeps] * frames, "iterations": counted}
    tell({**result, **counts, "set_up_ms": 1e3 * set_up})


if __name__ == "__main__":
    main(**json.loads(sys.argv[1]))
