"""The packages that sweeps take beside those of every script: installed into .venv when they are first needed."""

from __future__ import annotations

import argparse
import importlib.util
import sys

import environment

from . import table

REQUIREMENTS = "requirements-sweep.txt"


class Missing(Exception):
    """A package is missing; one sentence with what to do."""


def require(options: argparse.Namespace) -> None:
    """See to it that what the options need is there; choose the kind of table if they do not.

    Raises:
        Missing: It is not, and this Python is not that of .venv, where we may install it.
    """
    if options.scheduler:
        _require("distributed", f"--scheduler {options.scheduler}")
    if options.table == "parquet":
        _require("pyarrow", "--table parquet")
    if options.table is None:
        options.table = table.KINDS[0 if importlib.util.find_spec("pyarrow") else 1]


def _require(package: str, option: str) -> None:
    if importlib.util.find_spec(package):
        return
    advice = f"pip install -r scripts/{REQUIREMENTS}"
    if sys.prefix != str(environment.VENV):
        raise Missing(f"{option} needs {package}, which this Python lacks: {advice}")
    try:
        with environment.exclusive():
            environment.ensure_venv(environment.VENV, "requirements.txt", REQUIREMENTS)
    except (environment.Failed, environment.Missing) as error:
        raise Missing(f"{option} needs {package}, which cannot be installed ({error})") from error
    importlib.invalidate_caches()
    if not importlib.util.find_spec(package):
        raise Missing(f"{option} needs {package}, which is still missing: {advice}")
