"""The settings of Blender's cloth in ours: by the numbers that were measured in Blender."""

import math

import pytest
from boucle_addon.core import blender_cloth
from boucle_addon.core.blender_cloth import Reading

DEFAULTS = {
    "mass": 0.3, "tension_stiffness": 15.0, "compression_stiffness": 15.0, "shear_stiffness": 5.0,
    "bending_stiffness": 0.5, "bending_model": "ANGULAR", "tension_damping": 5.0,
    "shear_damping": 5.0, "bending_damping": 0.5, "air_damping": 1.0, "quality": 5,
    "use_self_collision": False, "self_distance_min": 0.015, "distance_min": 0.02,
}  # fmt: skip


def reading(**values):
    """A sheet of 2 m x 2 m with 21² vertices."""
    return Reading({**DEFAULTS, **values}, 441, 4.0, 0.1)


def test_mass_is_that_of_all_vertices_on_the_area():
    assert blender_cloth.density(reading()) == pytest.approx(132.3 / 4.0)


def test_a_strip_hangs_as_far_as_blender_s_does():
    # measured in Blender 4.5: the first edge under ten vertices of 0.3 kg, tension 5, edge 0.1 m, at 24 and at 48 fps
    stiffness = blender_cloth.spring("tension_stiffness")(reading(tension_stiffness=5.0))
    assert 10 * 0.3 * 9.81 / stiffness == pytest.approx(0.0005886, rel=1e-4)


def test_damping_is_the_same_part_of_the_critical_one():
    ours = blender_cloth.damper("tension_damping")(reading()) / math.sqrt(
        0.3 * blender_cloth.spring("tension_stiffness")(reading())
    )
    assert ours == pytest.approx(5.0 / math.sqrt(0.3 * 15.0 / 0.1))


def test_a_fold_of_90_degrees_asks_the_same_work_at_any_resolution():
    for edge in (0.1, 0.013):
        sheet = reading()._replace(edge=edge)
        hinge = (
            50.0 * 0.5 * edge**2
        )  # N m/rad: measured, 2.5 for a stiffness of 5 and edges of 0.1 m
        change = 2.0 * edge * (1.0 - math.cos(math.pi / 4.0))
        assert 0.5 * blender_cloth.bend(sheet) * change**2 == pytest.approx(
            0.5 * hinge * (math.pi / 2.0) ** 2
        )


def test_bend_springs_are_damped_as_fast_as_blender_s_hinges():
    for model in ("ANGULAR", "LINEAR"):
        sheet = reading(bending_model=model)
        seconds = blender_cloth.bend_damping(sheet) / blender_cloth.bend(sheet)
        hinge = (1000.0 * blender_cloth.TIME * 0.5 / 4.0) / (50.0 * 0.5)
        assert seconds == pytest.approx(hinge if model == "ANGULAR" else 0.5 * blender_cloth.TIME)


def test_pressure_is_in_kilopascals_of_blender_s_scale():
    # measured in Blender 4.5: 0.01 lifts 25 vertices of 0.3 kg on 1 m² with 0.1359 of the gravity of 9.81 m/s²
    sheet = reading(uniform_pressure_force=0.01, pressure_factor=1.0)
    assert blender_cloth.pressure(sheet) / (25 * 0.3 * 9.81) == pytest.approx(0.1359, rel=1e-3)


def test_soft_pins_hold_as_one_patch_and_firm_ones_need_no_stiffness():
    sheet = reading(pin_stiffness=2.0)
    assert blender_cloth.pin_stiffness(sheet) is None
    assert blender_cloth.pin_stiffness(sheet._replace(soft_pins=5)) == pytest.approx(5 * 20_000.0)


def test_two_layers_keep_the_distance_of_blender_s():
    assert blender_cloth.thickness(reading(use_self_collision=True)) == 0.0075
    assert blender_cloth.thickness(reading()) == 0.02


def test_quality_follows_the_steps_of_blender_s_own_presets():
    found = [blender_cloth.quality(reading(quality=steps)) for steps in (1, 4, 5, 7, 12, 15)]
    assert found == ["draft", "draft", "normal", "normal", "final", "final"]


def test_no_setting_of_ours_is_set_twice():
    targets = [row.target for row in blender_cloth.rows() if row.target]
    assert len(targets) == len(set(targets))


def test_the_sentence_says_the_numbers_and_what_is_lost():
    said = blender_cloth.sentence("Flag", "Cloth", reading(), ["Compression"])
    assert "441 vertices of 0.3 kg on 4 m² are 33.1 kg/m²" in said
    assert "150000 N/m" in said and said.endswith("Not carried over: Compression")
    assert "Not carried" not in blender_cloth.sentence("Flag", "Cloth", reading(), [])
