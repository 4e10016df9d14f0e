import json
from array import array

import boucle_core
import pytest
from boucle_addon.core import scene_json
from boucle_addon.core.refusal import Refusal
from boucle_addon.core.scene_json import CollisionObject, Groups, World

VALUES = {
    "frame_start": 1, "frame_end": 50, "mass_mode": "density", "density": 0.2, "mass_per_vertex": 0.1,
    "stretch": 500.0, "shear": 100.0, "bend": 5.0, "damping": 0.01, "damping_per_kind": False,
    "damping_stretch": 0.1, "damping_shear": 0.2, "damping_bend": 0.3, "damping_law": "relative",
    "air_damping": 0.001, "deformation_rate": 0.10000000149011612, "limiter": "project",
    "stiffness_from": "springs", "quality": "normal", "tolerance": 0.05, "linear_solver": "auto",
    "integrator": "symplectic_euler", "substeps": 0, "time_step": 0.0, "allow_unstable": False,
    "use_wind": False, "wind_velocity": (0.0, 3.0, 0.0), "wind_law": "vertex",
    "wind_coefficient": 0.02, "wind_air_density": 1.2,
}  # fmt: skip
WORLD = World((0.0, 0.0, -9.8100004196167), 24.0)
GROUPS = Groups([2, 3], None)


COLLIDING = {"self_collision": True, "thickness": 0.0049999998882, "friction": 0.30000001192}
BODY = CollisionObject("Body", 0.019999999552965164, 5.0)
BELOW = (array("d", [0, 0, -1, 1, 0, -1, 0, 1, -1]), array("i", [0]), array("i", [0, 1, 2]))


def described(world=WORLD, groups=GROUPS, colliders=(), **changes):
    return scene_json.describe("Cloth", {**VALUES, **changes}, world, groups, colliders)


def simulation(scene, colliders=()):
    """The solver on a quad of 1 m."""
    positions = array("d", [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0])
    mesh = (positions, array("i", [0]), array("i", [0, 1, 2, 3]))
    return boucle_core.Simulation(scene_json.encode(scene), [mesh], colliders=colliders)


def test_numbers_are_those_that_the_user_typed():
    scene = described()
    assert scene["cloth"][0]["springs"]["deformation_rate"] == 0.1
    assert scene["scene"] == {"frames": [1, 50], "fps": 24.0, "gravity": [0.0, 0.0, -9.81]}
    assert json.loads(scene_json.encode(scene)) == scene


def test_settling_begins_before_the_start_and_is_no_key_of_the_solver():
    scene = described(settle_frames=7, settle_damped=False)
    assert scene["scene"]["frames"] == [1, 50]
    assert scene_json.settling(scene) == (7, False)
    assert simulation(scene).frame == -6
    assert scene_json.settling(described(settle_frames=0)) == (0, True)


def test_a_speed_makes_frames_longer_for_the_cloth_alone():
    assert "speed" not in described(speed=1.0)["scene"]
    scene = described(speed=0.5)
    assert scene["scene"]["fps"] == 24.0 and scene["scene"]["speed"] == 0.5
    head = json.loads(scene_json.encode(scene))["scene"]
    assert head["fps"] == 48.0 and "speed" not in head
    assert simulation(scene).frame == 1


def test_mass_damping_and_steps_are_given_one_way_each():
    cloth = described()["cloth"][0]
    assert cloth["density"] == 0.2 and "mass_per_vertex" not in cloth
    assert cloth["springs"]["damping"] == 0.01 and "damping_bend" not in cloth["springs"]
    cloth = described(mass_mode="vertex", damping_per_kind=True)["cloth"][0]
    assert cloth["mass_per_vertex"] == 0.1 and "density" not in cloth
    assert cloth["springs"]["damping_bend"] == 0.3 and "damping" not in cloth["springs"]
    assert described()["solver"]["substeps"] == "auto"
    assert described(substeps=9)["solver"]["substeps"] == 9
    assert "substeps" not in described(time_step=0.001)["solver"]


def test_only_automatic_steps_of_implicit_integrators_have_a_tolerance():
    for integrator in ("bdf2", "implicit_euler"):
        solver = described(integrator=integrator)["solver"]
        assert solver["tolerance"] == 5e-3 and solver["linear_solver"] == "auto"
        assert described(integrator=integrator, quality="draft")["solver"]["tolerance"] == 2e-2
        assert described(integrator=integrator, quality="final")["solver"]["tolerance"] == 1e-3
        assert described(integrator=integrator, quality="custom")["solver"]["tolerance"] == 0.05
        for step in ({"substeps": 4}, {"time_step": 0.01}):
            assert "tolerance" not in described(integrator=integrator, **step)["solver"]
    assert not {"tolerance", "linear_solver"} & set(described()["solver"])


