"""Force fields and gravity that the class Simulation is told from frame to frame."""

import json

import boucle_core
import numpy as np
import pytest

WIND = {"kind": "wind_field", "strength": 2.0, "axis": [0, 1, 0]}


def free(sheet, *forces):
    scene = json.loads(sheet.scene(pins=[], springs={"air_damping": 0}))
    scene["scene"]["gravity"] = [0, 0, 0]
    scene["force"] = list(forces)
    scene["solver"] = {"integrator": "implicit_euler"}  # exact where nothing changes within a frame
    return boucle_core.Simulation(json.dumps(scene), [sheet.mesh()], 1)


def speeds(simulation):
    out = np.zeros((36, 3))
    simulation.read_velocities(0, out)
    return out


def test_fields_of_the_scene_push_and_fields_that_are_told_take_their_place(sheet):
    simulation = free(sheet, WIND)
    simulation.advance()
    # 2 N/m² on 0.2 kg/m².
    assert speeds(simulation)[7] == pytest.approx([0, 10 / 24, 0], abs=1e-6)
    simulation.set_fields("[]")
    simulation.advance()
    assert speeds(simulation)[7] == pytest.approx([0, 10 / 24, 0], abs=1e-6)
    simulation.set_fields(json.dumps([{**WIND, "strength": -2}, {**WIND, "pressure": 0.5}]))
    simulation.set_gravity((0.0, 0.0, -4.0))
    simulation.advance()
    assert speeds(simulation)[7] == pytest.approx([0, 5 / 24, -4 / 24], abs=1e-6)


@pytest.mark.parametrize(
    ("fields", "match"),
    [
        ("[", "the fields are not JSON"),
        ("[{}]", "force.0.kind is missing"),
        (json.dumps([WIND, {**WIND, "flow": -1}]), "force.1: force field: flow is -1; accepted: 0"),
        (json.dumps([{**WIND, "gust": 1}]), "force.0.gust is an unknown key"),
    ],
)
def test_fields_that_are_not_accepted_leave_those_before(sheet, fields, match):
    simulation = free(sheet, WIND)
    with pytest.raises(boucle_core.SceneError, match=match):
        simulation.set_fields(fields)
    simulation.advance()
    assert speeds(simulation)[7][1] > 0.4


def test_a_wind_blows_as_it_is_told_from_frame_to_frame(sheet):
    blow = {"kind": "wind", "coefficient": 1e-3, "velocity": [0, 1, 0]}
    still = {**blow, "velocity": [0, 0, 0]}
    steady, turned = free(sheet, still, {**blow, "velocity": [0, 3, 0]}), free(sheet, still, blow)
    turned.set_wind_velocity(1, (0.0, 3.0, 0.0))
    assert turned.advance()["hash"] == steady.advance()["hash"]
    before = speeds(turned)[7][1]
    turned.set_wind_velocity(1, (0.0, -1.0, 0.0))
    turned.advance()
    assert speeds(turned)[7][1] < 0.9 * before
    for wrong, match in (((2, (0.0, 0.0, 0.0)), "number of a wind"), ((0, (0.0, 2e4, 0.0)), "1e4")):
        with pytest.raises(boucle_core.SceneError, match=match):
            turned.set_wind_velocity(*wrong)


def test_gravity_must_be_three_finite_numbers(simulation):
    with pytest.raises(boucle_core.SceneError, match=r"gravity .* is inf; accepted: -1e6 to 1e6"):
        simulation.set_gravity((0.0, 0.0, float("inf")))
    with pytest.raises((TypeError, ValueError)):
        simulation.set_gravity((0.0, 1.0))
