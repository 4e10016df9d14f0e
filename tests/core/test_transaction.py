import pytest
from boucle_addon.core.transaction import Step, apply_all, revert_all


def steps(log, failing=None, failing_back=None):
    def apply(number):
        if number == failing:
            raise RuntimeError(f"{number} fails")
        log.append(number)

    def revert(number):
        log.append(-number)
        if number == failing_back:
            raise ValueError(f"{number} fails back")

    return [Step(lambda n=n: apply(n), lambda n=n: revert(n)) for n in (1, 2, 3)]


def test_steps_are_applied_in_order_and_reverted_in_reverse():
    log = []
    apply_all(steps(log))
    revert_all(steps(log))
    assert log == [1, 2, 3, -3, -2, -1]


def test_a_step_that_fails_undoes_those_before_it():
    log = []
    with pytest.raises(RuntimeError, match="3 fails"):
        apply_all(steps(log, failing=3))
    assert log == [1, 2, -2, -1]


def test_a_step_that_cannot_be_undone_does_not_keep_the_others():
    log = []
    with pytest.raises(ValueError, match="2 fails back"):
        revert_all(steps(log, failing_back=2))
    assert log == [-3, -2, -1]
