"""Other simulators that pip installs, with the settings they were given. They run in an environment of their own."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from environment import ROOT, ensure_venv, exclusive

from . import cases

VENV = ROOT / ".venv-peers"
TIMEOUT = 170.0
"""s; a peer that takes longer is stopped."""

NO_BENDING = 1e-5
"""N·m; cloth so soft in bending does not carry the sheet."""


@dataclass(frozen=True)
class Peer:
    """A simulator, the module that runs it, its settings, and how they were chosen."""

    name: str
    module: str
    settings: dict[str, Any]
    note: str


def elastic(young: float) -> str:
    """MuJoCo's membrane of 1 mm."""
    return f'<elasticity young="{young}" poisson="0.2" thickness="1e-3" elastic2d="stretch"/>'


PEERS = (
    Peer(
        "MuJoCo flex, elastic, discrete",
        "mujoco_sheet",
        {"substeps": 2, "iterations": 50, "inside": elastic(1e7)},
        "2 steps a frame of its implicit integrator, 10 000 N/m: twenty times our springs; 500 N/m strains by 42 %",
    ),
    Peer(
        "MuJoCo flex, edge equality",
        "mujoco_sheet",
        {
            "substeps": 8,
            "iterations": 50,
            "inside": '<edge equality="true"/>',
        },
        "8 steps a frame, 50 iterations of CG; with 20 steps and stiffer constraints it blew up",
    ),
    Peer(
        "Newton, VBD",
        "newton_sheet",
        {
            "solver": "vbd",
            "substeps": 40,
            "iterations": 4,
            "material": {"tri_ke": 500.0, "tri_ka": 100.0, "tri_kd": 0.0, "edge_ke": 0.0},
        },
        "500 N/m; 40 steps of 4 iterations a frame; 10 of 10 (and 500 N/m against change of area) strained by over 1000 %",
    ),
    Peer(
        "Newton, Style3D",
        "newton_sheet",
        {
            "solver": "style3d",
            "substeps": 4,
            "iterations": 10,
            "material": {
                "tri_aniso_ke": [5000.0, 5000.0, 1000.0],
                "edge_aniso_ke": [NO_BENDING, NO_BENDING, NO_BENDING],
            },
        },
        "4 steps of 10 iterations, 5000 N/m: 500 N/m strains by 40 % at 4 of 4; it falls slowly (see its lowest point)",
    ),
)
LEFT_OUT = (
    "Newton's XPBD is left out: it moves all springs at once, without colours, and with twelve to a vertex "
    "the sheet blows up."
)


def install() -> None:
    """Make the environment of the peers, unless it is there.

    Raises:
        Failed, Missing: It cannot be made here.
    """
    with exclusive():
        ensure_venv(VENV, "requirements-peers.txt")


def rows(side: int, frames: int, seconds: float) -> list[dict[str, Any]]:
    """Every peer on a grid; no frame begins after some seconds."""
    found = []
    for peer in PEERS:
        arguments = {"side": side, "frames": frames, "seconds": seconds, **peer.settings}
        result = cases.ask(peer.module, arguments, timeout=TIMEOUT, venv=VENV)
        found.append(cases.row(peer.name, side, [result], threads="", note=peer.note))
    return found
