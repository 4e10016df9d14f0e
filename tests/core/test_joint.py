"""Several cloths in one scene description."""

from boucle_addon.core import joint


def scene(name, start=1, end=10, colliders=(), force=None, **solver):
    out = {
        "scene": {"frames": [start, end], "fps": 24.0, "gravity": [0.0, 0.0, -9.81]},
        "cloth": [{"name": name, "collision": {"self": False, "thickness": 0.01}}],
        "solver": {"integrator": "bdf2", "tolerance": 5e-3, **solver},
    }
    if force:
        out["force"] = [force]
    if colliders:
        out["collider"] = [{"name": other, "thickness": 0.0} for other in colliders]
    return out


def always(_one, _other):
    return True


def test_a_joint_scene_ends_last_is_the_finest_and_keeps_to_each_its_own():
    gale = {"kind": "wind", "velocity": [1, 0, 0]}
    one = scene("A", end=10, colliders=("floor",), force={**gale, "region": {"vertices": [3]}})
    two = scene("B", end=30, colliders=("ball", "floor"), tolerance=1e-3, force=gale)
    joined = joint.join([one, two], always)
    assert joined["scene"]["frames"] == [1, 30]
    assert joined["solver"]["tolerance"] == 1e-3
    assert [thing["name"] for thing in joined["collider"]] == ["ball", "floor"]
    collisions = [cloth["collision"] for cloth in joined["cloth"]]
    assert [found["colliders"] for found in collisions] == [["floor"], ["ball", "floor"]]
    assert [found["cloths"] for found in collisions] == [["B"], ["A"]]
    assert [force["region"] for force in joined["force"]] == [
        {"vertices": [3], "cloth": "A"},
        {"cloth": "B"},
    ]
    assert one == scene("A", colliders=("floor",), force={**gale, "region": {"vertices": [3]}})


def test_cloths_that_do_not_meet_name_those_that_they_do():
    met = {frozenset("AB"), frozenset("BC")}
    scenes = [scene(name) for name in "ABC"]
    joined = joint.join(scenes, lambda one, other: frozenset((one, other)) in met)
    assert [cloth["collision"]["cloths"] for cloth in joined["cloth"]] == [["B"], ["A", "C"], ["B"]]
    assert "collider" not in joined and "force" not in joined


def test_those_are_together_that_meet_by_way_of_others_too_and_the_others_are_told_why_not():
    scenes = [
        scene("A"),
        scene("B", start=3),
        scene("C", tolerance=1e-3),
        scene("D", integrator="verlet"),
        scene("E", substeps=4),
        scene("F", start=3, end=99),
    ]
    found = joint.groups(scenes, always, dict.fromkeys("ABCDEF", ""))
    assert found.together == [["A", "C"], ["B", "F"], ["D"], ["E"]]
    told = dict(sentence.split(" are baked one after the other ") for sentence in found.apart)
    assert told['"A" and "B"'] == "and do not collide: their start frames differ"
    assert "integrators differ" in told['"A" and "D"']
    assert "substeps differ" in told['"A" and "E"']
    assert '"A" and "C"' not in told
    chain = {frozenset("AC"), frozenset("CF")}
    scenes = [scene(name) for name in "ABCDEF"]

    def meets(one, other):
        return frozenset((one, other)) in chain

    found = joint.groups(scenes, meets, dict.fromkeys("ABCDEF", ""))
    assert found == ([["A", "C", "F"], ["B"], ["D"], ["E"]], [])
    found = joint.groups(scenes, meets, {**dict.fromkeys("ABDEF", ""), "C": "a wind"})
    assert found.together == [["A"], ["B"], ["C"], ["D"], ["E"], ["F"]]
    assert "force fields or field weights differ" in found.apart[0]
