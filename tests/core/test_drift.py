import copy
from array import array

from boucle_addon.core import drift

SCENE = {
    "scene": {"frames": [1, 50], "fps": 24.0, "gravity": [0.0, 0.0, -9.81]},
    "cloth": [
        {"name": "A", "density": 0.2, "pins": {"vertices": [1, 2]}, "springs": {"stretch": 500.0}}
    ],
    "solver": {"integrator": "verlet", "substeps": "auto"},
}


def changed(path, value):
    scene = copy.deepcopy(SCENE)
    *way, last = path
    place = scene
    for key in way:
        place = place[key]
    place[last] = value
    return drift.record(scene, 9, "t")


def words(now):
    return drift.differences(drift.record(SCENE, 9, "t"), now)


def test_nothing_has_changed_where_nothing_has():
    assert words(drift.record(SCENE, 9, "t")) == []


def test_every_change_has_its_word():
    assert words(changed(("cloth", 0, "springs", "stretch"), 501.0)) == ["stretch stiffness"]
    assert words(changed(("solver", "substeps"), 7)) == ["substeps"]
    assert words(changed(("scene", "gravity"), [0, 0, -1.6])) == ["gravity"]
    assert words(changed(("cloth", 0, "pins", "vertices"), [1, 3])) == ["pinned vertices"]
    assert words(changed(("cloth", 0, "pins", "weights"), [1, 0.5])) == ["weights of pins"]
    assert words(drift.record(SCENE, 9, "u")) == ["topology"]
    assert words(drift.record(SCENE, 8, "t")) == ["vertex count (9 baked, 8 now)"]
    assert words(changed(("force",), [{"kind": "wind"}])) == ["kind"]


def test_colliders_and_what_they_do_not_touch_are_named():
    ball = {"name": "Ball.001", "thickness": 0.02, "friction": 0.05}
    box = {**ball, "name": "Box"}
    with_both = drift.record({**SCENE, "collider": [ball, box]}, 9, "t")
    assert words(with_both) == ['collider "Ball.001"', 'collider "Box"']
    rough = drift.record({**SCENE, "collider": [{**ball, "friction": 0.5}, box]}, 9, "t")
    assert drift.differences(with_both, rough) == ['collider "Ball.001"']
    assert drift.differences(with_both, with_both) == []
    left_out = changed(("cloth", 0, "collision"), {"self": True, "excluded_from_self": [1]})
    assert words(left_out) == ["vertices left out of self collision", "self collision"]
    left_out = changed(("cloth", 0, "collision"), {"excluded_from_colliders": [1]})
    assert words(left_out) == ["vertices left out of collision with objects"]


def test_another_name_is_no_change():
    assert words(changed(("cloth", 0, "name"), "B")) == []


def test_what_takes_long_to_gather_may_be_left_out():
    quick = copy.deepcopy(SCENE)
    del quick["cloth"][0]["pins"]
    assert words(drift.record(quick, 9, "")) == []


def test_a_digest_knows_its_parts_and_their_order():
    one, two = array("i", [1, 2]), array("i", [3])
    assert drift.digest(one, two) == drift.digest(one, two)
    assert (
        len({drift.digest(one, two), drift.digest(two, one), drift.digest(array("i", [1, 2, 3]))})
        == 3
    )
    record = drift.record(SCENE, 9, "t")
    assert drift.whole_digest(record) != drift.whole_digest(changed(("solver", "substeps"), 7))


def test_what_is_animated_is_no_drift_and_the_rest_shape_has_its_word():
    from boucle_addon.core import shape

    def at_frame(shrink, rest="", moving=("shrink",)):
        scene = copy.deepcopy(SCENE)
        scene["cloth"][0]["shrink"] = {"min": shrink, "max": 0.0, "weights": [0.0, 1.0]}
        return drift.record(shape.steady(scene, rest, moving), 9, "t")

    assert drift.differences(at_frame(0.1), at_frame(0.2)) == []
    assert drift.differences(at_frame(0.1, moving=()), at_frame(0.2, moving=())) == [
        "shrinking factor"
    ]
    assert drift.differences(at_frame(0.1), at_frame(0.1, "Narrow")) == ["rest shape"]
