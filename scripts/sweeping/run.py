"""One run of a sweep: bake on one thread into a folder of its own, sum up the certificate, move it to its place.

A job and its outcome are plain data, which goes from process to process and from machine to machine.
"""

from __future__ import annotations

import contextlib
import os
import platform
import shutil
import subprocess
import sys
import tempfile
import time
import uuid
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, TypedDict

from .folder import Folder, drop_empty, is_alive, read_json

BLEND_BAKE = Path(__file__).with_name("blend_bake.py")
SECONDS_BETWEEN_LOOKS = 1.0


class Job(TypedDict):
    """What to bake."""

    run: str
    scene: str
    out: str
    session: str
    boucle: str
    overrides: list[str]
    parameters: dict[str, Any]
    frames: tuple[int, int] | None
    timeout: float | None
    blender: str | None


class Failed(Exception):
    """A run that cannot be baked; one sentence."""


class Gone(Exception):
    """The sweep has ended, or was taken up by another process."""


class Watch:
    """Ends a bake whose sweep is gone, or that takes too long."""

    def __init__(self, job: Job) -> None:
        self._session = Path(job["session"])
        self._timeout = job["timeout"]
        self._began = self._looked = time.monotonic()

    def look(self) -> None:
        """Look whether the bake should go on.

        Raises:
            Gone: The sweep has ended.
            Failed: The time is up.
        """
        now = time.monotonic()
        if self._timeout is not None and now - self._began > self._timeout:
            raise Failed(f"it took longer than the timeout of {self._timeout:g} s")
        if now - self._looked >= SECONDS_BETWEEN_LOOKS:
            self._looked = now
            if not is_alive(self._session):
                raise Gone


def perform(job: Job) -> dict[str, Any] | None:
    """Bake a run, unless it is there whole, and return what its run.json holds; nothing if the sweep is gone."""
    folder = Folder(Path(job["out"]))
    session = Path(job["session"])
    known = folder.whole(job["run"])
    if known is not None:
        return known
    if not is_alive(session):
        return outcome_of(
            job, f"{platform.node()} does not see {job['session']}: it needs {job['out']} shared"
        )
    part = session / f"{job['run']}.{uuid.uuid4().hex[:8]}"
    try:
        part.mkdir()
        sentence = _baked(job, part)
        for checkpoint in () if sentence else part.glob("*.checkpoint"):
            checkpoint.unlink()  # a whole run has nothing to go on from
        return folder.publish(part, job["run"], outcome_of(job, sentence, part))
    except Gone:
        return None
    except OSError as error:
        if not is_alive(session):
            return None
        return record_failure(job, f"its result cannot be written ({error})")
    finally:
        shutil.rmtree(part, ignore_errors=True)
        if not is_alive(session):
            drop_empty(session)


def _baked(job: Job, part: Path) -> str | None:
    """Bake into a folder and return the sentence that tells why it failed, if it did."""
    try:
        if Path(job["scene"]).suffix.lower() == ".blend":
            _bake_blend(job, part)
        else:
            _bake_scene(job, part)
    except Failed as failed:
        return str(failed)
    return None


def _bake_scene(job: Job, part: Path) -> None:
    try:
        import boucle_core as core
    except ImportError as error:
        raise Failed(f"boucle_core cannot be loaded on {platform.node()} ({error})") from error
    if core.__version__ != job["boucle"]:
        raise Failed(
            f"{platform.node()} has Boucle {core.__version__}; accepted: {job['boucle']}, "
            "that of the sweep"
        )
    watch = Watch(job)
    try:
        core.bake(
            job["scene"],
            str(part),
            frames=job["frames"],
            threads=1,
            overrides=job["overrides"],
            progress=lambda _step: watch.look(),
        )
    except core.CacheError as error:
        if not is_alive(Path(job["session"])):
            raise Gone from error
        raise Failed(str(error)) from error
    except core.BoucleError as error:
        raise Failed(str(error)) from error


