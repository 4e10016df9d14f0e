"""Rows of the validation report that no other test holds, each as a true sentence.

`scripts/validate.py` runs all rows; the others name the test that holds them, see tests/test_validate.py.
"""

import fnmatch

import pytest

from validation.chapters import rows_of


def hold(chapter, *patterns):
    """Check that the rows of a chapter whose names are so hold; a star stands for anything."""
    names = {row.name: row for row in rows_of(chapter)}
    for pattern in patterns:
        found = fnmatch.filter(names, pattern)
        assert found, f"no row {pattern!r}"
        for name in found:
            result = names[name].run()
            assert result.has_passed, f"{name}: {result.cells()} {result.message}"


def test_implicit_rules_have_the_energy_factor_and_the_period_of_their_formulas():
    what = ("energy factor a step", "period ratio T/T0", "energy after 4 steps of z = 100: stable")
    hold(
        "integrators", *(f"{rule}: {each}" for rule in ("implicit Euler", "BDF2") for each in what)
    )


def test_implicit_rules_converge_at_their_order():
    hold("integrators", "implicit Euler: order of convergence", "BDF2: order of convergence")


def test_a_free_cloth_falls_under_implicit_euler_as_its_closed_form_says():
    hold("dynamics", "free fall, implicit Euler")


def test_a_chain_hangs_as_the_catenary():
    hold("statics", "catenary*")


@pytest.mark.parametrize("gamma", ["0.1", "100"])
def test_a_cantilever_of_fabric_droops_as_the_elastica_under_any_weight(gamma):
    hold("bending", f"cantilever of fabric, aligned mesh, Gamma {gamma}")


def test_a_cantilever_of_fabric_droops_as_the_elastica_by_default_settings():
    hold("bending", "cantilever of usual fabric, aligned mesh, default settings")


def test_a_cantilever_of_fabric_droops_as_the_elastica_on_meshes_that_do_not_suit_it():
    hold("bending", "cantilever of fabric, mesh at 45°", "cantilever of fabric, unstructured*")


def test_springs_that_skip_a_vertex_do_not_bend_as_the_elastica():
    hold("bending", "control: springs (i, i+2) must miss the elastica")


def test_a_moment_at_its_end_closes_a_strip_of_fabric_to_a_circle():
    hold("bending", "moment 2 pi B/L at the end of a strip*")


def test_a_strip_of_fabric_hangs_as_the_continuum():
    hold("bending", "hanging strip of fabric*")


@pytest.mark.parametrize("kind", ["stretch", "shear", "bend"])
def test_a_wave_of_fabric_swings_as_its_closed_form_says(kind):
    hold("waves", f"standing wave of {kind}: frequency on two meshes")


@pytest.mark.parametrize("kind", ["stretch", "shear", "bend"])
def test_a_damping_ratio_is_that_of_a_wave_of_a_tenth_of_a_metre(kind):
    hold("waves", f"standing wave of {kind}: damping ratio*")


def test_a_damping_ratio_holds_at_the_mean_of_warp_and_weft():
    hold("waves", "standing wave of * along stiffer and softer yarns")


def test_steps_damp_waves_by_far_less_than_the_damping_that_is_measured():
    hold("waves", "standing waves without damping: what steps damp")


def test_a_free_sheet_of_fabric_keeps_its_angular_momentum_under_verlet():
    hold("laws", "angular momentum of a free sheet")


def test_a_scene_of_fabric_that_is_turned_moved_or_mirrored_moves_the_same():
    hold("laws", "the scene *")
