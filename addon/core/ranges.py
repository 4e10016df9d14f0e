"""Which damping suits an explicit integrator: the ranges that `scripts/explore.py --keep` measured."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any

FILE = Path(__file__).with_name("ranges.json")


@cache
def recommended() -> Mapping[str, Mapping[str, Any]]:
    """By integrator: damping_ratio ([lowest, highest]), and step_by_fastest: a step by 1/w_max, stable with all of them."""
    return json.loads(FILE.read_text(encoding="utf-8"))


def damping_ratio(stiffness: Sequence[float], damping: Sequence[float], step: float) -> float:
    """That of the fastest oscillation of springs, about.

    Args:
        stiffness: Of each spring (N/m).
        damping: Of each spring (N·s/m).
        step: The largest step (s) that Verlet bears with the same springs undamped, 2/w_max.
    """
    total = sum(stiffness)
    return sum(damping) / total / step if total > 0.0 and step > 0.0 else 0.0


def advice(integrator: str, damping_ratio: float) -> str:
    """What speaks against a damping ratio of the fastest oscillation, or nothing."""
    known = recommended().get(integrator)
    if known is None:
        return ""
    low, high = known["damping_ratio"]
    if damping_ratio > high:
        return (
            f"Damping ratio {damping_ratio:.2g} of the fastest oscillation: above {high:g} it costs more "
            "than half of this integrator's step: lower damping"
        )
    if damping_ratio < low:
        return (
            f"Damping ratio {damping_ratio:.2g} of the fastest oscillation: below {low:g} this integrator "
            "needs very short steps: raise damping, or take another"
        )
    return ""
