"""Bakes a .blend for a sweep as bake.py does, in a process that ends when the one that started it does."""

from __future__ import annotations

import os
import sys
import threading
from pathlib import Path


def end_with_parent() -> None:
    """End this process at once when standard input, which the parent never writes to, is closed."""

    def wait() -> None:
        sys.stdin.buffer.read()
        os._exit(130)

    threading.Thread(target=wait, daemon=True).start()


if __name__ == "__main__":
    end_with_parent()
    sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
    import bake

    code = bake.main(sys.argv[1:])
    sys.stderr.flush()
    os._exit(code)  # Blender's own end may hang; everything is written by now
