"""One bake at a time in a folder.

The lock is the system's own on the file `boucle.lock`, so that it goes with its process, however that ends; the file holds
the process's number for the other one to name, and is taken away in the end.
"""

from __future__ import annotations

import contextlib
import errno
import os
from collections.abc import Iterator
from pathlib import Path

NAME = "boucle.lock"
_TAKEN = {errno.EACCES, errno.EAGAIN, errno.EDEADLK}
_FAR = 1 << 20
"""Where Windows locks: beyond the text, which others could not read otherwise."""


class Busy(Exception):
    """Another process bakes into the folder; one sentence."""


@contextlib.contextmanager
def held(folder: Path) -> Iterator[None]:
    """Hold a folder, made if missing, for as long as the bake takes; leave none behind that stayed empty.

    Where no lock can be had (the folder cannot be made, its file system knows no locks) there is none: what is wrong
    with the folder is for the bake to say.

    Raises:
        Busy: Another process holds it.
    """
    missing = [parent for parent in (folder, *folder.parents) if not parent.exists()]
    lock = _take(folder)
    try:
        yield
    finally:
        if lock is not None:
            _give_back(lock, folder / NAME)
        with contextlib.suppress(OSError):
            for made in missing:
                made.rmdir()


def _take(folder: Path) -> int | None:
    path = folder / NAME
    for _ in range(100):
        try:
            folder.mkdir(parents=True, exist_ok=True)
            lock = os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
        except (FileNotFoundError, FileExistsError):
            continue  # another bake has just taken the empty folder away: before the file was made, or while we looked
        except OSError:
            return None
        try:
            _lock(lock)
            if _is_at(lock, path):
                os.ftruncate(lock, 0)
                os.write(lock, str(os.getpid()).encode())
                return lock
        except OSError as error:
            os.close(lock)
            if error.errno not in _TAKEN:
                return None
            raise Busy(
                f"{folder} is being baked into by {_owner(path)}; accepted: another folder, or "
                "waiting for its end"
            ) from error
        os.close(lock)  # the bake before took the file away just now: the lock was on nothing
    return None


def _owner(path: Path) -> str:
    try:
        number = int(path.read_bytes())
    except (OSError, ValueError):
        return "another process"
    return f"process {number}"


def _give_back(lock: int, path: Path) -> None:
    """Take the file away: elsewhere while it is locked; in Windows after, where nothing that is open can be taken away."""
    with contextlib.suppress(OSError):
        if os.name == "nt":
            os.close(lock)
            os.unlink(path)
        else:
            os.unlink(path)
            os.close(lock)


if os.name == "nt":
    import msvcrt

    def _lock(lock: int) -> None:
        os.lseek(lock, _FAR, os.SEEK_SET)
        msvcrt.locking(lock, msvcrt.LK_NBLCK, 1)
        os.lseek(lock, 0, os.SEEK_SET)

    def _is_at(_lock: int, _path: Path) -> bool:
        return True  # an open file cannot be taken away

else:
    import fcntl

    def _lock(lock: int) -> None:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)

    def _is_at(lock: int, path: Path) -> bool:
        try:
            return os.path.samestat(os.fstat(lock), os.stat(path))
        except FileNotFoundError:
            return False
