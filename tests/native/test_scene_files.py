"""The scenes in tests/scenes are what they say they are."""

import re
import shutil
import struct
from pathlib import Path

import boucle_core
import numpy as np
import pytest

import scene_meshes
from versus.full_size import RECOVERIES

SCENES = Path(__file__).resolve().parents[1] / "scenes"
FILES = sorted(path.name for path in SCENES.glob("*.toml"))
ONE_SIZE = {"curtain.toml", "layers.toml", "numpy_demo.toml", "pinned2.toml", "pinned4.toml"}
ONE_SIZE |= {f"{name}.toml" for name in RECOVERIES}
"""Scenes that name no full size."""

AFTER_TWO_SECONDS = {
    0: (-0.0292366, -0.2852436, -0.0004073),
    13: (2.1915309, -0.0588015, 0.9073038),
    90: (1.1929574, 0.8712401, -0.0066413),
}
"""Positions (m) of the solver's own numpy demonstration, rust/solver/tests/validation/scenes.rs, which is upright along y and
begins at the origin."""


def test_the_numpy_demonstration_is_the_system_that_the_solver_is_validated_with(
    run_bake, scenes, tmp_path
):
    words = ["--out", "out", "--quiet", "--frames", "51:51"]
    assert run_bake(scenes / "numpy_demo.toml", *words).returncode == 0
    data = (tmp_path / "out" / "demo.pc2").read_bytes()
    assert struct.unpack("<i", data[28:32]) == (1,)
    frame = np.frombuffer(data[32:], "<f4").reshape(196, 3).astype(float)
    upright = (frame + np.array([1.3, 0.0, 1.3]))[:, [0, 2, 1]]
    for vertex, expected in AFTER_TWO_SECONDS.items():
        # The unevenness of a millionth of an edge has grown no larger than float32 tells apart.
        assert np.abs(upright[vertex] - expected).max() < 2e-6, (vertex, upright[vertex])


def first_frame(scene, out, overrides=()):
    """The report of a scene that ends with its first frame."""
    return boucle_core.bake(str(scene), str(out), overrides=[*overrides, "scene.frames=[1, 1]"])


def overrides_in(text):
    """The overrides that the comment at a scene's head names as its full size."""
    heads = ("# Full size:", "#   --set")
    lines = [line for line in text.splitlines() if line.startswith(heads)]
    return [word for line in lines for word in re.findall(r"--set (\S+)", line)]


@pytest.mark.parametrize("name", FILES)
def test_every_scene_can_be_simulated_and_begins_with_intersections_only_to_recover_from_them(
    name, tmp_path
):
    report = first_frame(SCENES / name, tmp_path)
    (row,) = report["frames"]
    begins_tangled = Path(name).stem in RECOVERIES and not name.startswith("pinch")
    assert bool(row["intersections"]) is begins_tangled
    assert row["max_strain"] < 1e-6
    assert all(cloth["vertices"] <= 2500 for cloth in report["cloths"])


@pytest.mark.parametrize("name", FILES)
def test_the_full_size_that_a_scene_names_can_be_simulated(name, tmp_path):
    overrides = overrides_in((SCENES / name).read_text())
    if not overrides:
        assert name in ONE_SIZE
        return
    shutil.copytree(SCENES, tmp_path / "scenes")
    for file, content in scene_meshes.files(full=True).items():
        (tmp_path / "scenes" / file).write_bytes(content)
    small = first_frame(SCENES / name, tmp_path / "small")["cloths"]
    full = first_frame(tmp_path / "scenes" / name, tmp_path / "full", overrides)["cloths"]
    assert sum(cloth["vertices"] for cloth in full) > sum(cloth["vertices"] for cloth in small)


def test_the_meshes_of_the_scenes_are_those_that_the_script_makes():
    for name, content in scene_meshes.files(full=False).items():
        assert (SCENES / name).read_bytes() == content, name
