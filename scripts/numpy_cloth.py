"""The paper's explicit cloth in vectorised numpy: the yardstick of `dev.py bench explicit`.

A grid of n x n particles hangs by two corners. Springs join each particle to 12 neighbours: 4 stretch, 4 shear,
4 bend (the next but one). With d = x_j - x_i, l = |d|, rest length L (m), stiffness k (N/m), damping c (N·s/m):

    F_i = k (1 - L/l) d + c (v_j - v_i),   F_j = -F_i
    v  += dt (F/m + g),   x += dt v           symplectic Euler, pinned particles stay

Three ways to write it, all in float64 and without a Python loop over particles, from the usual to the fastest:

- `PlainStep` takes any spring list; fancy indexing gathers and `add.at` scatters, as one writes it first.
- `TunedStep` takes any spring list; every buffer is made beforehand, `take` gathers and `bincount` scatters.
- `GridStep` is tuned too and takes grids alone: the springs of a family join particles that stand a fixed number
  of places apart in memory, so gathering and scattering are shifted views. Places where a row ends get stiffness 0.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

SHIFTS = {
    "stretch": ((0, 1), (1, 0)),
    "shear": ((1, 1), (1, -1)),
    "bend": ((0, 2), (2, 0)),
}


@dataclass(frozen=True)
class Sheet:
    """A square cloth and its constants, SI units."""

    vertices: int = 128
    size: float = 1.27
    mass: float = 1e-4
    stiffness: tuple[float, float, float] = (50.0, 20.0, 5.0)
    damping: float = 1e-3
    gravity: float = -9.81
    time_step: float = 1.0 / 24.0 / 256.0

    def rest_positions(self) -> np.ndarray:
        """Positions (m) at rest in the x-z plane, shape (3, n, n): axis, row, column."""
        line = np.linspace(-0.5 * self.size, 0.5 * self.size, self.vertices)
        z, x = np.meshgrid(line, line, indexing="ij")
        return np.stack([x, np.zeros_like(x), z])

    def families(self) -> list[tuple[tuple[int, int], float, float]]:
        """For each family of springs: its shift (rows, columns), stiffness (N/m) and rest length (m)."""
        cell = self.size / (self.vertices - 1)
        kinds = zip(SHIFTS.values(), self.stiffness, strict=True)
        return [
            (shift, stiffness, cell * float(np.hypot(*shift)))
            for shifts, stiffness in kinds
            for shift in shifts
        ]

    def spring_count(self) -> int:
        """Number of springs."""
        n = self.vertices
        return sum(
            (n - abs(rows)) * (n - abs(columns)) for (rows, columns), _k, _l in self.families()
        )


def ends_of(shift: tuple[int, int], index: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """First and second particles of the springs that join each to the one `shift` (rows, columns) away."""
    rows, columns = shift
    n = index.shape[0]
    left, right = max(0, -columns), max(0, columns)
    first = index[: n - rows, left : n - right]
    second = index[rows:, right : n - left]
    return first.ravel(), second.ravel()


class Cloth:
    """Positions (m) and velocities (m/s) of a sheet, shape (3, particles), and the step's last part."""

    def __init__(self, sheet: Sheet) -> None:
        self.sheet = sheet
        self.x = sheet.rest_positions().reshape(3, -1)
        self.v = np.zeros_like(self.x)
        self.force = np.zeros_like(self.x)
        self.index = np.arange(self.x.shape[1]).reshape(sheet.vertices, -1)
        self.pins = [self.index[-1, 0], self.index[-1, -1]]

    def move(self) -> None:
        """Symplectic Euler with the spring forces (N) in `force`, which is used up."""
        sheet, change = self.sheet, self.force
        change *= sheet.time_step / sheet.mass
        change[2] += sheet.time_step * sheet.gravity
        change[:, self.pins] = 0.0
        self.v += change
        np.multiply(self.v, sheet.time_step, out=change)
        self.x += change

    def positions(self) -> np.ndarray:
        """Positions (m), shape (particles, 3), index row * columns + column."""
        return self.x.T.copy()


