"""Settings of tearing as keys of a scene, and what is refused."""

import pytest
from boucle_addon.core import drift, tear
from boucle_addon.core.refusal import Refusal
from boucle_addon.core.tear import TearGroups

VALUES = {
    "use_tear": True, "tear_stress": 20.0, "tear_force": 0.0, "tear_strain": 0.0, "tear_noise": 0.0, "tear_seed": 7,
    "seam_force": 0.0, "tear_opening_group": "", "tear_opening_frame": 30, "frame_start": 1, "settle_frames": 0,
}  # fmt: skip


def described(groups=None, **values):
    return tear.describe("cape", {**VALUES, **values}, groups or TearGroups())


def test_what_is_set_reaches_the_scene():
    assert described(use_tear=False) == {}
    assert described() == {"enabled": True, "stress": 20.0}
    many = {"tear_force": 3.0, "tear_strain": 0.1, "seam_force": 2.0, "tear_noise": 0.25}
    assert described(**many) == {
        "enabled": True, "stress": 20.0, "force": 3.0, "strain": 0.1, "seam_force": 2.0, "noise": 0.25, "seed": 7,
    }  # fmt: skip
    groups = TearGroups([1.0, 0.5], [(0, 1)])
    found = described(groups, tear_opening_group="open", settle_frames=20)
    assert found["strength"] == [1.0, 0.5]
    assert found["openings"] == [{"frame": 30, "pairs": [[0, 1]]}]
    assert found["start"] == 2, "what settles does not tear"
    assert described(TearGroups((), None), tear_opening_group="open")["openings"] == [{"frame": 30}]


@pytest.mark.parametrize(
    ("values", "groups", "words"),
    [
        ({"tear_stress": 0.0}, None, "nothing says when it tears"),
        (
            {"tear_opening_group": "a", "tear_opening_frame": 1},
            TearGroups((), [(0, 1)]),
            "Opening Frame is 1",
        ),
        ({"tear_opening_group": "a"}, TearGroups((), []), 'in the Opening Group "a"'),
    ],
)
def test_what_cannot_tear_is_refused_by_name(values, groups, words):
    with pytest.raises(Refusal, match=words) as caught:
        described(groups, **values)
    assert str(caught.value).startswith('"cape": ')


def test_a_bake_knows_what_has_changed_of_its_tearing():
    def record(cloth):
        return drift.record({"cloth": [{"name": "cape", "tear": cloth}]}, 2, "")

    one = record(
        {
            "enabled": True,
            "force": 1.0,
            "strength": [1.0, 0.5],
            "openings": [{"frame": 3, "pairs": [[0, 1]]}],
        }
    )
    other = record(
        {
            "enabled": True,
            "force": 2.0,
            "strength": [1.0, 1.0],
            "openings": [{"frame": 4, "pairs": [[0, 2]]}],
        }
    )
    assert drift.differences(one, other) == [
        "tear force", "opening frame", "edges that open", "weights of the strength group",
    ]  # fmt: skip
    assert "tearing" in drift.differences(one, drift.record({"cloth": [{"name": "cape"}]}, 2, ""))
    assert len(one["settings"]["cloth.tear.strength"]) == 16, "a digest"
