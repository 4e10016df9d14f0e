"""Tables that no code of this project made, and where they come from."""

from __future__ import annotations

import csv
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TABLES = ROOT / "rust" / "solver" / "tests" / "validation" / "reference"

INTEGRATORS = "integrators_sho.csv"
LATTICES = "lattice_stability.csv"
CHAINS = "hanging_chain_modes.csv"
ELASTICA = "heavy_elastica_cantilever.csv"
PROFILES = "heavy_elastica_profiles.csv"

SOURCES = {
    INTEGRATORS: "eigenvalues of each rule's 2 x 2 matrix on x'' = -x, computed with numpy (integrators_sho.csv)",
    LATTICES: "Fourier symbol of the infinite lattice and dense eigenvalues of the free 16 x 16 one, numpy "
    "(lattice_stability.csv)",
    CHAINS: "zeros of the Bessel function J0 and dense eigenvalues of chains, scipy (hanging_chain_modes.csv)",
    ELASTICA: "boundary value problem theta'' = -Gamma (1-s) cos(theta), scipy's solve_bvp, checked by shooting "
    "(heavy_elastica_cantilever.csv)",
}

folder = TABLES
"""Where the tables are read; `validate.py --tables` names another."""


def table(name: str) -> list[dict[str, str]]:
    """The rows of a table, cells by column name."""
    text = (folder / name).read_text(encoding="utf-8")
    lines = [line for line in text.splitlines() if line and not line.startswith("#")]
    return list(csv.DictReader(lines))
