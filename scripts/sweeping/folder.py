"""The result folder of a sweep.

```text
OUT/sweep.json          what is swept, by which `--resume` knows it again
OUT/runs/NAME/          a whole run: caches, meshes, report.json, and run.json, which names them with their sizes
OUT/failed/NAME/        a run that failed: its frames so far, and run.json with the sentence that tells why
OUT/parts/SESSION/      bakes under way, and `alive`; a bake whose session is no longer alive stops
OUT/table.*, OUT/contact_sheet*.png
```

A run is baked in `parts` and moved to `runs` by one rename, so that it is there whole or not at all.
"""

from __future__ import annotations

import contextlib
import json
import os
import shutil
import uuid
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

SWEEP, RUN, ALIVE = "sweep.json", "run.json", "alive"


class Other(Exception):
    """The folder holds something that this sweep must not touch; one sentence."""


class Folder:
    """The result folder of a sweep."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.runs = path / "runs"
        self.failed = path / "failed"
        self.parts = path / "parts"

    def prepare(self, head: Mapping[str, Any], resume: bool) -> None:
        """Make the folder ready for a sweep, or for the rest of it.

        Args:
            head: What is kept as sweep.json; `digest` and `boucle` tell sweeps apart.
            resume: Go on with what is there.

        Raises:
            Other: It holds runs and `resume` is not asked for, or those of another sweep.
            OSError: It cannot be written.
        """
        known = read_json(self.path / SWEEP)
        if not (self.runs.is_dir() and any(self.runs.iterdir())):
            known = None  # nothing is lost if another sweep begins here
            shutil.rmtree(self.failed, ignore_errors=True)
        elif known is None:
            raise Other(f"{self.path} holds runs of no known sweep; accepted: another folder")
        elif not resume:
            raise Other(
                f"{self.path} holds a sweep; accepted: --resume to go on, or another folder"
            )
        if known is not None and known.get("boucle") != head["boucle"]:
            raise Other(
                f"{self.path} was begun by Boucle {known.get('boucle')} and this is "
                f"{head['boucle']}; accepted: the same version, or another folder"
            )
        if known is not None and known.get("digest") != head["digest"]:
            raise Other(
                f"{self.path} holds another sweep, or its scene has changed since; accepted: "
                "another folder"
            )
        for folder in (self.runs, self.failed, self.parts):
            folder.mkdir(parents=True, exist_ok=True)
        for old in list(self.parts.iterdir()):
            end_session(old)  # what still bakes there stops
        if known is None:
            replace_json(self.path / SWEEP, head)

    @contextlib.contextmanager
    def session(self) -> Iterator[Path]:
        """The folder of the bakes of this process; when it goes, so do they."""
        path = self.parts / uuid.uuid4().hex[:12]
        path.mkdir(parents=True)
        (path / ALIVE).touch()
        try:
            yield path
        finally:
            end_session(path)
            with contextlib.suppress(OSError):
                self.failed.rmdir()

    def whole(self, name: str) -> dict[str, Any] | None:
        """What a run that is whole has kept in its run.json; nothing if it is not there or torn."""
        folder = self.runs / name
        outcome = read_json(folder / RUN)
        if outcome is None or outcome.get("status") != "done":
            return None
        for file, size in outcome.get("files", {}).items():
            try:
                if (folder / file).stat().st_size != size:
                    return None
            except OSError:
                return None
        return outcome

    def outcome(self, name: str) -> dict[str, Any] | None:
        """What became of a run so far."""
        return self.whole(name) or read_json(self.failed / name / RUN)

    def drop_torn(self, name: str) -> None:
        """Take away what lies where a run belongs without being whole."""
        if self.whole(name) is None:
            shutil.rmtree(self.runs / name, ignore_errors=True)

    def publish(self, part: Path, name: str, outcome: dict[str, Any]) -> dict[str, Any]:
        """Move a finished bake to its place, unless another one was faster, and return what is there.

        Raises:
            OSError: It cannot be written.
        """
        files = {path.name: path.stat().st_size for path in sorted(part.iterdir())}
        outcome = {**outcome, "files": files}
        replace_json(part / RUN, outcome)
        is_done = outcome["status"] == "done"
        target = (self.runs if is_done else self.failed) / name
        target.parent.mkdir(parents=True, exist_ok=True)
        if not is_done:
            earlier = self.whole(name)
            if earlier is not None:
                return earlier
            shutil.rmtree(target, ignore_errors=True)
        try:
            os.rename(part, target)
        except OSError:
            earlier = self.outcome(name)
            if earlier is None:
                raise
            return earlier
        if is_done:
            shutil.rmtree(self.failed / name, ignore_errors=True)
        return outcome


def is_alive(session: Path) -> bool:
    """Whether the process that began a session still wants its bakes."""
    return (session / ALIVE).is_file()


def end_session(session: Path) -> None:
    """Take a session away, and the folder of sessions with the last one.

    A bake under way may write while its folder goes, and so leave some of it: without `alive` the bake stops at its next look,
    and takes away what is left.
    """
    with contextlib.suppress(OSError):
        (session / ALIVE).unlink()
    shutil.rmtree(session, ignore_errors=True)
    drop_empty(session)


def drop_empty(session: Path) -> None:
    """Take a session's folder away if nothing is left in it, and the folder of sessions with the last one."""
    with contextlib.suppress(OSError):
        session.rmdir()
    with contextlib.suppress(OSError):
        session.parent.rmdir()


def read_json(path: Path) -> dict[str, Any] | None:
    """A JSON object from a file; nothing if it is not there or torn."""
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    return content if isinstance(content, dict) else None


def replace_json(path: Path, content: Mapping[str, Any]) -> None:
    """Write a JSON object so that the file is the old one or the new one, whole."""
    part = path.with_name(f"{path.name}.{uuid.uuid4().hex[:8]}.part")
    with part.open("w", encoding="utf-8") as file:
        json.dump(content, file, indent=1, allow_nan=False)
        file.write("\n")
        file.flush()
        os.fsync(file.fileno())
    os.replace(part, path)