def test_the_module_agrees_on_which_integrators_are_implicit():
    for name in ("bdf2", "implicit_euler", "symplectic_euler", "verlet", "midpoint", "rk4"):
        solver = simulation(described(integrator=name))
        is_implicit = solver.safe_time_step == pytest.approx(1.0 / WORLD.fps)
        assert is_implicit == (name in scene_json.IMPLICIT), name


def test_pins_and_wind_are_there_only_if_they_act():
    assert described()["cloth"][0]["pins"] == {"vertices": [2, 3]}
    assert "pins" not in described(groups=Groups([], None))["cloth"][0]
    hard = Groups([2, 3], None, pin_weights=[1.0, 1.0])
    assert described(groups=hard) == described(), "bakes from before there were soft pins stay"
    soft = Groups([2, 3], None, pin_weights=[1.0, 0.30000001192])
    cloth = described(groups=soft, pin_stiffness=1000.0, pin_damping=2.5)["cloth"][0]
    assert cloth["pins"] == {"vertices": [2, 3], "weights": [1.0, 0.3]}
    assert cloth["pin_damping"] == 2.5 and "pin_stiffness" not in cloth
    simulation(described(groups=soft, pin_stiffness=50.0)).advance()
    assert "force" not in described()
    wind = described(use_wind=True)["force"][0]
    assert wind == {"kind": "wind", "velocity": [0.0, 3.0, 0.0], "coefficient": 0.02}
    wind = described(use_wind=True, wind_law="face", groups=Groups([], [1]))["force"][0]
    assert wind["air_density"] == 1.2 and wind["region"] == {"vertices": [1]}
    assert "force" not in described(use_wind=True, groups=Groups([], []))


def test_a_cloth_collides_as_its_settings_say_and_without_them_not_at_all():
    assert described()["cloth"][0]["collision"] == {"enabled": False}
    collision = described(**COLLIDING)["cloth"][0]["collision"]
    assert collision == {"self": True, "thickness": 0.005, "friction": 0.3}
    loose = {**COLLIDING, "self_collision": False}
    assert described(**loose)["cloth"][0]["collision"] == {"enabled": False}
    collision = described(colliders=[BODY], **loose)["cloth"][0]["collision"]
    assert collision == {"self": False, "thickness": 0.005, "friction": 0.3}


def test_excluded_vertices_are_named_only_where_they_could_touch():
    groups = Groups([], None, [0, 1], [2])
    collision = described(groups=groups, **COLLIDING)["cloth"][0]["collision"]
    assert collision["excluded_from_self"] == [0, 1] and "excluded_from_colliders" not in collision
    loose = {**COLLIDING, "self_collision": False}
    scene = described(groups=groups, colliders=[BODY], **loose)
    collision = scene["cloth"][0]["collision"]
    assert collision["excluded_from_colliders"] == [2] and "excluded_from_self" not in collision
    simulation(scene, [BELOW]).advance()


def test_what_depends_on_springs_alone_may_be_asked_without_contact():
    scene = described(colliders=[BODY], **COLLIDING)
    bare = scene_json.without_contact(scene)
    assert "collider" not in bare and bare["cloth"][0]["collision"] == {"enabled": False}
    assert bare["cloth"][0]["springs"] == scene["cloth"][0]["springs"] and "collider" in scene
    assert simulation(bare).safe_time_step == simulation(scene, [BELOW]).safe_time_step


def test_the_friction_of_a_collision_object_is_a_hundredth_of_blenders():
    assert "collider" not in described()
    scene = described(colliders=[BODY], **COLLIDING)
    assert scene["collider"] == [{"name": "Body", "thickness": 0.02, "friction": 0.05}]
    solver = simulation(scene, [BELOW])
    assert solver.collider_names == ["Body"]


