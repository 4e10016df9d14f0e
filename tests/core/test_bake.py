"""The bake's generator with the real solver: whatever stops it, what is there is right."""

import json
import os
from array import array

import boucle_core
import pytest
from boucle_addon.core import bake, pc2, points, report, scene_json, vertex_file
from boucle_addon.core.bake import Moment, Pose
from boucle_addon.core.cache_paths import files_of
from boucle_addon.core.refusal import CacheRefusal, Refusal
from boucle_addon.core.store import Plan, Store, Stores

END = 12
SIDE = 5
MOVED = (1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 2.0, -3.0)
TO_OBJECT = points.inverse(MOVED)


def grid():
    positions = array("d", [v for k in range(SIDE**2) for v in (k % SIDE / 4, 0.0, k // SIDE / 4)])
    corners = array("i")
    for k in range((SIDE - 1) ** 2):
        low = k // (SIDE - 1) * SIDE + k % (SIDE - 1)
        corners.extend([low, low + 1, low + SIDE + 1, low + SIDE])
    return positions, array("i", range(0, len(corners), 4)), corners


def solver(integrator="symplectic_euler", **springs):
    scene = {
        "scene": {"frames": [1, END], "fps": 24.0, "gravity": [0.0, 0.0, -9.81]},
        "cloth": [{
            "name": "A", "density": 0.2, "pins": {"vertices": [20, 24]},
            "springs": {"stretch": 500.0, "damping": 0.01, **springs},
        }],
        "collision": {"enabled": False},
        "solver": {"integrator": integrator, "substeps": 400, "allow_unstable": True},
    }  # fmt: skip
    return boucle_core.Simulation(scene_json.encode(scene), [grid()], 1)


def store(folder, digest="d", first=1, keeps_previous=True, keeps=()):
    rows = report.Report("0.1.0", "", 1, {"name": "A"})
    plan = Plan(1, first, END, SIDE**2, digest, keeps)
    return Stores([Store(files_of(str(folder / "a.pc2")), plan, rows, keeps_previous)])


def moment(frame):
    """Pins that sway, in an object that is moved and scaled."""
    moved = points.transform(grid()[0], (1, 0, 0, 0.02 * frame, *points.IDENTITY[4:]), "d")
    return Moment([Pose(moved, TO_OBJECT)])


def pull(simulation, kept, steps=None, resume=False):
    """Bake, or stop after some steps; what the steps' frames were."""
    running = bake.bake(simulation, kept, moment, resume, boucle_core.InternalError)
    frames = []
    for step in running:
        step.run()
        frames.append(step.frame)
        if steps is not None and len(frames) == steps:
            running.close()
            break
    return frames


@pytest.fixture
def whole(tmp_path):
    folder = tmp_path / "whole"
    assert pull(solver(), store(folder)) == list(range(2, END + 1))
    return folder


def test_a_bake_has_a_sample_and_a_row_for_every_frame(whole):
    header = pc2.read_header(str(whole / "a.pc2"))
    assert header == (SIDE**2, 1.0, END)
    rows = json.loads((whole / "a.json").read_text())["frames"]
    assert [row["frame"] for row in rows] == list(range(1, END + 1))
    rest = points.transform(grid()[0], TO_OBJECT, "f")
    first = list(pc2.read_sample(str(whole / "a.pc2"), 0))
    assert first == pytest.approx(list(rest), abs=1e-6)  # but for the solver's perturbation
    pin = pc2.read_sample(str(whole / "a.pc2"), END - 1)[60:63]
    assert list(pin) == pytest.approx([0.02 * END, 0.0, 2.0], abs=1e-6)


@pytest.mark.parametrize("steps", range(1, END))
def test_stopped_after_any_step_it_goes_on_bit_equal(whole, tmp_path, steps):
    folder = tmp_path / "part"
    pull(solver(), store(folder), steps=steps)
    assert pc2.read_header(str(folder / "a.pc2")).sample_count == steps + 1
    assert pc2.check(str(folder / "a.pc2"), SIDE**2) == ""
    kept = store(folder)
    assert pull(solver(), kept, resume=True) == list(range(steps + 2, END + 1))
    assert (folder / "a.pc2").read_bytes() == (whole / "a.pc2").read_bytes()
    hashes = [
        [(row["frame"], row["hash"]) for row in json.loads((f / "a.json").read_text())["frames"]]
        for f in (folder, whole)
    ]
    assert hashes[0] == hashes[1]


def test_a_step_that_was_asked_for_and_never_run_is_not_kept(tmp_path):
    running = bake.bake(solver(), store(tmp_path), moment, False, boucle_core.InternalError)
    next(running)
    running.close()
    assert pc2.read_header(str(tmp_path / "a.pc2")).sample_count == 1
    with pytest.raises(RuntimeError, match="must run"):
        bake.Step(2, lambda: None).result()


def test_after_a_kill_the_last_checkpoint_counts_and_later_samples_are_made_again(whole, tmp_path):
    folder = tmp_path / "part"
    pull(solver(), store(folder), steps=4)
    checkpoint = (folder / "a.checkpoint").read_bytes()
    pull(solver(), store(folder), resume=True, steps=3)
    (folder / "a.checkpoint").write_bytes(checkpoint)  # as if the later one was never written
    assert pull(solver(), store(folder), resume=True) == list(range(6, END + 1))
    assert (folder / "a.pc2").read_bytes() == (whole / "a.pc2").read_bytes()


def test_nothing_to_resume_means_a_start_and_a_finished_bake_means_nothing(whole):
    before = (whole / "a.pc2").read_bytes()
    assert pull(solver(), store(whole), resume=True) == []
    assert (whole / "a.pc2").read_bytes() == before


def test_another_cloths_checkpoint_is_refused_and_kept(whole):
    before = (whole / "a.pc2").read_bytes()
    with pytest.raises(Refusal, match="other settings or another mesh"):
        pull(solver(), store(whole, digest="other"), resume=True)
    with pytest.raises(boucle_core.BoucleError):
        pull(solver(stretch=400.0), store(whole), resume=True)
    assert (whole / "a.pc2").read_bytes() == before


def test_strain_is_kept_beside_the_cache_and_goes_on_with_it(tmp_path):
    count = SIDE**2
    whole, part = tmp_path / "whole", tmp_path / "part"
    simulation, expected = solver(), array("f", bytes(4 * count))
    pull(simulation, store(whole, keeps=("strain",)))
    simulation.read_strain(0, expected)
    path = str(whole / "a.strain")
    assert vertex_file.row_count(path, count) == END
    assert vertex_file.read(path, END - 1, count) == expected
    assert max(abs(value) for value in vertex_file.read(path, 0, count)) < 1e-5
    assert vertex_file.read(path, END, count) is None
    assert vertex_file.read(path, 0, count + 1) is None
    pull(solver(), store(part, keeps=("strain",)), steps=4)
    assert vertex_file.row_count(str(part / "a.strain"), count) == 5
    pull(solver(), store(part, keeps=("strain",)), resume=True)
    assert (part / "a.strain").read_bytes() == (whole / "a.strain").read_bytes()


def test_a_resumed_bake_keeps_no_strain_that_it_did_not_have_from_the_start(tmp_path):
    for before, after in ((("strain",), ()), ((), ("strain",))):
        pull(solver(), store(tmp_path, keeps=before), steps=4)
        pull(solver(), store(tmp_path, keeps=after), resume=True)
        assert pc2.read_header(str(tmp_path / "a.pc2")).sample_count == END
        assert not (tmp_path / "a.strain").exists()


class Touching:
    """A simulation that tells of contacts: the frame and the vertex are in the numbers."""

    def __init__(self):
        self._real = solver()

    def __getattr__(self, name):
        return getattr(self._real, name)

    def read_contacts(self, cloth, out):
        assert cloth == 0
        out[:] = array("f", [self.frame + 0.5 * vertex for vertex in range(SIDE**2)])

    def read_intersections(self, cloth, out):
        assert cloth == 0
        out[:] = array("f", [float(vertex % 2) for vertex in range(SIDE**2)])


def test_contacts_and_intersections_are_kept_each_in_a_file_of_its_own(tmp_path):
    count = SIDE**2
    pull(Touching(), store(tmp_path, keeps=("contact", "intersection")), steps=4)
    pull(Touching(), store(tmp_path, keeps=("contact", "intersection")), resume=True)
    contact, crossed = str(tmp_path / "a.contact"), str(tmp_path / "a.intersection")
    assert vertex_file.row_count(contact, count) == vertex_file.row_count(crossed, count) == END
    assert vertex_file.read(contact, 6, count)[:3].tolist() == [7.0, 7.5, 8.0]
    assert vertex_file.read(crossed, 6, count)[:3].tolist() == [0.0, 1.0, 0.0]
    assert not (tmp_path / "a.strain").exists()
    (tmp_path / "a.strain").write_bytes((tmp_path / "a.contact").read_bytes())
    assert vertex_file.row_count(str(tmp_path / "a.strain"), count) == 0, "of another quantity"


class Aimed(Touching):
    """A simulation that notes where its colliders go."""

    def __init__(self):
        super().__init__()
        self.aims = []

    def set_collider_targets(self, collider, targets):
        self.aims.append((self.frame + 1, collider, targets))


def test_pins_and_colliders_are_told_where_they_go_at_the_start_and_before_each_frame(tmp_path):
    simulation = Aimed()

    def among(frame):
        return moment(frame)._replace(colliders=[f"ball at {frame}", f"box at {frame}"])

    for step in bake.bake(simulation, store(tmp_path), among, False, boucle_core.InternalError):
        step.run()
    assert simulation.aims == [
        (max(frame, 2), number, f"{name} at {frame}")
        for frame in range(1, END + 1)
        for number, name in enumerate(("ball", "box"))
    ]


@pytest.mark.parametrize("integrator", ["bdf2", "implicit_euler"])
def test_a_stopped_bake_of_an_implicit_integrator_goes_on_bit_equal(tmp_path, integrator):
    whole, part = tmp_path / "whole", tmp_path / "part"
    pull(solver(integrator), store(whole))
    pull(solver(integrator), store(part), steps=5)
    pull(solver(integrator), store(part), resume=True)
    assert (part / "a.pc2").read_bytes() == (whole / "a.pc2").read_bytes()
    rows = [json.loads((folder / "a.json").read_text())["frames"] for folder in (whole, part)]
    assert rows[0][-1]["hash"] == rows[1][-1]["hash"]
    assert rows[0][-1]["iterations"] == rows[1][-1]["iterations"] > 0


def test_frames_before_the_first_kept_one_are_simulated_and_left_out(whole, tmp_path):
    folder = tmp_path / "late"
    pull(solver(), store(folder, first=9))
    size = 12 * SIDE**2
    assert pc2.read_header(str(folder / "a.pc2")) == (SIDE**2, 9.0, 4)
    assert (folder / "a.pc2").read_bytes()[32:] == (whole / "a.pc2").read_bytes()[32 + 8 * size :]
    folder = tmp_path / "late in parts"
    pull(solver(), store(folder, first=9), steps=3)
    pull(solver(), store(folder, first=9), resume=True)
    assert (folder / "a.pc2").read_bytes()[32:] == (whole / "a.pc2").read_bytes()[32 + 8 * size :]


def test_an_earlier_bake_is_set_aside_or_removed(whole):
    pull(solver(), store(whole), steps=2)
    assert pc2.read_header(str(whole / "a.previous.pc2")).sample_count == END
    pull(solver(), store(whole, keeps_previous=False), steps=2)
    assert pc2.read_header(str(whole / "a.previous.pc2")).sample_count == END
    assert sorted(p.name for p in whole.iterdir() if "previous" not in p.name) == [
        "a.checkpoint", "a.json", "a.pc2",
    ]  # fmt: skip


@pytest.mark.parametrize("calls", range(1, 8))
def test_a_kill_while_an_earlier_bake_is_set_aside_loses_nothing(whole, monkeypatch, calls):
    """Of one that was set aside, or is still in its place, all files are of the same bake: those of another are gone."""
    pull(solver(), store(whole))
    (whole / "a.previous.strain").write_text("of the bake before")
    kept = {name: (whole / name).read_bytes() for name in ("a.pc2", "a.json", "a.checkpoint")}
    real, left = {"replace": os.replace, "remove": os.remove}, [calls]

    def call(name, *paths):
        left[0] -= 1
        if left[0] <= 0:
            raise KeyboardInterrupt
        real[name](*paths)

    with monkeypatch.context() as patch:
        for name in real:
            patch.setattr(os, name, lambda *paths, name=name: call(name, *paths))
        if calls < 5:
            with pytest.raises(KeyboardInterrupt):
                store(whole).begin()
        else:
            store(whole).begin()
    assert pull(solver(), store(whole), resume=True) in ([], list(range(2, END + 1)))
    assert (whole / "a.pc2").read_bytes() == kept["a.pc2"]
    if calls in (3, 4):
        assert (whole / "a.previous.pc2").read_bytes() == kept["a.pc2"]
        assert (whole / "a.previous.json").read_bytes() == kept["a.json"]
    if calls > 1:
        assert not (whole / "a.previous.strain").exists()


def test_a_report_that_was_lost_or_damaged_comes_back_with_the_next_frames(whole, tmp_path):
    folder = tmp_path / "part"
    for damage in (lambda path: path.unlink(), lambda path: path.write_bytes(b"{\x00")):
        pull(solver(), store(folder), steps=4)
        damage(folder / "a.json")
        pull(solver(), store(folder), resume=True)
        reports = [json.loads((f / "a.json").read_text()) for f in (folder, whole)]
        resumed, expected = ([row["hash"] for row in each["frames"]] for each in reports)
        assert resumed == expected


def test_a_changed_sample_is_not_gone_on_from(tmp_path):
    pull(solver(), store(tmp_path), steps=4)
    data = bytearray((tmp_path / "a.pc2").read_bytes())
    data[32 + 12 * SIDE**2 * 2 + 7] ^= 1
    (tmp_path / "a.pc2").write_bytes(data)
    with pytest.raises(
        Refusal, match="frame 3 is not as it was baked: bring the file back or bake"
    ):
        pull(solver(), store(tmp_path), resume=True)
    assert (tmp_path / "a.pc2").read_bytes() == data


@pytest.mark.parametrize("damage", [lambda data: data[:-1], lambda data: data[:-1] + b"?", None])
def test_changed_or_missing_strain_is_told_and_can_be_done_without(tmp_path, damage):
    pull(solver(), store(tmp_path, keeps=("strain",)), steps=4)
    path = tmp_path / "a.strain"
    if damage:
        path.write_bytes(damage(path.read_bytes()))
    else:
        path.unlink()
    with pytest.raises(
        CacheRefusal, match=r"damaged at row .: bring the file back, do without its"
    ):
        pull(solver(), store(tmp_path, keeps=("strain",)), resume=True)
    assert pull(solver(), store(tmp_path), resume=True)[-1] == END
    assert not path.exists()


def test_divergence_keeps_the_frames_and_a_checkpoint_before_it(tmp_path):
    wild = {"stretch": 1e9, "limiter": "none", "damping": 0.0}
    with pytest.raises(boucle_core.DivergedError) as raised:
        pull(solver(**wild), store(tmp_path))
    count = pc2.read_header(str(tmp_path / "a.pc2")).sample_count
    assert count == raised.value.frame - 1
    with pytest.raises(boucle_core.DivergedError) as again:
        pull(solver(**wild), store(tmp_path), resume=True)
    assert str(again.value) == str(raised.value)


class Wrapped:
    """A solver with one thing changed."""

    def __init__(self, inner, **changes):
        self.inner = inner
        self.changes = changes

    def __getattr__(self, name):
        return self.changes.get(name) or getattr(self.inner, name)


def test_after_a_fault_the_solver_is_not_touched_again(tmp_path):
    inner = solver()
    touched = []

    def advance():
        if inner.frame == 3:
            raise boucle_core.InternalError("a fault")
        return inner.advance()

    broken = Wrapped(inner, advance=advance, checkpoint=lambda: touched.append(1) or b"")
    with pytest.raises(boucle_core.InternalError):
        pull(broken, store(tmp_path))
    assert not touched
    assert pc2.read_header(str(tmp_path / "a.pc2")).sample_count == 3
    assert len(json.loads((tmp_path / "a.json").read_text())["frames"]) == 3


def test_a_full_disk_keeps_the_frames_before_it_and_no_checkpoint_that_is_ahead(tmp_path):
    kept = store(tmp_path)
    real = kept.write

    def write(frame, *rest):
        if frame == 5:
            raise CacheRefusal("the cache cannot be written (disk full)")
        real(frame, *rest)

    kept.write = write
    with pytest.raises(CacheRefusal, match="disk full"):
        pull(solver(), kept)
    assert pc2.read_header(str(tmp_path / "a.pc2")).sample_count == 4
    assert not (tmp_path / "a.checkpoint").exists()
    assert len(json.loads((tmp_path / "a.json").read_text())["frames"]) == 4
