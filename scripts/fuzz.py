"""Search for input that breaks the module: `python3 scripts/fuzz.py [TARGET ...] [--seconds S] [--keep]`.

Targets are those of `rust/fuzz`: scene, values, obj, pc2, bake, checkpoint, simulation, geometry; all of them, one after the
other, if none is named. libFuzzer changes known inputs so that they reach other code. What it finds goes to `out/fuzz/TARGET`:
`found/` for inputs that reach new code, `crash-*`, `timeout-*` and `oom-*` for those that break something. The exit code is 1
if there are any.

The stable compiler has all that this needs: coverage is a pass of LLVM, libFuzzer a crate. Memory is limited instead of
watched by AddressSanitizer, which would need another compiler: there is next to no `unsafe` code to watch. Linux only.
"""

from __future__ import annotations

import argparse
import os
import resource
import shutil
import subprocess
import sys
from pathlib import Path

from environment import OUT, ROOT, answers, require_rust

CRATE = ROOT / "rust" / "fuzz"
CORPUS = CRATE / "corpus"
DICTIONARY = CRATE / "scene.dict"
TARGETS = ("scene", "values", "obj", "pc2", "bake", "checkpoint", "simulation", "geometry")
WATCHED = (
    "-Cpasses=sancov-module",
    "-Cllvm-args=-sanitizer-coverage-level=4",
    "-Cllvm-args=-sanitizer-coverage-inline-8bit-counters",
    "-Cllvm-args=-sanitizer-coverage-pc-table",
    "-Cllvm-args=-sanitizer-coverage-trace-compares",
    "--cfg=fuzzing",
)
"""What libFuzzer sees the code by."""

MEMORY = 4 << 30
"""Most memory (bytes) that one target may ask for: what a header claims must not be believed."""

LONGEST_SECONDS = 60
MOST_FILES = 24
MOST_BYTES = 24_000
"""Of each target, what is kept in the tree."""


def host() -> str:
    """The platform to compile for: told, so that the flags do not reach build scripts."""
    lines = subprocess.run(["rustc", "-vV"], capture_output=True, text=True, check=True).stdout
    return next(line[6:] for line in lines.splitlines() if line.startswith("host: "))


def build() -> Path:
    """Compile every target and return the folder of the programs."""
    platform = host()
    target = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
    command = [
        "cargo",
        "build",
        "--quiet",
        "--package",
        "boucle-fuzz",
        "--bins",
        "--profile",
        "fuzz",
    ]
    command += ["--features", "libfuzzer", "--target", platform]
    flags = " ".join([*os.environ.get("RUSTFLAGS", "").split(), *WATCHED])
    subprocess.run(command, cwd=ROOT, check=True, env={**os.environ, "RUSTFLAGS": flags})
    return target / platform / "fuzz"


def limit_memory() -> None:
    """Let the process that is about to start ask for so much memory and no more."""
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))


def search(program: Path, seconds: int) -> int:
    """Run a target for so long; the number of inputs that broke something, of this run or of earlier ones."""
    target = program.name
    folder = OUT / "fuzz" / target
    found = folder / "found"
    found.mkdir(parents=True, exist_ok=True)
    command = [
        program,
        found,
        CORPUS / target,
        f"-artifact_prefix={folder}/",
        "-print_final_stats=1",
    ]
    command += [f"-max_total_time={seconds}", f"-timeout={LONGEST_SECONDS}", "-rss_limit_mb=3000"]
    command += ["-use_value_profile=1", "-fork=1"]
    command += ["-ignore_crashes=1", "-ignore_timeouts=1", "-ignore_ooms=1"]
    if target == "scene":
        command += [f"-dict={DICTIONARY}", "-max_len=4000"]
    print(f"== {target}: {seconds} s", flush=True)
    subprocess.run(command, cwd=ROOT, check=False, preexec_fn=limit_memory)
    broken = [p for p in folder.iterdir() if p.name.startswith(("crash-", "timeout-", "oom-"))]
    for path in broken:
        print(f"broken by {path.relative_to(ROOT)}: {program} {path}")
    return len(broken)


def keep(program: Path) -> None:
    """Keep in the tree the smallest inputs that together reach what all reach, as many as there is room for."""
    target = program.name
    folder = OUT / "fuzz" / target
    merged = folder / "merged"
    shutil.rmtree(merged, ignore_errors=True)
    merged.mkdir(parents=True)
    sources = [CORPUS / target, folder / "found"]
    command = [program, "-merge=1", f"-timeout={LONGEST_SECONDS}", merged, *sources]
    subprocess.run(
        command, cwd=ROOT, check=True, preexec_fn=limit_memory, stderr=subprocess.DEVNULL
    )
    known = {path.read_bytes() for path in (CORPUS / target).iterdir()}
    left = MOST_BYTES - sum(map(len, known))
    files = sorted(merged.iterdir(), key=lambda path: (path.stat().st_size, path.name))
    # Of many, those of every size.
    room = max(0, MOST_FILES - len(known))
    chosen = files[:: max(1, len(files) // max(1, room))][:room]
    for path in chosen:
        content = path.read_bytes()
        if content not in known and len(content) <= left:
            left -= len(content)
            (CORPUS / target / path.name).write_bytes(content)
    print(
        f"{target}: {len(files)} inputs reach what all reach, {len(list((CORPUS / target).iterdir()))} are kept"
    )


def main() -> int:
    """Read the command and do it."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("targets", nargs="*", metavar="TARGET", help=", ".join(TARGETS))
    parser.add_argument("--seconds", type=int, default=60, help="of each target (default 60)")
    parser.add_argument(
        "--keep", action="store_true", help="keep the best inputs in rust/fuzz/corpus"
    )
    words = parser.parse_args()
    unknown = [target for target in words.targets if target not in TARGETS]
    if unknown:
        parser.error(f"no target {unknown[0]!r}: one of {', '.join(TARGETS)}")
    require_rust()
    if not answers("c++", "--version"):
        parser.error("no C++ compiler (c++), which libFuzzer is compiled with")
    folder = build()
    broken = 0
    for target in words.targets or TARGETS:
        broken += search(folder / target, words.seconds)
        if words.keep:
            keep(folder / target)
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
