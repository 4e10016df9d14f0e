"""What must stay as it is over a long run: memory, speed, results."""

from __future__ import annotations

import statistics
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

FLAT = 0.01
"""By which part memory may change once it is warm."""
STEADY = 0.03
"""By which part the time of the same frames may change, beyond what chance explains."""
WARM = 0.1
"""Part of the rounds in which memory is still filled for the first time."""
SURE = 3.0
"""Standard errors that chance explains."""
ENOUGH = 20
"""Rounds before anything is said of memory and speed."""


def resident_bytes() -> int:
    """Memory that this process holds now, without that of files, which the system may take and bring back."""
    status = Path("/proc/self/status").read_text(encoding="ascii")
    line = next(line for line in status.splitlines() if line.startswith("RssAnon:"))
    return 1024 * int(line.split()[1])


def gauge() -> float:
    """Seconds of processor time that a fixed piece of work takes now: others on the machine slow it as they slow us."""
    begin = time.process_time()
    total = 0
    for number in range(400_000):
        total += number * number % 7
    return time.process_time() - begin


@dataclass
class Runs:
    """All runs of one scene."""

    hashes: tuple[str, ...] = ()
    seconds: list[float] = field(default_factory=list)
    """Processor time of each run."""
    gauges: list[float] = field(default_factory=list)
    """What the fixed piece of work took beside each."""
    frames: int = 0

    @property
    def drift(self) -> tuple[float, float]:
        """The change from the first tenth of the runs to the last as a part, and what chance explains of it."""
        times = [one / unit for one, unit in zip(self.seconds, self.gauges, strict=True)]
        tenth = max(1, len(times) // 10)
        first, last = times[:tenth], times[-tenth:]
        middle = statistics.median(times)
        spread = 1.4826 * statistics.median(abs(value - middle) for value in times)
        # A median of n has 1.25 times the standard error of their mean, and there are two.
        chance = SURE * 1.25 * spread * (2.0 / tenth) ** 0.5
        return statistics.median(last) / statistics.median(first) - 1.0, chance / middle


@dataclass
class Watch:
    """What was seen so far, and what of it must not be."""

    runs: dict[str, Runs] = field(default_factory=dict)
    memory: list[int] = field(default_factory=list)
    """Bytes after each round."""
    wrong: list[str] = field(default_factory=list)

    @property
    def frames(self) -> int:
        """Simulated so far."""
        return sum(runs.frames for runs in self.runs.values())

    def add(
        self, name: str, rows: Sequence[Mapping[str, Any]], seconds: float, unit: float
    ) -> None:
        """Look at a run of a scene: rows of its report, its time, and that of the gauge beside it."""
        runs = self.runs.setdefault(name, Runs())
        hashes = tuple(str(row["hash"]) for row in rows)
        runs.hashes = runs.hashes or hashes
        runs.seconds.append(seconds)
        runs.gauges.append(unit)
        runs.frames += len(rows)
        number = len(runs.seconds)
        if hashes != runs.hashes:
            self._tell(f"{name}, run {number}: other hashes than in the first run")
        crossed = sum(row["intersections"] or 0 for row in rows)
        if crossed:
            self._tell(f"{name}, run {number}: {crossed} intersections")

    def _tell(self, sentence: str) -> None:
        """Keep what is wrong, and say it at once: the end may be far."""
        self.wrong.append(sentence)
        print(sentence, flush=True)

    @property
    def warm_memory(self) -> list[int]:
        """Bytes after each round since it was warm."""
        return self.memory[int(WARM * len(self.memory)) :]

    @property
    def swing(self) -> float:
        """By which part memory changed since then."""
        warm = self.warm_memory
        return max(warm) / min(warm) - 1.0 if warm else 0.0

    def verdicts(self) -> list[str]:
        """All that is not as it must be, in sentences."""
        found = list(self.wrong)
        if len(self.memory) >= ENOUGH and self.swing > FLAT:
            found.append(f"memory changed by {self.swing:.2%}; at most {FLAT:.0%} is flat")
        for name, runs in self.runs.items():
            drift, chance = runs.drift
            if len(runs.seconds) >= ENOUGH and drift > max(STEADY, chance):
                found.append(f"{name} became slower by {drift:.1%}; chance explains {chance:.1%}")
        return found

    def table(self) -> str:
        """A row for each scene."""
        lines = ["scene                 runs   frames  ms/frame   drift  chance"]
        for name, runs in self.runs.items():
            drift, chance = runs.drift
            each = (
                1000.0 * statistics.median(runs.seconds) * len(runs.seconds) / max(1, runs.frames)
            )
            lines.append(
                f"{name:20} {len(runs.seconds):5} {runs.frames:8} {each:9.1f} {drift:+7.1%} {chance:7.1%}"
            )
        memory = [round(value / 1e6, 1) for value in self.warm_memory] or [0.0]
        lines.append(
            f"{self.frames} frames; memory {min(memory)} to {max(memory)} MB ({self.swing:.2%}) in the last "
            f"{len(memory)} rounds"
        )
        return "\n".join(lines)
