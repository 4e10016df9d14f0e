"""Colliders of the class Simulation: given as numbers in the scene or as meshes beside it."""

import json
from array import array

import boucle_core
import numpy as np
import pytest

TRIANGLE = (array("f", [0, 0, -5, 1, 0, -5, 0, 1, -5]), array("i", [0]), array("i", [0, 1, 2]))
BALL = {"name": "ball", "sphere": {"center": [0, 0, -9], "radius": 0.5}}
BODY = {"name": "body", "friction": 0.1}
FLOOR = {"name": "floor", "plane": {"point": [0, 0, -9], "normal": [0, 0, 1]}}
BOX = {"name": "box", "box": {"center": [0, 0, -9], "size": [1, 1, 1]}}
ROD = {"name": "rod", "capsule": {"a": [0, 0, -9], "b": [1, 0, -9], "radius": 0.1}}


def among(sheet, *colliders, meshes=(), **cloth):
    scene = json.loads(sheet.scene(**cloth))
    scene["collider"] = list(colliders)
    return boucle_core.Simulation(json.dumps(scene), [sheet.mesh()], 1, meshes)


@pytest.fixture
def body(sheet):
    return among(sheet, BALL, BODY, meshes=[TRIANGLE])


def refused(match):
    return pytest.raises(boucle_core.SceneError, match=match)


def test_colliders_have_names_and_points_in_the_order_of_the_scene(sheet):
    simulation = among(sheet, BALL, BODY, FLOOR, BOX, ROD, meshes=[TRIANGLE])
    assert simulation.collider_names == ["ball", "body", "floor", "box", "rod"]
    counts = [simulation.collider_point_count(index) for index in range(5)]
    assert counts == [1, 3, 2, 8, 2]
    assert among(sheet).collider_names == []


def test_colliders_take_targets_for_the_next_frame(body):
    for number, points in ((0, 1), (1, 3)):
        for kind in (np.float32, np.float64):
            targets = np.zeros((points, 3), kind)
            targets[:, 2] = -4.0
            body.set_collider_targets(number, targets)
            body.set_collider_targets(number, targets.ravel())
    assert body.advance()["frame"] == 2


@pytest.mark.parametrize(
    ("targets", "match"),
    [
        (np.zeros((2, 3)), r"targets has the shape \[2, 3\]; accepted: \(3, 3\), or flat"),
        (np.zeros((3, 2)), r"shape \[3, 2\]"),
        (np.zeros((3, 3), np.int32), 'format "i"; accepted: float32 or float64'),
        (np.full((3, 3), np.nan), "targets of vertex 0 is .*NaN"),
        (np.full((3, 3), np.inf), "targets of vertex 0 is .*inf"),
        (np.full((3, 3), 1e7), "accepted: numbers of at most 1e6 m"),
        (np.zeros((3, 6))[:, ::2], "not C-contiguous"),
    ],
)
def test_wrong_targets_are_refused(body, targets, match):
    with refused(match):
        body.set_collider_targets(1, targets)


@pytest.mark.parametrize("collider", [-1, 2, 2**40])
def test_a_collider_that_is_not_there_is_refused(body, simulation, collider):
    with refused(f"collider = {collider}; accepted: 0 to 1"):
        body.collider_point_count(collider)
    with refused(f"collider = {collider}; accepted: 0 to 1"):
        body.set_collider_targets(collider, np.zeros((1, 3)))
    with refused(f"collider = {collider}; accepted: none, as there are no colliders"):
        simulation.collider_point_count(collider)


def test_meshes_and_colliders_without_a_shape_must_pair(sheet):
    for meshes in ([], [TRIANGLE] * 2):
        with refused(f"colliders holds {len(meshes)}; accepted: 1, one for each collider"):
            among(sheet, BALL, BODY, meshes=meshes)
    with refused("colliders holds 1; accepted: 0"):
        among(sheet, BALL, meshes=[TRIANGLE])


@pytest.mark.parametrize(
    ("positions", "starts", "corners", "match"),
    [
        ([0, 0, 0, 1, 0, 0], [0], [0, 1, 2], 'collider "body": face 0 names vertex 2; accepted: 0 to 1'),
        ([0, 0, 0], [], [], 'collider "body" has no faces; accepted: a mesh with at least one face'),
        ([], [], [], 'collider "body" has no faces'),
        ([0, 0, 0, 1, 0, 0, 0, 1, 0], [1], [0, 1, 2], 'collider "body": the face starts'),
        ([0, 0, 0, 1, 0, 0, 0, 1], [0], [0, 1, 2], 'positions of collider "body" has the shape'),
        ([0, 0, 0, 1, 0, 0, 0, np.nan, 0], [0], [0, 1, 2], 'collider "body".*NaN'),
        ([0, 0, 0, 1, 0, 0, 0, 1e7, 0], [0], [0, 1, 2], 'collider "body".*within 1e6 m'),
    ],
)  # fmt: skip
def test_broken_meshes_are_refused(sheet, positions, starts, corners, match):
    mesh = (array("d", positions), array("i", starts), array("i", corners))
    with refused(match):
        among(sheet, BODY, meshes=[mesh])


@pytest.mark.parametrize(
    ("keys", "match"),
    [
        (
            {"mesh": "body.obj"},
            r"collider\.body: mesh; accepted: none, as the mesh is given beside",
        ),
        ({"cache": "body.pc2"}, r"collider\.body\.cache: accepted only with mesh"),
        ({"up": "y"}, r"collider\.body\.up: accepted only with mesh"),
        ({"frction": 1}, 'collider.body.frction is an unknown key; did you mean "friction"'),
        ({"friction": -1}, r"collider\.body\.friction = -1\.0; accepted: 0 to 100"),
        ({"thickness": -1}, r"collider\.body\.thickness = -1\.0; accepted: 0 to 100 m"),
        ({"name": "ball"}, r'collider\.1\.name = "ball"; accepted: a name that no other'),
    ],
)
def test_colliders_are_refused_by_their_key(sheet, keys, match):
    with refused(match) as caught:
        among(sheet, BALL, {**BODY, **keys}, meshes=[TRIANGLE])
    assert "\n" not in str(caught.value)


def test_a_cloth_names_the_colliders_that_it_meets(sheet):
    touching = {"enabled": True, "colliders": ["body"]}
    among(sheet, BALL, BODY, meshes=[TRIANGLE], collision=touching).advance()
    with refused(r'collision\.colliders\.0 = "bod"; accepted: "ball", "body"'):
        wrong = {"colliders": ["bod"]}
        among(sheet, BALL, BODY, meshes=[TRIANGLE], collision=wrong)


def test_a_cloth_with_a_velocity_is_on_its_way_at_the_first_frame(sheet):
    simulation = among(sheet, velocity=[0, 0, -30])
    velocities = np.empty((36, 3))
    simulation.read_velocities(0, velocities)
    assert (velocities[sheet.top_corners] == 0).all()
    free = [vertex for vertex in range(36) if vertex not in sheet.top_corners]
    assert (velocities[free] == [0, 0, -30]).all()
