"""Records of bakes as a file from elsewhere may hold them: any JSON is taken as a record of the right shape, or as none."""

import json

from boucle_addon.core import bake_record
from hypothesis import given
from hypothesis import strategies as st

SCALARS = st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8)
JSON = st.recursive(
    SCALARS,
    lambda within: (
        st.lists(within, max_size=4) | st.dictionaries(st.text(max_size=8), within, max_size=4)
    ),
    max_leaves=10,
)
WHOLE = {
    "first": 1,
    "end": 20,
    "is_part": False,
    "bake": "0a",
    "settings": {"cloth.density": 0.2},
    "vertices": 48,
    "topology": "ff",
    "together": {"b": "Sheet"},
    "order": ["a", "b"],
}


@given(JSON)
def test_any_json_gives_a_record_that_can_be_read_or_none(content):
    for record in (bake_record.checked(content), bake_record.of_text(json.dumps(content))):
        if record:
            int(record["first"])
            assert isinstance(record.get("settings", {}), dict)


@given(st.text(max_size=40))
def test_any_text_is_read(text):
    assert isinstance(bake_record.of_text(text), dict)


@given(st.sampled_from(sorted(WHOLE)), JSON)
def test_a_part_of_another_kind_spoils_a_record(name, part):
    record = bake_record.checked(WHOLE | {name: part})
    if record:
        assert type(part) is type(WHOLE[name])
    else:
        assert part != WHOLE[name] or type(part) is not type(WHOLE[name])


def test_what_a_bake_writes_is_read_as_it_is():
    assert bake_record.of_text(json.dumps(WHOLE)) == WHOLE
    assert bake_record.of_report({"bake": WHOLE, "frames": []}) == WHOLE
    assert bake_record.of_text("") == {}
    assert bake_record.of_text("[" * 100_000) == {}
