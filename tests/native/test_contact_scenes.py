"""The scenes of contact in tests/scenes, baked: nothing passes through anything, says the exact count, and so does ipctk.

What ipctk and numpy look at is the baked file: positions as they are stored, colliders placed by reading the scene anew.
"""

import tomllib
from dataclasses import replace

import boucle_core
import numpy as np
import pytest

from validation.baked import SCENES, bake, read
from validation.nearness import edge_triangle
from validation.obstacles import HEAD, Obstacle
from versus.full_size import NAMES, RECOVERIES

BEYOND_RATE = 0.002
"""How much longer than its deformation rate allows an edge may be, as a part of its rest length."""


@pytest.fixture(scope="module")
def bake_once(tmp_path_factory):
    """Bake a scene with 2 threads and read it, or give what was read before."""
    known = {}

    def baked(name):
        if name not in known:
            out = tmp_path_factory.mktemp(name)
            known[name] = read(name, out, bake(name, out, 2))
        return known[name]

    return baked


def the_same_for_any_threads(baked, folder, overrides=()):
    """Check that bakes with 1 and 4 threads leave the same files, as far as they go."""
    for threads in (1, 4):
        out = folder / str(threads)
        rows = bake(baked.name, out, threads, overrides)["frames"]
        for row, other in zip(baked.rows, rows, strict=not overrides):
            is_same = row["hash"] == other["hash"]
            assert is_same, f"{baked.name}, frame {row['frame']}: {threads} threads"
        for cache in out.glob("*.pc2"):
            same = (baked.out / cache.name).read_bytes()[HEAD:]
            mine = cache.read_bytes()[HEAD:]
            text = f"{baked.name}: {cache.name} with {threads} threads"
            assert mine == same[: len(mine)], text
            assert overrides or len(mine) == len(same), text


def whole(baked):
    """Check that all is finite and that no edge is longer than its rate allows, but for a little."""
    for frame, positions in zip(baked.numbers, baked.frames, strict=True):
        assert np.isfinite(positions).all(), f"{baked.name}, frame {frame}: not finite"
    for frame, strain in zip(baked.numbers, baked.strains, strict=True):
        assert strain <= BEYOND_RATE, f"{baked.name}, frame {frame}: {strain:.3%} beyond the rate"


@pytest.mark.parametrize("name", NAMES)
def test_no_frame_has_an_intersection_by_our_count_by_ipctk_or_by_distance(name, bake_once):
    baked = bake_once(name)
    assert not (counts := baked.counted()), f"{name}: intersections by frame, exactly: {counts}"
    assert not (found := baked.crossed()), f"{name}: ipctk finds intersections in frames {found}"
    assert not (found := baked.sunk()), f"{name}: cloth lies in a collider in frames {found}"


@pytest.mark.parametrize("name", NAMES)
def test_every_frame_is_finite_and_within_the_deformation_rate(name, bake_once):
    whole(bake_once(name))


@pytest.mark.parametrize("name", NAMES)
def test_the_bake_is_the_same_to_the_byte_for_1_2_and_4_threads(name, bake_once, tmp_path):
    the_same_for_any_threads(bake_once(name), tmp_path)


LOWERED = {
    "sphere": ("sunk", [0.0, 0.0, -0.05]),
    "incline": ("sunk", [0.0, 0.0, -0.02]),
    "box_corner": ("crossed", [0.0, 0.0, -0.05]),
    "moving_body": ("crossed", [0.0, 0.0, -0.05]),
    "needles": ("crossed", [0.0, 0.0, -0.05]),
}


@pytest.mark.parametrize("name", LOWERED)
def test_ipctk_and_distances_see_cloth_that_is_pushed_into_what_it_touches(name, bake_once):
    """So colliders are where they are taken for."""
    baked = bake_once(name)
    assert sum(row["contacts"] for row in baked.rows) > 0
    oracle, way = LOWERED[name]
    pushed = replace(baked, frames=baked.frames + np.array(way, np.float32))
    assert getattr(pushed, oracle)(), name


def test_moved_colliders_are_where_their_keyframes_say():
    def moved(name, number):
        scene = tomllib.loads((SCENES / f"{name}.toml").read_text(encoding="utf-8"))
        return Obstacle.of(scene["collider"][number], SCENES)

    plate = moved("closing_plates", 1)
    lowest = [plate.at(frame)[:, 2].min() for frame in (0, 1, 10, 19, 25, 31, 37, 99)]
    assert lowest == pytest.approx([0.3, 0.3, 0.165, 0.03, 0.03, 0.165, 0.3, 0.3])
    assert moved("fast_sphere", 0).at(3) == pytest.approx(np.array([[0.1, 1.0, -0.8]]))


def test_a_ball_of_60_m_per_s_takes_along_what_is_in_its_way(bake_once):
    """It is in front of the sheet in frame 2 and behind it in frame 3: what it met cannot still hang there."""
    before, after = bake_once("fast_sphere").frames[1:3]
    in_the_way = np.hypot(before[:, 0] - 0.1, before[:, 2] + 0.8) < 0.2
    moved = np.linalg.norm(after - before, axis=1)[in_the_way]
    assert len(moved) > 20
    assert moved.min() > 0.2


