"""Blender's fields as force tables."""

import json
import math

import pytest
from boucle_addon.core import drift, fields
from boucle_addon.core.refusal import Refusal

PLAIN = {
    **dict.fromkeys(fields.NUMBERS, 0.0),
    **dict.fromkeys(fields.CHOICES, False),
    "strength": 3.0, "seed": 5, "harmonic_damping": 1.0, "distance_max": 2.0, "radial_min": 10.0,
    "type": "WIND", "shape": "PLANE", "falloff_type": "CONE", "z_direction": "POSITIVE",
}  # fmt: skip


def table(weight=1.0, axis=(0.0, 0.0, 2.0), **values):
    """The force table of a field."""
    field = fields.Field("Fan", PLAIN | values, (1.0, 2.0, 3.0), axis)
    return fields.describe(field, weight)


def test_a_field_becomes_a_force_of_the_scene_with_the_pressure_of_24_frames():
    found = table(0.5, use_max_distance=True)
    assert found["kind"] == "wind_field" and found["shape"] == "plane"
    assert (found["strength"], found["pressure"], found["weight"]) == (3.0, 0.02 * 24, 0.5)
    assert found["location"] == [1.0, 2.0, 3.0] and found["axis"] == [0.0, 0.0, 2.0]
    falloff = {"shape": "cone", "side": "positive", "power": 0.0, "radial_power": 0.0, "max": 2.0}
    assert found["falloff"] == falloff


def test_each_kind_has_keys_of_its_own():
    common = set(table()) - {"flow"}
    own = {
        "FORCE": {"flow", "inverse_square"},
        "WIND": {"flow"},
        "VORTEX": {"flow"},
        "MAGNET": {"flow"},
        "TURBULENCE": {"flow", "size", "global"},
        "DRAG": {"damping"},
        "HARMONIC": {"damping", "rest_length"},
    }
    assert set(own) == set(fields.KINDS) == set(fields.WEIGHTS)
    for kind, keys in own.items():
        assert set(table(type=kind)) == common | keys, kind
    assert table(type="DRAG", strength=9.0, harmonic_damping=-1.0)["strength"] == 2.0
    assert table(type="DRAG", harmonic_damping=-1.0)["damping"] == 0.0


def test_a_field_flattened_to_nothing_points_upward():
    assert table(axis=(0.0, 0.0, 0.0))["axis"] == [0.0, 0.0, 1.0]


@pytest.mark.parametrize("value", [math.inf, math.nan, 1e10])
def test_numbers_that_no_simulation_takes_are_refused_by_the_fields_name(value):
    with pytest.raises(Refusal, match='"Fan" has a falloff power of'):
        table(falloff_power=value)


def test_the_weight_of_all_multiplies_that_of_a_kind():
    weights = {"all": 0.5, **dict.fromkeys(fields.WEIGHTS.values(), 1.0), "wind": 0.25}
    field = fields.Field("Fan", PLAIN, (0.0,) * 3, (0.0, 0.0, 1.0))
    assert json.loads(fields.encode([field], weights))[0]["weight"] == 0.125


def test_a_changed_field_is_named_as_drift():
    def record(strength):
        return drift.record({}, 4, "", {'force field "Fan"': {"strength": strength}})

    assert drift.differences(record(1.0), record(1.0)) == []
    assert drift.differences(record(1.0), record(2.0)) == ['force field "Fan"']
    assert drift.differences(record(1.0), drift.record({}, 4, "")) == ['force field "Fan"']
