"""The demo: the paper's hanging cloth as a curtain, added, baked, saved and rendered by embedded Blender.

Leaves out/demo/: curtain.blend, curtain.pc2 (which the .blend plays), report.json, curtain.png, curtain.mp4.
Every stage is a Blender process of its own with a time limit and an explicit exit code.
"""

from __future__ import annotations

import subprocess
import sys
import time
from pathlib import Path

from environment import OUT, ROOT, SCRIPTS, Failed, stop

STAGES = {"bake": 240.0, "still": 400.0, "video": 900.0}
"""Each stage and the seconds that it may take; a busy machine takes several times what a free one does."""
RESULTS = ("curtain.blend", "curtain.pc2", "report.json", "curtain.png", "curtain.mp4")
NOISE = ("Fra:", "Saved:", "Append frame", "Time:", "Read blend:", "Info:", "[mp4", "[libx264")


def run_stage(stage: str, folder: Path, limit: float) -> None:
    """Run one stage; show what it says, but for Blender's line per tile.

    Raises:
        Failed: It failed or took too long.
    """
    started = time.monotonic()
    print(f"-- {stage}", flush=True)
    log = folder / f".{stage}.log"
    with log.open("w", encoding="utf-8") as output:
        process = subprocess.Popen(
            [sys.executable, str(SCRIPTS / "demo_scene.py"), stage, str(folder)],
            stdout=output,
            stderr=subprocess.STDOUT,
            start_new_session=True,
        )
        try:
            code = process.wait(limit)
        except subprocess.TimeoutExpired:
            stop(process)
            code = None
        except BaseException:
            stop(process)
            raise
    lines = [line for line in log.read_text(encoding="utf-8").splitlines() if line.strip()]
    print("\n".join(line for line in lines if not line.startswith(NOISE)))
    if code is None:
        raise Failed(f"{stage} took more than {limit:.0f} s and was stopped")
    if code != 0:
        raise Failed(f"{stage} ended with exit code {code}")
    log.unlink()
    print(f"   {stage}: {time.monotonic() - started:.1f} s", flush=True)


def main() -> int:
    """Run all stages and list what they left."""
    folder = OUT / "demo"
    folder.mkdir(parents=True, exist_ok=True)
    for name in RESULTS:
        (folder / name).unlink(missing_ok=True)
    try:
        for stage, limit in STAGES.items():
            run_stage(stage, folder, limit)
        missing = [name for name in RESULTS if not (folder / name).is_file()]
        if missing:
            raise Failed(f"not written: {', '.join(missing)}")
    except Failed as failed:
        print(f"demo: {failed}", file=sys.stderr)
        return 1
    for name in RESULTS:
        file = folder / name
        print(f"{file.relative_to(ROOT)}: {file.stat().st_size / 1e6:.2f} MB")
    return 0


if __name__ == "__main__":
    sys.exit(main())
