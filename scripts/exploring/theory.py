"""The largest stable step of a flat sheet by theory, from its stiffness matrix and the integrators' amplification.

Around the flat rest shape springs of stiffness k along n move the sheet as `M x'' = -K x - b K x'`, with `K = sum k n nT` and
b = kd/k (axial damping, the same for all springs). Its modes are oscillators

    x'' = -w² x - b w² x'        w² an eigenvalue of K/M

and a step is stable if no mode grows. Without damping that is h <= 2/w_max for symplectic Euler, Verlet and leapfrog,
h <= 2 sqrt(2)/w_max for the classic Runge-Kutta rule, and no step for forward Euler and the midpoint rule.

Source: Hairer, Lubich & Wanner 2006, chapter I; the matrices are written from the integrators' definitions, not read from the
module.
"""

from __future__ import annotations

import math
from functools import cache

import numpy as np

from .sheet import Lattice, Mesh, grid, springs_of

UNDAMPED_LIMIT = {
    "symplectic_euler": 2.0,
    "verlet": 2.0,
    "leapfrog": 2.0,
    "rk4": 2.0 * math.sqrt(2.0),
}
"""Largest stable w h without damping; the other explicit integrators have none."""
EXPLICIT = ("forward_euler", "symplectic_euler", "verlet", "leapfrog", "midpoint", "rk4")


def stiffness_matrix(mesh: Mesh, ends: np.ndarray, stiffness: np.ndarray) -> np.ndarray:
    """K = sum k n nT at rest, (3 n, 3 n)."""
    count = len(mesh.positions)
    along = mesh.positions[ends[:, 1]] - mesh.positions[ends[:, 0]]
    along = along / np.linalg.norm(along, axis=1, keepdims=True)
    matrix = np.zeros((count, 3, count, 3))
    for (a, b), k, n in zip(ends, stiffness, along, strict=True):
        block = k * np.outer(n, n)
        matrix[a, :, a, :] += block
        matrix[b, :, b, :] += block
        matrix[a, :, b, :] -= block
        matrix[b, :, a, :] -= block
    return matrix.reshape(3 * count, 3 * count)


def eigenvalues(mesh: Mesh, lattice: Lattice) -> np.ndarray:
    """Eigenvalues of K for stiffnesses as multiples of 1 N/m, all those above zero, growing."""
    values = np.linalg.eigvalsh(stiffness_matrix(mesh, *springs_of(mesh, lattice)))
    return values[values > 1e-9 * values[-1]]


@cache
def grid_eigenvalues(lattice: Lattice) -> np.ndarray:
    """The same of the grid that is run by the thousand."""
    return eigenvalues(grid(), lattice)


def amplification(integrator: str, w_squared: np.ndarray, c: np.ndarray, h: float) -> np.ndarray:
    """The matrices by which a step multiplies (x, v) of x'' = -w² x - c x', (n, 2, 2)."""
    one, zero = np.ones_like(w_squared), np.zeros_like(w_squared)
    unit = np.stack([one, zero, zero, one], axis=-1).reshape(-1, 2, 2)

    def kick(part: float) -> np.ndarray:
        entries = [one, zero, -part * h * w_squared, one - part * h * c]
        return np.stack(entries, axis=-1).reshape(-1, 2, 2)

    def drift(part: float) -> np.ndarray:
        return np.stack([one, part * h * one, zero, one], axis=-1).reshape(-1, 2, 2)

    rates = h * np.stack([zero, one, -w_squared, -c], axis=-1).reshape(-1, 2, 2)
    match integrator:
        case "symplectic_euler":
            return drift(1.0) @ kick(1.0)
        case "verlet":
            return kick(0.5) @ drift(1.0) @ kick(0.5)
        case "leapfrog":
            return drift(0.5) @ kick(1.0) @ drift(0.5)
    terms = {"forward_euler": 1, "midpoint": 2, "rk4": 4}[integrator]
    total, power = unit, unit
    for number in range(1, terms + 1):
        power = power @ rates / number
        total = total + power
    return total


def spectral_radius(matrices: np.ndarray) -> np.ndarray:
    """Largest absolute eigenvalue of each."""
    return np.abs(np.linalg.eigvals(matrices)).max(axis=-1)


def largest_step(integrator: str, w_squared: np.ndarray, damping_time: float) -> float:
    """The largest stable step (s) of oscillators (1/s²) that are damped by kd/k (s); 0 if there is none."""
    w_max = math.sqrt(w_squared[-1])
    if damping_time == 0.0:
        return UNDAMPED_LIMIT.get(integrator, 0.0) / w_max

    def is_stable(h: float) -> bool:
        matrices = amplification(integrator, w_squared, damping_time * w_squared, h)
        return bool(spectral_radius(matrices).max() <= 1.0 + 1e-12)

    # From a step so small that every rule follows the damping: the first loss of stability is the boundary.
    low = 1e-4 / max(w_max, damping_time * w_squared[-1])
    high = low
    while is_stable(high):
        low, high = high, 1.1 * high
    for _ in range(40):
        middle = math.sqrt(low * high)
        low, high = (middle, high) if is_stable(middle) else (low, middle)
    return low
