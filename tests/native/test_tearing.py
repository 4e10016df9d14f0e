"""Tearing through the module: what it tells, what it takes of cloth that is torn, and the caches that a bake leaves."""

import json
from pathlib import Path

import boucle_core
import numpy as np
import pytest

STORM = Path(__file__).parent.parent / "scenes" / "tear" / "storm.toml"
COLUMNS, ROWS = 6, 9
ROW = 4


def grid():
    """(positions, starts, corners) of a sheet that hangs in the plane y = 0; rows number upward."""
    c, r = np.meshgrid(np.arange(COLUMNS), np.arange(ROWS))
    positions = 0.1 * np.column_stack([c.ravel(), np.zeros(c.size), r.ravel()])
    first = (r[:-1, :-1] * COLUMNS + c[:-1, :-1]).ravel()
    corners = np.column_stack([first, first + 1, first + COLUMNS + 1, first + COLUMNS])
    starts = np.arange(0, corners.size, 4, dtype=np.int32)
    return positions, starts, corners.astype(np.int32).ravel()


def simulation(**tear):
    """The sheet, which opens across a row at frame 4."""
    pairs = [[ROW * COLUMNS + i, ROW * COLUMNS + i + 1] for i in range(COLUMNS - 1)]
    top = list(range(COLUMNS * (ROWS - 1), COLUMNS * ROWS))
    tear = {"enabled": True, "openings": [{"frame": 4, "pairs": pairs}], **tear}
    springs = {"stretch": 500.0, "shear": 0.0, "bend": 0.0}
    cloth = {"name": "sheet", "springs": springs, "pins": {"vertices": top}, "tear": tear}
    scene = {"cloth": [cloth], "collision": {"self": False}}
    return boucle_core.Simulation(json.dumps(scene), [grid()], 1)


def pc2(path):
    """(samples, points, 3) (m)."""
    header = np.fromfile(path, dtype="<i4", count=8)
    return np.fromfile(path, dtype="<f4", offset=32).reshape(header[7], header[4], 3)


def corners_of(made):
    """(c, 3) (m)."""
    out = np.empty((len(grid()[2]), 3))
    made.read_corners(0, out)
    return out


