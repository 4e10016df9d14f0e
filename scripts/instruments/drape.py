"""The Cusick drape test, ISO 9073-9: a disc of cloth lies between two smaller plates, and what hangs over casts a shadow.

    DC = 100 % (shadow - plates)/(disc - plates)         disc 30 cm, plates 18 cm across

The cloth is held as far as the plates reach; their rim is a circle of vertices. It starts flat but for soft waves, another
specimen with others, falls as in the lab, and then comes to rest. How it falls matters: a hanging disc has many shapes in which
it can rest, and one that sinks through thick air stays in a stiffer one than cloth that drops.

Cloth does not touch itself here; `intersections` tells whether folds would have met.
"""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from functools import cached_property

import boucle_core
import numpy as np
from scipy.signal import find_peaks

from .cutting import Kind, annulus, norm
from .fabric import GRAVITY, Fabric
from .resting import Load, Resting, Specimen, fall, settle

DISC = 0.15
"""Radius (m) of the specimen."""
PLATE = 0.09
"""Radius (m) of the plates."""
COARSE, FINE = 0.01, 0.007
"""Edge lengths (m). On coarser meshes than these the softest silk, and sheets without yarns, fold less than they should."""
PIXEL = 2.5e-4
"""m, of the shadow."""
WAVES = range(2, 10)
"""How many of each wave go around."""
HEIGHT = 1e-3
"""Root mean square of the waves (m) along the rim."""
FALL = 0.5
"""s."""
THIN_AIR = 1.0
"""1/s, while it falls."""
STEP = 1e-3
"""s."""
LEFT = 5e-3
"""The unbalanced force at which it rests, as a part of its weight: the coefficient then moves by less than a tenth."""
NODE = 0.05
"""By how much of its overhang the rim must stand out to be a node."""


@dataclass(frozen=True)
class Drape:
    """A specimen that hangs."""

    resting: Resting
    shadow: np.ndarray
    """The top view in pixels, True where the cloth or the plates are, from the lower left."""
    intersections: int
    """Of edges and triangles of the cloth."""

    @property
    def coefficient(self) -> float:
        """DC (%)."""
        plates = np.pi * PLATE**2
        return float(100.0 * (self.shadow.sum() * PIXEL**2 - plates) / (np.pi * DISC**2 - plates))

    @cached_property
    def nodes(self) -> int:
        """How many folds stand out along the rim."""
        rest = self.resting.specimen.cut.points
        rim = np.flatnonzero(norm(rest) > DISC - 1e-9)
        rim = rim[np.argsort(np.arctan2(rest[rim, 1], rest[rim, 0]))]
        radius = norm(self.resting.positions[rim])
        start = int(np.argmin(radius))
        around = np.concatenate([radius[start:], radius[: start + 1]])
        return len(find_peaks(around, prominence=NODE * (DISC - PLATE))[0])


def measure(fabric: Fabric, edge: float = COARSE, kind: Kind = "grid", specimen: int = 1) -> Drape:
    """Drape a specimen.

    Args:
        fabric: What is measured.
        edge: Length (m) of the mesh's edges.
        kind: Of the mesh.
        specimen: Its number: each starts with other waves.

    Raises:
        Restless: It does not come to rest.
    """
    cut = annulus(DISC, PLATE, edge, kind)
    held = np.flatnonzero(norm(cut.points) < PLATE + 1e-9)
    sample = Specimen(fabric, cut, held)
    weight = fabric.weight * np.pi * (DISC**2 - PLATE**2)
    load = Load(weight, weight * (DISC - PLATE), gravity=GRAVITY, step=STEP, left=LEFT)
    dropped = fall(sample, waved(cut.points, specimen), replace(load, air=THIN_AIR), FALL)
    resting = settle(sample, dropped, load)
    return Drape(resting, shadow(resting.positions, cut.triangles), crossings(sample, resting))


def waved(points: np.ndarray, specimen: int) -> np.ndarray:
    """The disc (m) with soft waves along its rim, which fade towards the plates."""
    dice = np.random.default_rng(specimen)
    angle = np.arctan2(points[:, 1], points[:, 0])
    out = np.clip((norm(points) - PLATE) / (DISC - PLATE), 0.0, None)
    height = np.zeros(len(points))
    for count in WAVES:
        a, b = dice.normal(size=2)
        height += a * np.cos(count * angle) + b * np.sin(count * angle)
    return np.column_stack([points, HEIGHT / np.sqrt(len(WAVES)) * out**2 * height])


def shadow(positions: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """The top view of triangles (m) and of the plates: pixels whose middle one of them covers."""
    half = round(1.02 * DISC / PIXEL)
    middles = (np.arange(-half, half) + 0.5) * PIXEL
    seen = np.hypot(*np.meshgrid(middles, middles)) < PLATE
    corners = positions[triangles, :2]
    low = np.floor(corners.min(axis=1) / PIXEL - 0.5).astype(int) + half
    high = np.ceil(corners.max(axis=1) / PIXEL + 0.5).astype(int) + half
    for (a, b, c), (left, bottom), (right, top) in zip(corners, low, high, strict=True):
        x, y = np.meshgrid(middles[left:right], middles[bottom:top])
        turns = [
            (q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0])
            for p, q in ((a, b), (b, c), (c, a))
        ]
        least, most = np.minimum.reduce(turns), np.maximum.reduce(turns)
        seen[bottom:top, left:right] |= (least >= 0.0) | (most <= 0.0)
    return seen


def crossings(sample: Specimen, resting: Resting) -> int:
    """How many edges and triangles of the cloth at rest pass through each other."""
    corners = np.ascontiguousarray(sample.cut.faces, dtype=np.int32)
    starts = np.arange(0, corners.size, corners.shape[1], dtype=np.int32)
    cloth = {"name": "specimen", "density": sample.fabric.number("density")}
    scene = json.dumps({"cloth": [cloth], "collision": {"self": True, "thickness": PIXEL}})
    mesh = (resting.positions, starts, corners.reshape(-1))
    return int(boucle_core.Simulation(scene, [mesh], 1).certificate()["intersections"])
