"""An inextensible strip on the bias, so narrow that it twists freely, clamped level at one end, under its own weight.

Its yarns bend unlike, so what bends it twists it, and the part of its weight that lies across it grows less: D1388 then reads
more than Peirce's mean. The strip is a chain of stiff pieces that bend and twist between each other, at its least energy.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import minimize
from scipy.spatial.transform import Rotation

PIECES = 40


def stiffness(warp: float, weft: float) -> np.ndarray:
    """(2, 2), of bending along the strip and of twice the twist, in units of Peirce's mean: no moment acts across."""
    # The moments along the yarns and between them, of M_xx and M_xy of the strip.
    moments = np.array([[0.5, 1.0], [0.5, -1.0], [-0.5, 0.0]])
    compliance = moments.T @ np.diag([1.0 / warp, 1.0 / weft, 2.0 / np.sqrt(warp * weft)]) @ moments
    return np.linalg.inv(compliance / compliance[0, 0])


def shape(bends: np.ndarray) -> np.ndarray:
    """(n + 1, 3), in lengths of the strip: where it is, from what each piece (n, 2) bends and twice what it twists by."""
    step = 1.0 / len(bends)
    turns = step * np.column_stack([0.5 * bends[:, 1], -bends[:, 0], np.zeros(len(bends))])
    frame, at = Rotation.identity(), [np.zeros(3)]
    for turn in turns:
        half = frame * Rotation.from_rotvec(0.5 * turn)
        at.append(at[-1] + step * half.apply([1.0, 0.0, 0.0]))
        frame = half * Rotation.from_rotvec(0.5 * turn)
    return np.array(at)


def chord(warp: float, weft: float, gamma: float) -> float:
    """The angle (degrees) below the level of the line from its clamp to its tip, given its weight L³/B of Peirce's B."""
    step = 1.0 / PIECES
    along = (np.arange(PIECES) + 0.5) * step
    elastic = stiffness(warp, weft)
    weights = np.full(PIECES + 1, step)
    weights[[0, -1]] *= 0.5

    def energy(flat: np.ndarray) -> float:
        bends = flat.reshape(-1, 2)
        stored = 0.5 * step * np.einsum("ij,jk,ik->", bends, elastic, bends)
        return float(stored + gamma * weights @ shape(bends)[:, 2])

    bent = -0.35 * gamma * (1.0 - along) ** 2
    start = np.column_stack([bent, np.zeros(PIECES)])
    found = minimize(energy, start.ravel(), method="L-BFGS-B", options={"maxfun": 10**6})
    tip = shape(found.x.reshape(-1, 2))[-1]
    return float(np.degrees(np.arctan2(-tip[2], tip[0])))
