"""Several cloths in one bake, with the real solver: files of their own, one checkpoint."""

import json
from array import array

import boucle_core
import pytest
from boucle_addon.core import bake, checkpoint_file, joint, pc2, points, report, scene_json
from boucle_addon.core.bake import Moment, Pose
from boucle_addon.core.cache_paths import files_of
from boucle_addon.core.refusal import Refusal
from boucle_addon.core.store import Plan, Store, Stores

END = 12
SIDE = 7
NAMES = ("lower", "upper")
HEIGHTS = (0.0, 0.15)


def grid(height, side=SIDE):
    return array("d", [v for k in range(side**2) for v in (k % side / 6, k // side / 6, height)])


def faces(side=SIDE):
    corners = array("i")
    for k in range((side - 1) ** 2):
        low = k // (side - 1) * side + k % (side - 1)
        corners.extend([low, low + 1, low + side + 1, low + side])
    return array("i", range(0, len(corners), 4)), corners


def scene(name, meets=True):
    cloth = {
        "name": name, "density": 0.2,
        "springs": {"stretch": 500.0, "shear": 100.0, "bend": 1.0},
        "collision": {"self": False, "thickness": 0.03} if meets else {"enabled": False},
    }  # fmt: skip
    if name == "lower":
        cloth["pins"] = {"vertices": [k for k in range(SIDE**2) if k % SIDE in (0, SIDE - 1)]}
    return {
        "scene": {"frames": [1, END], "fps": 24.0, "gravity": [0.0, 0.0, -9.81]},
        "cloth": [cloth],
        "solver": {"integrator": "bdf2", "tolerance": 5e-3},
    }


def solver(names=NAMES, meets=True):
    described = [scene(name, meets) for name in names]
    joined = joint.join(described, lambda *_: True) if meets else described[0]
    meshes = [(grid(HEIGHTS[NAMES.index(name)]), *faces()) for name in names]
    return boucle_core.Simulation(scene_json.encode(joined), meshes, 1)


def stores(folder, names=NAMES, digest="d"):
    out = []
    for name in names:
        rows = report.Report("0.1.0", "", 1, {"name": name})
        plan = Plan(1, 1, END, SIDE**2, digest, ("strain", "contact"))
        out.append(Store(files_of(str(folder / f"{name}.pc2")), plan, rows))
    return Stores(out)


def moment(names):
    """Each object's space is a metre further along x than the one before's."""

    def at(_frame):
        poses = []
        for name in names:
            number = NAMES.index(name)
            shift = (1, 0, 0, 0.0, 0, 1, 0, 0, 0, 0, 1, 0)
            targets = points.transform(grid(HEIGHTS[number]), shift, "d")
            poses.append(Pose(targets, (*shift[:3], -float(number), *shift[4:])))
        return Moment(poses)

    return at


def pull(folder, steps=None, resume=False, names=NAMES, **changes):
    kept = stores(folder, names, **changes)
    running = bake.bake(solver(names), kept, moment(names), resume, boucle_core.InternalError)
    count = 0
    for step in running:
        step.run()
        count += 1
        if count == steps:
            running.close()
    return count


def contents(folder):
    return {
        p.name: p.read_bytes() for p in folder.iterdir() if p.suffix not in {".json", ".checkpoint"}
    }


def last_heights(folder, name):
    row = pc2.read_sample(str(folder / f"{name}.pc2"), END - 1)
    return list(row)[2::3]


@pytest.fixture
def whole(tmp_path):
    folder = tmp_path / "whole"
    assert pull(folder) == END - 1
    return folder


def test_one_cloth_falls_on_the_other_and_each_has_files_of_its_own(whole):
    assert sorted(path.name for path in whole.iterdir()) == sorted(
        f"{name}.{ending}"
        for name in NAMES
        for ending in ("pc2", "json", "checkpoint", "strain", "contact")
    )
    middle = SIDE**2 // 2
    lower, upper = (last_heights(whole, name) for name in NAMES)
    assert lower[middle] < -0.02
    assert upper[middle] > lower[middle] + 0.02, "it lies on it"
    assert pc2.read_sample(str(whole / "upper.pc2"), 0)[0] == pytest.approx(-1.0, abs=1e-5)
    rows = [json.loads((whole / f"{name}.json").read_text())["frames"] for name in NAMES]
    assert [row["frame"] for row in rows[0]] == list(range(1, END + 1))
    last = [each[-1] for each in rows]
    assert last[0]["intersections"] == last[1]["intersections"] == 0
    assert last[0]["contacts"] == last[1]["contacts"] > 0
    assert last[0]["hash"] != last[1]["hash"]
    assert last[0]["max_strain"] != last[1]["max_strain"]


@pytest.mark.parametrize("steps", [1, 4, 10])
def test_stopped_after_any_step_all_go_on_bit_equal(whole, tmp_path, steps):
    folder = tmp_path / "part"
    pull(folder, steps=steps)
    for name in NAMES:
        assert pc2.read_header(str(folder / f"{name}.pc2")).sample_count == steps + 1
    assert pull(folder, resume=True) == END - 1 - steps
    assert contents(folder) == contents(whole)


def test_a_kill_while_the_files_are_bound_to_each_other_means_a_new_start(whole, tmp_path):
    folder = tmp_path / "part"
    pull(folder, steps=1)
    (folder / "upper.checkpoint").unlink()
    state = checkpoint_file.read(str(folder / "lower.checkpoint"))
    rows = [each[:1] for each in state.rows]
    begun = state._replace(frame=1, sample_count=1, rows=rows)
    checkpoint_file.write(str(folder / "lower.checkpoint"), begun)
    assert pull(folder, resume=True) == END - 1
    for name, content in contents(whole).items():
        assert (folder / name).read_bytes() == content


def test_after_a_kill_between_the_files_of_a_frame_the_checkpoint_counts(whole, tmp_path):
    folder = tmp_path / "part"
    pull(folder, steps=3)
    early = (folder / "lower.checkpoint").read_bytes()
    pull(folder, steps=2, resume=True)
    (folder / "lower.checkpoint").write_bytes(early)
    upper = (folder / "upper.pc2").read_bytes()
    (folder / "upper.pc2").write_bytes(upper[: -12 * SIDE**2 - 5])
    pull(folder, resume=True)
    assert contents(folder) == contents(whole)


def test_what_is_not_the_same_bake_is_refused_and_kept(whole, tmp_path):
    before = contents(whole)
    with pytest.raises(Refusal, match=r'"upper" was baked together with "lower": go on with all'):
        pull(whole, resume=True, names=("upper",))
    with pytest.raises(Refusal, match="of other settings or another mesh"):
        pull(whole, resume=True, digest="other")
    assert contents(whole) == before
    pull(whole, names=("upper",))
    with pytest.raises(Refusal, match='"upper" has gone or is another one than that of "lower"'):
        pull(whole, resume=True)
    (whole / "upper.checkpoint").unlink()
    with pytest.raises(Refusal, match='"upper" has gone or is another one than that of "lower"'):
        pull(whole, resume=True)
    alone = tmp_path / "alone"
    pull(alone, names=("lower",))
    with pytest.raises(Refusal, match='"upper" has gone'):
        pull(alone, resume=True)
    (whole / "lower.checkpoint").unlink()
    assert pull(whole, resume=True) == END - 1, "without any it begins"


def test_the_joined_report_counts_what_is_shared_once(whole):
    reports = [json.loads((whole / f"{name}.json").read_text()) for name in NAMES]
    for one in reports:
        one["together"] = list(NAMES)
    joined = report.joined(reports)
    rows = [one["frames"][-1] for one in reports]
    last = joined["frames"][-1]
    assert [cloth["name"] for cloth in joined["cloths"]] == list(NAMES)
    for key in ("contacts", "substeps", "iterations", "clipped", "seconds", "intersections"):
        assert last[key] == rows[0][key], key
    assert last["kinetic_energy"] == sum(row["kinetic_energy"] for row in rows)
    assert last["max_strain"] == max(row["max_strain"] for row in rows)
    assert "together" not in joined
