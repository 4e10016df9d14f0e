"""The table of a sweep: a row for each run with its parameters, whether it is whole, and its certificate."""

from __future__ import annotations

import csv
import json
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from .description import Sweep

FIRST = ("run", "status", "error")
CERTIFICATE = {
    "frames": int,
    "first_frame": int,
    "last_frame": int,
    "vertices": int,
    "max_strain": float,
    "max_strain_frame": int,
    "p99_strain": float,
    "max_shear_strain": float,
    "overstretched_frames": int,
    "intersections": int,
    "last_intersections": int,
    "clipped": int,
    "substeps": int,
    "iterations": int,
    "kinetic_energy": float,
    "potential_energy": float,
    "hash": str,
    "seconds": float,
}
"""Columns of the summed-up certificate and their kinds; see `run.certificate_of`."""
KINDS = ("parquet", "csv")


def rows_of(sweep: Sweep, outcomes: Mapping[str, Mapping[str, Any] | None]) -> list[dict[str, Any]]:
    """A row for each run in the plan's order; a run that has not ended is "missing"."""
    rows = []
    for run in sweep.runs:
        outcome = outcomes.get(run.name) or {"status": "missing", "error": None}
        row = {"run": run.name, "status": outcome["status"], "error": outcome["error"]}
        row |= {_column(key): run.parameters.get(key) for key in sweep.parameters}
        certificate = outcome.get("certificate") or {}
        row |= {key: certificate.get(key) for key in CERTIFICATE}
        rows.append(row)
    return rows


def _column(key: str) -> str:
    """A parameter's column; none of its names is one of ours."""
    return f"parameter.{key}" if key in {*FIRST, *CERTIFICATE} else key


def write(folder: Path, kind: str, rows: Sequence[Mapping[str, Any]]) -> Path:
    """Write the table as `table.parquet` or `table.csv`, the old one or the new one, whole; return where it is.

    Numbers, truths and texts stand as they are, a parameter of mixed kinds, of lists or tables as JSON text.

    Raises:
        OSError: It cannot be written.
    """
    path = folder / f"table.{kind}"
    part = path.with_name(f"{path.name}.part")
    columns = {key: _uniform([row[key] for row in rows]) for key in rows[0]}
    (_write_parquet if kind == "parquet" else _write_csv)(part, columns)
    os.replace(part, path)
    return path


def _uniform(values: Sequence[Any]) -> list[Any]:
    kinds = {type(value) for value in values if value is not None}
    if kinds == {int, float}:
        return [None if value is None else float(value) for value in values]
    if len(kinds) <= 1 and kinds <= {int, float, str, bool}:
        return list(values)
    return [None if v is None else json.dumps(v, ensure_ascii=False) for v in values]


def _write_csv(path: Path, columns: Mapping[str, Sequence[Any]]) -> None:
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(columns)
        for row in zip(*columns.values(), strict=True):
            writer.writerow([str(v).lower() if isinstance(v, bool) else v for v in row])


def _write_parquet(path: Path, columns: Mapping[str, Sequence[Any]]) -> None:
    import pyarrow
    import pyarrow.parquet

    kinds = {int: pyarrow.int64(), float: pyarrow.float64(), str: pyarrow.string()}
    arrays = {}
    for key, values in columns.items():
        kind = CERTIFICATE.get(key, str if key in FIRST else None)
        if kind is float:
            values = [None if value is None else float(value) for value in values]
        arrays[key] = pyarrow.array(values, type=kinds[kind] if kind else None)
    pyarrow.parquet.write_table(pyarrow.table(arrays), path)