class PlainStep(Cloth):
    """One step on any spring list, written plainly."""

    name = "numpy, spring list, plain (add.at)"

    def __init__(self, sheet: Sheet) -> None:
        super().__init__(sheet)
        ends, stiffness, rest = [], [], []
        for shift, family_stiffness, family_rest in sheet.families():
            ends.append(ends_of(shift, self.index))
            stiffness.append(np.full(ends[-1][0].size, family_stiffness))
            rest.append(np.full(ends[-1][0].size, family_rest))
        self.first = np.concatenate([first for first, _second in ends])
        self.second = np.concatenate([second for _first, second in ends])
        self.stiffness, self.rest = np.concatenate(stiffness), np.concatenate(rest)

    def step(self) -> None:
        """Move on by one time step."""
        pull = self.x[:, self.second] - self.x[:, self.first]
        length = np.sqrt((pull**2).sum(axis=0))
        pull *= self.stiffness * (1.0 - self.rest / length)
        pull += self.sheet.damping * (self.v[:, self.second] - self.v[:, self.first])
        self.force = np.zeros_like(self.x)
        for force, values in zip(self.force, pull, strict=True):
            np.add.at(force, self.first, values)
            np.subtract.at(force, self.second, values)
        self.move()


def pull_into(
    pull: np.ndarray,
    scale: np.ndarray,
    scratch: np.ndarray,
    constants: tuple[np.ndarray, np.ndarray],
) -> None:
    """Turn differences of positions (m) in `pull` into elastic forces (N), with two buffers of one axis each."""
    stiffness, minus_stiffness_rest = constants
    np.multiply(pull[0], pull[0], out=scale)
    for axis in (1, 2):
        np.multiply(pull[axis], pull[axis], out=scratch)
        scale += scratch
    np.sqrt(scale, out=scale)
    np.divide(minus_stiffness_rest, scale, out=scale)
    scale += stiffness
    pull *= scale


class TunedStep(PlainStep):
    """One step on any spring list, without allocation."""

    name = "numpy, spring list, tuned (take, bincount)"

    def __init__(self, sheet: Sheet) -> None:
        super().__init__(sheet)
        count = self.first.size
        self.pull, self.drag, self.other = (np.empty((3, count)) for _ in range(3))
        self.scale = np.empty(count)
        self.constants = (self.stiffness, -self.stiffness * self.rest)

    def difference(self, values: np.ndarray, out: np.ndarray) -> None:
        """Write the second ends' values less the first ends' into `out`."""
        np.take(values, self.second, axis=1, out=out, mode="clip")
        np.take(values, self.first, axis=1, out=self.other, mode="clip")
        out -= self.other

    def step(self) -> None:
        """Move on by one time step."""
        self.difference(self.x, self.pull)
        pull_into(self.pull, self.scale, self.other[0], self.constants)
        self.difference(self.v, self.drag)
        self.drag *= self.sheet.damping
        self.pull += self.drag
        count = self.x.shape[1]
        for force, values in zip(self.force, self.pull, strict=True):
            np.subtract(
                np.bincount(self.first, values, count),
                np.bincount(self.second, values, count),
                out=force,
            )
        self.move()


class GridStep(Cloth):
    """One step on a grid by shifted views, without allocation."""

    name = "numpy, shifted views of a grid, tuned"

    def __init__(self, sheet: Sheet) -> None:
        super().__init__(sheet)
        self.families = []
        for shift, stiffness, rest in sheet.families():
            offset = shift[0] * sheet.vertices + shift[1]
            count = self.index.size - offset
            is_spring = np.zeros(self.index.size)
            is_spring[ends_of(shift, self.index)[0]] = 1.0
            is_spring = is_spring[:count]
            ends = [(a[:, :count], a[:, offset:]) for a in (self.x, self.v, self.force)]
            buffers = np.empty((3, count)), np.empty((3, count)), np.empty(count)
            constants = is_spring * stiffness, -is_spring * stiffness * rest
            self.families.append((ends, buffers, constants, is_spring * sheet.damping))

    def step(self) -> None:
        """Move on by one time step."""
        self.force.fill(0.0)
        for ((x0, x1), (v0, v1), (f0, f1)), (
            pull,
            drag,
            scale,
        ), constants, damping in self.families:
            np.subtract(x1, x0, out=pull)
            pull_into(pull, scale, drag[0], constants)
            np.subtract(v1, v0, out=drag)
            drag *= damping
            pull += drag
            np.add(f0, pull, out=f0)
            np.subtract(f1, pull, out=f1)
        self.move()


ALL_STEPS = (PlainStep, TunedStep, GridStep)
