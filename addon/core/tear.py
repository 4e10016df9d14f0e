"""When a cloth tears: the keys of `[cloth.tear]`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from .refusal import Refusal
from .shape import decimal

THRESHOLDS = {
    "tear_stress": "stress",
    "tear_force": "force",
    "tear_strain": "strain",
    "seam_force": "seam_force",
}
"""Settings of which 0 means never, and their keys."""


class TearGroups(NamedTuple):
    """What vertex groups say of it."""

    strength: Sequence[float] = ()
    """The part of the thresholds that holds at each vertex; all of them hold in full if it is empty."""
    openings: Sequence[tuple[int, int]] | None = None
    """Both vertices of each edge and seam that opens by itself; None where they were not asked for."""


def describe(name: str, values: Mapping[str, Any], groups: TearGroups) -> dict[str, Any]:
    """The keys of one cloth; none where it does not tear.

    Raises:
        Refusal: Nothing says when it tears, or it is to open before it moves.
    """
    if not values.get("use_tear"):
        return {}
    out: dict[str, Any] = {"enabled": True}
    out.update({key: decimal(values[of]) for of, key in THRESHOLDS.items() if values[of] > 0.0})
    if values["tear_opening_group"]:
        out["openings"] = [_opening(name, values, groups)]
    if len(out) == 1:
        raise Refusal(
            f'"{name}": Tearing is on, but nothing says when it tears: set a Stress, Force, Strain or Seam '
            "Force above 0, or an Opening Group"
        )
    if values["tear_noise"] > 0.0:
        out["noise"] = decimal(values["tear_noise"])
        out["seed"] = int(values["tear_seed"])
    if groups.strength:
        out["strength"] = list(groups.strength)
    if values.get("settle_frames"):  # what settles is not yet seen, and must not come torn
        out["start"] = int(values["frame_start"]) + 1
    return out


def _opening(name: str, values: Mapping[str, Any], groups: TearGroups) -> dict[str, Any]:
    frame, start = int(values["tear_opening_frame"]), int(values["frame_start"])
    if frame <= start:
        raise Refusal(
            f'"{name}": Opening Frame is {frame}, and the cloth begins at frame {start}: choose a later frame'
        )
    if groups.openings is None:
        return {"frame": frame}
    if not groups.openings:
        raise Refusal(
            f'"{name}": no edge has both of its ends in the Opening Group "{values["tear_opening_group"]}": '
            "put the ends of those that open into it"
        )
    return {"frame": frame, "pairs": [list(pair) for pair in groups.openings]}