def _bake_blend(job: Job, part: Path) -> None:
    words = [job["scene"], "--out", str(part), "--threads", "1", "--quiet"]
    if job["frames"]:
        words.append("--frames={}:{}".format(*job["frames"]))
    if job["blender"]:
        words += ["--blender", job["blender"]]
    if job["overrides"]:
        words += ["--set", *job["overrides"]]
    watch = Watch(job)
    with (
        tempfile.TemporaryFile() as said,
        subprocess.Popen(
            [sys.executable, str(BLEND_BAKE), *words],
            stdin=subprocess.PIPE,  # its end tells the bake that this process has died
            stdout=subprocess.DEVNULL,
            stderr=said,
        ) as process,
    ):
        try:
            while process.poll() is None:
                watch.look()
                with contextlib.suppress(subprocess.TimeoutExpired):
                    process.wait(SECONDS_BETWEEN_LOOKS / 5)
        finally:
            process.kill()
        said.seek(0)
        lines = said.read().decode(errors="replace").splitlines()
    if process.returncode != 0:
        raise Failed(_complaint(lines, process.returncode))


def _complaint(lines: Sequence[str], code: int) -> str:
    ours = [line.removeprefix("bake.py: ") for line in lines if line.startswith("bake.py: ")]
    if ours:
        return "; ".join(ours)
    last = [line for line in lines if line.strip()][-1:]
    return f"Blender ended with exit code {code}{''.join(f' ({line.strip()})' for line in last)}"


def record_failure(job: Job, sentence: str) -> dict[str, Any]:
    """Keep that a run failed without a bake to show, as far as the disk lets us, and return its outcome."""
    outcome = outcome_of(job, sentence)
    folder = Folder(Path(job["out"]))
    part = Path(job["session"]) / f"{job['run']}.{uuid.uuid4().hex[:8]}"
    try:
        part.mkdir()
        return folder.publish(part, job["run"], outcome)
    except OSError:
        return outcome  # the table has it all the same


def outcome_of(job: Job, sentence: str | None, part: Path | None = None) -> dict[str, Any]:
    """What run.json holds: the parameters, why it failed if it did, and the summed-up certificate."""
    report = read_json(part / "report.json") if part is not None else None
    return {
        "run": job["run"],
        "status": "failed" if sentence else "done",
        "error": " ".join(sentence.split()) if sentence else None,
        "parameters": job["parameters"],
        "overrides": job["overrides"],
        "certificate": certificate_of(report) if report else None,
        "boucle": job["boucle"],
        "host": platform.node(),
        "process": os.getpid(),
    }


def certificate_of(report: Mapping[str, Any]) -> dict[str, Any]:
    """A report's certificates in one row.

    Strains are the largest over the frames (`max_strain_frame` names the worst one), steps, iterations, clipped vertices and
    seconds are sums, `intersections` is that of the worst frame (null if nothing collides); energies (J), `hash` and
    `last_intersections` are those of the last frame.
    """
    rows = report["frames"]
    if not rows:
        return {"frames": 0}
    worst = max(rows, key=lambda row: _number(row, "max_strain"))
    counts = [row["intersections"] for row in rows if row.get("intersections") is not None]
    last = rows[-1]
    return {
        "frames": len(rows),
        "first_frame": rows[0]["frame"],
        "last_frame": last["frame"],
        "vertices": sum(cloth["vertices"] for cloth in report["cloths"]),
        "max_strain": worst["max_strain"],
        "max_strain_frame": worst["frame"],
        "p99_strain": max(_number(row, "p99_strain") for row in rows),
        "max_shear_strain": max(_number(row, "max_shear_strain") for row in rows),
        "overstretched_frames": sum(1 for row in rows if row.get("overstretched_count")),
        "intersections": max(counts, default=None),
        "last_intersections": last.get("intersections"),
        "clipped": sum(row.get("clipped") or 0 for row in rows),
        "substeps": sum(row["substeps"] for row in rows),
        "iterations": sum(row["iterations"] for row in rows),
        "kinetic_energy": last["kinetic_energy"],
        "potential_energy": last["potential_energy"],
        "hash": last["hash"],
        "seconds": report["total_seconds"],
    }


def _number(row: Mapping[str, Any], key: str) -> float:
    return row.get(key) or 0.0