def test_ipctk_sees_a_sheet_that_is_pushed_into_another(bake_once):
    baked = bake_once("two_sheets")
    upper = np.arange(baked.frames.shape[1]) >= 24 * 24
    pushed = replace(baked, frames=baked.frames - np.float32(0.05) * upper[:, None])
    assert pushed.crossed()


def test_distances_of_an_edge_and_triangles_are_those_of_the_module():
    rng = np.random.default_rng(7)
    edge, corners = rng.uniform(-1, 1, (2, 3)), rng.uniform(-1, 1, (2000, 3, 3))
    pairs = np.concatenate([np.broadcast_to(edge, (2000, 2, 3)), corners], axis=1)
    apart = np.full((2000, 5), np.inf)
    for column, end in enumerate((0, 1)):
        out = np.empty(2000)
        boucle_core.point_triangle_distance(np.ascontiguousarray(pairs[:, [end, 2, 3, 4]]), out)
        apart[:, column] = out
    for column, side in enumerate(([2, 3], [3, 4], [4, 2]), 2):
        out = np.empty(2000)
        boucle_core.edge_edge_distance(np.ascontiguousarray(pairs[:, [0, 1, *side]]), out)
        apart[:, column] = out
    crosses = np.empty(2000, np.uint8)
    boucle_core.edge_crosses_triangle(pairs, crosses)
    expected = np.where(crosses > 0, 0.0, apart.min(1))
    assert (crosses > 0).sum() > 100
    assert np.abs(edge_triangle(edge, corners) - expected).max() < 1e-12


MOST_FRAMES = 48
"""After so many, what is tangled must be free."""
SHUT = {"pinch": range(13, 18), "pinch_boxes": range(13, 18)}
"""The frames in which two bodies overlap and leave no room; in the other scenes there always is some."""
ELSEWHERE = {"sheet_in_ball": [0.0, 0.0, -0.05], "sheet_in_box": [1.0, 0.0, -0.2]}
"""The body at the middle of the sheet instead of at its side, and the other way round."""


def comes_free(baked, opened=1):
    """Check that a scene is tangled, and free in time and ever after, say our count, ipctk and distances."""
    tangled = list(baked.counted())
    assert tangled, f"{baked.name}: never tangled"
    last = opened + MOST_FRAMES
    assert baked.numbers[-1] > last + 6, f"{baked.name}: too short to see"
    for oracle, frames in (("count", tangled), ("ipctk", baked.crossed()), ("depth", baked.sunk())):
        late = [frame for frame in frames if frame >= last]
        assert not late, f"{baked.name}: intersections by {oracle} in frames {late}"
    first = max(tangled) + 1
    assert not [frame for frame in baked.crossed() + baked.sunk() if frame >= first], baked.name


def stays_calm(baked):
    """Check that cloth falls and comes out, but does not fly away.

    A fully stretched edge that is let go may snap back by 20 m/s: four times its strain of 0.1 at 50 m/s, the speed of
    sound in it.
    """
    speeds = 24.0 * np.linalg.norm(np.diff(baked.frames, axis=0), axis=-1)
    for frame, each in zip(baked.numbers[1:], speeds, strict=True):
        usual, most = np.sqrt((each**2).mean()), each.max()
        text = f"{baked.name}, frame {frame}: {usual:.1f} m/s, at most {most:.1f} m/s"
        assert usual <= 2.0 + 9.81 * (frame - 1) / 24.0, text
        assert most <= 20.0, text


@pytest.mark.parametrize("name", RECOVERIES)
def test_what_is_tangled_comes_free_within_48_frames_and_stays_free(name, bake_once):
    shut = SHUT.get(name)
    comes_free(bake_once(name), shut.stop if shut else 1)


@pytest.mark.parametrize("name", RECOVERIES)
def test_what_is_tangled_stays_whole_and_does_not_fly_away(name, bake_once):
    whole(bake_once(name))
    stays_calm(bake_once(name))


@pytest.mark.parametrize("name", RECOVERIES)
def test_what_is_tangled_has_the_same_bytes_for_1_2_and_4_threads(name, bake_once, tmp_path):
    the_same_for_any_threads(bake_once(name), tmp_path, ["scene.frames=[1, 21]"])


@pytest.mark.parametrize("name", ELSEWHERE)
def test_a_sheet_comes_free_from_a_body_elsewhere_in_it(name, tmp_path):
    scene = tomllib.loads((SCENES / f"{name}.toml").read_text(encoding="utf-8"))
    body, center = scene["collider"][0], ELSEWHERE[name]
    shape = "sphere" if "sphere" in body else "box"
    body[shape]["center"] = center
    override = f"collider.{body['name']}.{shape}.center={center}"
    baked = read(name, tmp_path, bake(name, tmp_path, 2, [override]), scene)
    whole(baked)
    stays_calm(baked)
    comes_free(baked)
