"""The ranges of damping that the panel warns by."""

import pytest
from boucle_addon.core import ranges, scene_json


def test_every_explicit_integrator_has_a_range():
    known = ranges.recommended()
    assert set(known) == {
        "forward_euler", "symplectic_euler", "verlet", "leapfrog", "midpoint", "rk4"
    }  # fmt: skip
    assert not set(known) & scene_json.IMPLICIT
    for row in known.values():
        low, high = row["damping_ratio"]
        assert 0.0 <= low < high < 4.0
        assert 0.5 < row["step_by_fastest"] <= 2.0**1.5


def test_rules_without_a_stable_undamped_step_need_damping_and_no_others_do():
    lowest = {name: row["damping_ratio"][0] for name, row in ranges.recommended().items()}
    assert {name for name, low in lowest.items() if low > 0.0} == {"forward_euler", "midpoint"}


@pytest.mark.parametrize("integrator", ["symplectic_euler", "forward_euler", "bdf2"])
def test_advice_is_given_outside_the_range_alone(integrator):
    low, high = ranges.recommended().get(integrator, {"damping_ratio": [0.0, 1e9]})["damping_ratio"]
    assert ranges.advice(integrator, low) == ranges.advice(integrator, 0.5 * (low + high)) == ""
    if integrator != "bdf2":
        assert "lower damping" in ranges.advice(integrator, 1.1 * high)
    if integrator == "forward_euler":
        assert "raise damping" in ranges.advice(integrator, 0.5 * low)


def test_the_damping_ratio_is_that_of_one_spring_between_two_particles():
    stiffness, damping, mass = 500.0, 1.0, 0.01
    w = (2.0 * stiffness / mass) ** 0.5
    wanted = 2.0 * damping / mass / (2.0 * w)
    assert ranges.damping_ratio([stiffness], [damping], 2.0 / w) == pytest.approx(wanted)
    assert ranges.damping_ratio([], [], 0.1) == ranges.damping_ratio([1.0], [1.0], 0.0) == 0.0