def test_a_row_that_opens_parts_the_sheet():
    made = simulation()
    for _ in range(3):
        made.advance()
    # As it opens its sides are drawn apart, by a hair.
    torn = made.torn_edges(0)
    assert sorted(torn) == [(ROW * COLUMNS + i, ROW * COLUMNS + i + 1) for i in range(COLUMNS - 1)]
    for _ in range(12):
        made.advance()
    at, vertices = corners_of(made), grid()[2]
    middle = at[vertices == ROW * COLUMNS + 2]
    assert len(middle) == 4
    assert np.ptp(middle[:, 2]) > 0.3
    # Everything else still holds together.
    for vertex in range(ROWS * COLUMNS):
        if vertex // COLUMNS != ROW:
            assert np.ptp(at[vertices == vertex], axis=0).max() == 0.0
    assert made.vertex_count(0) == ROWS * COLUMNS
    origins = made.vertex_origins(0)
    assert origins[: ROWS * COLUMNS] == list(range(ROWS * COLUMNS))
    assert {origin // COLUMNS for origin in origins[ROWS * COLUMNS :]} == {ROW}
    out = np.empty((ROWS * COLUMNS, 3))
    made.read_positions(0, out)
    assert np.isfinite(out).all()


def test_a_torn_sheet_takes_what_is_told_of_the_sheet_as_it_was():
    made = simulation()
    for _ in range(6):
        made.advance()
    positions = grid()[0]
    made.set_pin_targets(0, positions + np.array([0.0, 0.0, 0.2]))
    made.set_pin_weights(0, np.ones(len(positions)))
    made.set_rest(0, 0.9 * positions)
    made.advance()
    at, vertices = corners_of(made), grid()[2]
    top = vertices >= COLUMNS * (ROWS - 1)
    assert at[top, 2] == pytest.approx(0.1 * (ROWS - 1) + 0.2)
    made.set_positions(0, positions)
    assert corners_of(made) == pytest.approx(positions[vertices])
    made.release_pins(0)
    made.advance()


def test_the_tension_of_edges_is_the_weight_below_them():
    made = simulation(openings=[], force=1e6)
    for _ in range(240):
        made.advance()
    pulls = {(a, b): pull for a, b, pull in made.edge_tension(0)}
    below = [pulls[(ROW * COLUMNS + i, (ROW + 1) * COLUMNS + i)] for i in range(COLUMNS)]
    weight = 0.2 * 0.5 * 0.1 * (ROW + 0.5) * 9.81
    assert sum(below) == pytest.approx(weight, rel=0.01)


@pytest.mark.parametrize(
    ("tear", "words"),
    [
        ({"openings": []}, "nothing says when it tears"),
        ({"strength": [1.0] * 100}, r"cloth\.sheet\.tear\.strength = 100; accepted: at most 54"),
        ({"openings": [{"frame": 2, "pairs": [[0, 9]]}]}, "vertices 0 and 9 are to part"),
        (
            {"openings": [{"frame": 1, "pairs": [[0, 1]]}]},
            r"openings\.0\.frame = 1; accepted: after",
        ),
        ({"force": -1.0}, r"cloth\.sheet\.tear\.force = -1\.0; accepted: 0 to 1e12"),
        ({"strength": [2.0]}, "tear strength is 2; accepted: 0 to 1"),
    ],
)
def test_what_a_sheet_cannot_tear_by_is_refused(tear, words):
    with pytest.raises(boucle_core.SceneError, match=words):
        simulation(**tear)


def test_a_flag_in_a_storm_leaves_caches_of_all_its_pieces(tmp_path):
    small = ["cloth.0.grid.vertices=[19, 13]", "tear.force=2.0"]
    report = boucle_core.bake(str(STORM), str(tmp_path), frames=(1, 40), overrides=small)
    frames = report["frames"]
    assert len(frames) == 40
    assert all(frame["intersections"] == 0 for frame in frames)
    lines = (tmp_path / "flag.obj").read_text().splitlines()
    vertices = sum(line.startswith("v ") for line in lines)
    faces = [
        [int(word.split("/")[0]) - 1 for word in line.split()[1:]]
        for line in lines
        if line.startswith("f ")
    ]
    assert len(faces) == 18 * 12
    samples = pc2(tmp_path / "flag.pc2")
    corners = pc2(tmp_path / "flag.corners.pc2")
    assert samples.shape == (40, vertices, 3)
    assert vertices > 19 * 13
    assert (samples[:, np.concatenate(faces)] == corners).all()


def test_each_corner_tells_the_force_in_the_edge_that_begins_there():
    made = simulation()
    for _ in range(12):
        made.advance()
    vertices = grid()[2]
    force, strain, tension = (np.empty(len(vertices), np.float32) for _ in range(3))
    made.read_corner_numbers(0, "force", force)
    pulls = {(a, b): pull for a, b, pull in made.edge_tension(0)}
    assert sorted({round(float(value), 4) for value in force}) == sorted(
        {round(p, 4) for p in pulls.values()}
    )
    # Of faces that the tear does not touch, each side is the edge of its vertices.
    for face in vertices.reshape(-1, 4):
        if not any(vertex // COLUMNS == ROW for vertex in face):
            first = 4 * int(np.flatnonzero((vertices.reshape(-1, 4) == face).all(axis=1))[0])
            for side in range(4):
                a, b = sorted((int(face[side]), int(face[(side + 1) % 4])))
                assert force[first + side] == pytest.approx(pulls[a, b], abs=1e-5)
    # The edges at the top carry the three and a half rows that still hang from them.
    made.read_corner_numbers(0, "tension", tension)
    weight = 0.2 * 0.1 * 0.35 * 9.81
    assert tension[vertices // COLUMNS == ROWS - 1].max() == pytest.approx(weight, rel=0.1)
    given = np.empty(ROWS * COLUMNS, np.float32)
    made.read_strain(0, given)
    made.read_corner_numbers(0, "strain", strain)
    whole = vertices // COLUMNS != ROW
    assert (strain[whole] == given[vertices[whole]]).all()
    with pytest.raises(
        boucle_core.SceneError, match='quantity = "colour"; accepted: strain, tension'
    ):
        made.read_corner_numbers(0, "colour", strain)


def test_a_named_fabric_tears_at_its_own_stress_unless_the_scene_says_another():
    stress = boucle_core.fabric_presets()["silk_chiffon"]["tear_stress"]

    def torn_at(factor, **tear):
        """Whether a sheet tears whose weight pulls at its top with a part of the fabric's stress."""
        density = factor * stress / (9.81 * 0.1 * (ROWS - 1))
        top = list(range(COLUMNS * (ROWS - 1), COLUMNS * ROWS))
        fabric = {"preset": "silk_chiffon", "limiter": "none", "warp": [0, 0, 1]}
        cloth = {
            "name": "sheet",
            "model": "fabric",
            "fabric": fabric,
            "density": density,
            "pins": {"vertices": top},
        }
        scene = {
            "cloth": [{**cloth, "tear": {"enabled": True, **tear}}],
            "collision": {"enabled": False},
        }
        made = boucle_core.Simulation(json.dumps(scene), [grid()], 1)
        for _ in range(4):
            made.advance()
        return bool(made.torn_edges(0))

    assert torn_at(3.0) and not torn_at(0.2)
    assert not torn_at(3.0, strain=100.0), "a threshold of the scene stands for the fabric's"
    assert torn_at(0.2, stress=0.05 * stress)