def test_contradictions_are_refused():
    with pytest.raises(Refusal, match=r"Substeps is 3 and Time Step is 0\.01 s"):
        described(substeps=3, time_step=0.01)
    with pytest.raises(Refusal, match="the end frame is 0, before the start frame 1"):
        described(frame_end=0)


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"mass_mode": "vertex"},
        {"damping_per_kind": True, "damping_law": "axial"},
        {"substeps": 500},
        {"time_step": 0.0001},
        {"use_wind": True},
        {"use_wind": True, "wind_law": "face"},
        {"frame_start": -10, "frame_end": -10},
        COLLIDING,
        {**COLLIDING, "self_collision": False, "friction": 0.0},
        *({"limiter": name} for name in ("none", "stiffen", "provot", "project")),
        *(
            {"integrator": name, "damping": 0.0 if name == "leapfrog" else 0.01}
            for name in ("symplectic_euler", "verlet", "leapfrog", "midpoint", "rk4")
        ),
        *(
            {"integrator": name, **more}
            for name in ("bdf2", "implicit_euler")
            for more in (
                {},
                {"quality": "custom", "tolerance": 1e-6},
                {"substeps": 3},
                {"time_step": 0.01},
                {"linear_solver": "ldlt"},
                {"linear_solver": "multigrid"},
                {"stiffness_from": "continuum"},
            )
        ),
        {"integrator": "forward_euler", "air_damping": 0.5, "damping": 0.5},
    ],
)
def test_the_solver_takes_every_description(changes):
    solver = simulation(described(**changes))
    assert solver.frame == {**VALUES, **changes}["frame_start"]
    assert solver.advance()["frame"] == solver.frame


def test_the_solver_takes_groups():
    solver = simulation(described(use_wind=True, groups=Groups([0, 3], [1, 2])))
    before = array("d", bytes(96))
    solver.read_positions(0, before)
    for _ in range(5):
        solver.advance()
    after = array("d", bytes(96))
    solver.read_positions(0, after)
    assert after[:3] == before[:3] and after[9:] == before[9:]
    assert after[3:9] != before[3:9]


FABRIC = {
    "model": "fabric", "stretch_warp": 3000.0, "stretch_weft": 1500.0, "bend_warp": 2.000000049e-5,
    "bend_weft": 1e-5, "use_compression": False, "compression_warp": 10.0, "compression_weft": 20.0,
    "damping_ratio": 0.02, "damping_ratio_per_kind": False, "damping_ratio_stretch": 0.1,
    "damping_ratio_shear": 0.2, "damping_ratio_bend": 0.3, "warp": "z", "warp_uv_map": "",
    "yield_curvature": 0.0, "hardening": 0.25, "bend_hysteresis": 0.0,
}  # fmt: skip
TURNED = (0.0, 0.0, 2.0, 7.0, 0.0, 1.0, 0.0, 7.0, -2.0, 0.0, 0.0, 7.0)
"""The local z axis to x, and twice as long."""


def test_fabric_has_the_keys_of_its_table_and_the_solver_takes_them():
    cloth = described(**FABRIC)["cloth"][0]
    assert cloth["model"] == "fabric" and "springs" not in cloth
    assert cloth["fabric"] == {
        "stretch_warp": 3000.0, "stretch_weft": 1500.0, "shear": 100.0, "bend_warp": 2e-5, "bend_weft": 1e-5,
        "damping_ratio": 0.02, "air_damping": 0.001, "deformation_rate": 0.1, "warp": [0.0, 0.0, 1.0],
        "limiter": "project",
    }  # fmt: skip
    own = {**FABRIC, "use_compression": True, "damping_ratio_per_kind": True}
    fabric = described(**own)["cloth"][0]["fabric"]
    assert fabric["compression_weft"] == 20.0 and fabric["damping_ratio_bend"] == 0.3
    assert "damping_ratio" not in fabric
    creased = {**FABRIC, "yield_curvature": 150.0, "bend_hysteresis": 5.00000024e-4}
    fabric = described(**creased)["cloth"][0]["fabric"]
    assert [fabric[key] for key in ("yield_curvature", "hardening", "bend_hysteresis")] == [
        150.0,
        0.25,
        5e-4,
    ]
    for values in (FABRIC, own, creased):
        scene = described(**{**values, "integrator": "bdf2"})
        simulation(scene).advance()


def test_a_warp_along_an_axis_turns_with_its_object_and_a_map_does_not():
    def turned(**changes):
        scene = described(**{**FABRIC, **changes})
        return scene_json.in_world(scene, [TURNED])["cloth"][0]

    assert turned()["fabric"]["warp"] == [2.0, 0.0, 0.0]
    assert turned(warp="x")["fabric"]["warp"] == [0.0, 0.0, -2.0]
    assert turned(warp="uv")["fabric"]["warp"] == "uv"
    springs = described()
    assert scene_json.in_world(springs, [TURNED]) == springs


def test_the_limiter_that_is_for_springs_is_refused_for_fabric():
    assert described(limiter="stiffen")["cloth"][0]["springs"]["limiter"] == "stiffen"
    with pytest.raises(Refusal, match="Stiffen is for springs"):
        described(**FABRIC, limiter="stiffen")
