import json
from array import array

import boucle_core
from boucle_addon.core import crossing_scene

SCENE = {
    "scene": {"frames": [1, 9], "fps": 24.0, "gravity": [0.0, 0.0, -9.81]},
    "cloth": [
        {"name": "Cloth", "pins": {"vertices": [0]}, "collision": {"self": True, "thickness": 0.01}}
    ],
    "solver": {"integrator": "bdf2"},
}
FACES = (array("i", [0, 3]), array("i", [0, 1, 2, 3, 4, 5]))
FLAT = [0, 0, 0, 1, 0, 0, 0, 1, 0]
THROUGH = [0.2, 0.2, -1, 0.3, 0.2, 1, 0.2, 0.3, 1]


def crossings(scene, positions, colliders=()):
    solver = boucle_core.Simulation(
        json.dumps(scene), [(array("d", positions), *FACES)], colliders=colliders
    )
    out = array("f", bytes(4 * 6))
    solver.read_intersections(0, out)
    return [vertex for vertex, count in enumerate(out) if count]


def test_two_triangles_through_each_other_are_counted_at_their_vertices():
    asked = crossing_scene.against_itself(SCENE)
    assert crossings(asked, FLAT + THROUGH) == [0, 1, 2, 3, 4, 5]
    apart = [*FLAT, *(value + 5 for value in THROUGH)]
    assert crossings(asked, apart) == []
    off = {**SCENE["cloth"][0], "collision": {"enabled": False}}
    assert crossing_scene.against_itself({**SCENE, "cloth": [off]}) is None


def test_an_object_is_asked_alone_and_need_not_be_a_collider():
    body = (array("d", THROUGH), array("i", [0]), array("i", [0, 1, 2]))
    far = [value + 5 for value in THROUGH]
    asked = crossing_scene.against(SCENE, "Body")
    assert crossings(asked, FLAT + far, [body]) == [0, 1, 2]
    assert crossings(asked, far + far, [body]) == [], (
        "a cloth that crosses itself is not asked here"
    )
    assert crossing_scene.against_colliders(SCENE) is None
    with_body = {**SCENE, "collider": [{"name": "Body", "thickness": 0.0, "friction": 0.3}]}
    assert crossings(crossing_scene.against_colliders(with_body), FLAT + far, [body]) == [0, 1, 2]
