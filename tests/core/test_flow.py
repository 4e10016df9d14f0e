"""Wind and water of a cloth as forces of its scene description."""

import json

import pytest
from boucle_addon.core import drift, flow, joint

VALUES = {
    "use_wind": True, "wind_velocity": (0.0, 3.0, 0.0), "wind_law": "face", "wind_coefficient": 0.02,
    "wind_air_density": 1.2, "wind_drag": 1.0, "use_wind_lift": False, "wind_lift": 0.8, "wind_gusts": 0.0,
    "wind_gust_period": 2.0, "wind_turbulence": 0.0, "wind_turbulence_size": 1.5, "wind_seed": 4,
    "use_wind_shelter": False,
    "use_water": True, "water_level": 0.5, "water_velocity": (1.0, 0.0, 0.0), "water_density": 1000.0, "water_drag": 1.0,
    "water_friction": 0.01, "wave_amplitude": 0.0, "wave_length": 3.0, "wave_angle": 0.0, "bulk_density": 500.0,
    "water_hull": "auto", "absorbency": 0.0, "soak_time": 10.0, "dry_time": 0.0,
}  # fmt: skip


def test_a_plain_wind_says_no_more_than_before():
    plain = {"kind": "wind", "velocity": [0.0, 3.0, 0.0], "air_density": 1.2}
    assert flow.wind(VALUES, None) == plain
    assert flow.wind(VALUES, [3]) == {**plain, "region": {"vertices": [3]}}
    assert flow.wind({**VALUES, "use_wind": False}, None) is None and flow.wind(VALUES, []) is None


def test_a_wind_with_all_that_it_may_have():
    strong = {
        "wind_drag": 1.17, "use_wind_lift": True, "wind_gusts": 0.5, "wind_turbulence": 0.2, "use_wind_shelter": True,
    }  # fmt: skip
    assert flow.wind({**VALUES, **strong}, None) == {
        "kind": "wind", "velocity": [0.0, 3.0, 0.0], "air_density": 1.2, "drag_coefficient": 1.17,
        "lift_coefficient": 0.8, "gusts": {"strength": 0.5, "period": 2.0, "seed": 4},
        "turbulence": {"intensity": 0.2, "size": 1.5, "seed": 4}, "shelter": True,
    }  # fmt: skip
    by_vertex = flow.wind({**VALUES, **strong, "wind_law": "vertex"}, None)
    assert by_vertex["coefficient"] == 0.02 and "drag_coefficient" not in by_vertex


def test_water_and_what_a_cloth_is_in_it():
    assert flow.water({**VALUES, "use_water": False}) is None
    calm = flow.water(VALUES)
    assert calm["level"] == 0.5 and calm["velocity"] == [1.0, 0.0, 0.0] and "waves" not in calm
    (wave,) = flow.water({**VALUES, "wave_amplitude": 0.1, "wave_angle": 1.5707963})["waves"]
    assert wave["length"] == 3.0 and wave["direction"] == pytest.approx([0.0, 1.0, 0.0], abs=1e-6)
    assert flow.bulk(VALUES) == {} == flow.bulk({**VALUES, "use_water": False, "absorbency": 2.0})
    towel = {"bulk_density": 400.0, "water_hull": "wet", "absorbency": 2.0, "dry_time": 60.0}
    assert flow.bulk({**VALUES, **towel}) == {
        "bulk_density": 400.0, "absorbency": 2.0, "hull": False, "soak_time": 10.0, "dry_time": 60.0,
    }  # fmt: skip
    assert flow.bulk({**VALUES, "water_hull": "dry"}) == {"hull": True}


def of(name, **values):
    forces = [flow.wind({**VALUES, **values}, None), flow.water({**VALUES, **values})]
    cloth = {"name": name, "collision": {"self": False}}
    head = {"frames": [1, 5], "fps": 24.0, "gravity": [0.0, 0.0, -9.81]}
    solver = {"integrator": "bdf2"}
    return {
        "scene": head,
        "cloth": [cloth],
        "solver": solver,
        "force": [one for one in forces if one],
    }


def test_cloths_that_meet_are_in_one_water():
    joined = joint.join([of("A"), of("B")], lambda _one, _other: True)
    kinds = [(force["kind"], force.get("region")) for force in joined["force"]]
    assert kinds == [("wind", {"cloth": "A"}), ("wind", {"cloth": "B"}), ("water", None)]
    scenes = [of("A"), of("B", water_level=0.6)]
    found = joint.groups(scenes, lambda _one, _other: True, dict.fromkeys("AB", ""))
    assert found.together == [["A"], ["B"]]
    assert found.apart == [
        '"A" and "B" are baked one after the other and do not collide: their waters differ'
    ]


def test_a_record_tells_wind_and_water_apart():
    records = [
        drift.record(of("A", **values), 4, "")
        for values in ({}, {"water_level": 0.6}, {"wind_drag": 2.0})
    ]
    json.dumps(records)
    assert drift.differences(records[0], records[1]) == ["water level"]
    assert drift.differences(records[0], records[2]) == ["drag coefficient"]
    assert records[0]["settings"]["force.velocity"] == [0.0, 3.0, 0.0]
