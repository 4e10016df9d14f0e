"""Whatever stands in a file of the add-on, it is read, or refused in one line."""

import hashlib
import json
import struct

import pytest
from boucle_addon.core import (
    cache_paths,
    checkpoint_file,
    obj_file,
    pc2,
    preset,
    report,
    takes,
    vertex_file,
)
from boucle_addon.core.refusal import Refusal
from hypothesis import example, given
from hypothesis import strategies as st

numbers = st.one_of(st.integers(-(2**31), 2**31 - 1), st.sampled_from([0, 1, 3, -1, 2**31 - 1]))
reals = st.floats(width=32)
values = st.recursive(
    st.one_of(
        st.none(), st.booleans(), st.integers(), st.floats(), st.text(max_size=9), st.just(10**400)
    ),
    lambda inner: st.one_of(
        st.lists(inner, max_size=3), st.dictionaries(st.text(max_size=5), inner, max_size=3)
    ),
    max_leaves=6,
)
deep = st.sampled_from([b"[" * 100_000, b'{"a":' * 100_000, b"\xff\xfe", b"\0" * 99, b""])


def refused(call, *words):
    """What a call answers, or None where it refuses in one line."""
    try:
        return call(*words)
    except Refusal as refusal:
        assert 5 < len(str(refusal)) < 4000
        assert len(str(refusal).splitlines()) == 1, str(refusal)
    return None


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("files")


@st.composite
def caches(draw):
    head = [draw(st.sampled_from([1, 2])), draw(numbers), draw(reals), draw(reals), draw(numbers)]
    whole = b"POINTCACHE2\0" + struct.pack("<iiffi", *head) + draw(st.binary(max_size=80))
    return whole[: draw(st.sampled_from([len(whole), len(whole), 31, 5]))]


@given(st.one_of(caches(), st.binary(max_size=100)), st.integers(-2, 4))
@example(b"POINTCACHE2\0" + struct.pack("<iiffi", 1, 2**31 - 1, 1.0, 1.0, 2**31 - 1), 0)
def test_any_point_cache_is_read_or_refused(folder, content, index):
    path = folder / "any.pc2"
    path.write_bytes(content)
    header = refused(pc2.read_header, str(path))
    sample = refused(pc2.read_sample, str(path), index)
    if sample is not None:
        assert len(sample) == 3 * header.vertex_count
    assert isinstance(pc2.check(str(path), 2), str)
    first = int(header.first_frame) if header else 1
    known = [pc2.digest(content[32:56])]
    writer = refused(pc2.Writer.reopen, str(path), 2, first, known)
    if writer is not None:
        writer.close()
        assert pc2.read_header(str(path)).sample_count == 1


@given(
    st.one_of(
        st.binary(max_size=100),
        deep,
        st.fixed_dictionaries(
            dict.fromkeys(
                ("frame", "samples", "digest", "length", "bake", "cloths", "rows"), values
            )
        ).map(lambda head: json.dumps({**head, "length": 3}).encode() + b"\nabc"),
        values.map(lambda value: json.dumps(value).encode() + b"\nabc"),
    ),
    st.booleans(),
)
@example(
    b'{"frame": 1e999, "samples": 1, "digest": "", "length": 3, "bake": "", "cloths": [], "rows": []}\nabc',
    True,
)
def test_any_checkpoint_is_read_or_refused(folder, content, has_magic):
    path = folder / "any.checkpoint"
    if has_magic:  # and what tells that nothing has changed
        content = b"BOUCLE CHECKPOINT 2\n" + content
        content += hashlib.blake2b(content, digest_size=16).digest()
    path.write_bytes(content)
    found = refused(checkpoint_file.read, str(path))
    if found is not None:
        assert isinstance(found.frame, int)
        assert isinstance(found.state, bytes)
        assert all(isinstance(row, dict) for rows in found.rows for row in rows)


@given(
    st.one_of(st.binary(max_size=80), st.tuples(numbers, numbers, st.binary(max_size=60))),
    st.integers(-1, 3),
)
def test_any_file_of_numbers_is_read_or_passed_over(folder, content, index):
    path = folder / "any.strain"
    if isinstance(content, tuple):
        content = b"BOUCLE STRAIN 1\n" + struct.pack("<ii", *content[:2]) + content[2]
    path.write_bytes(content)
    for count in (0, 1, 3, 2**31 - 1):
        row = vertex_file.read(str(path), index, count)
        assert row is None or len(row) == count


@given(
    st.one_of(st.binary(max_size=100), deep, values.map(lambda value: json.dumps(value).encode()))
)
def test_any_report_is_read_or_passed_over(folder, content):
    path = folder / "report.json"
    path.write_bytes(content)
    assert isinstance(report.read(str(path)), dict)


SCHEMA = {
    "stretch": preset.Setting("FLOAT", 0.0),
    "steps": preset.Setting("INT", 1, 9),
    "is_on": preset.Setting("BOOLEAN"),
    "kind": preset.Setting("ENUM", choices=("a", "b")),
}
toml_values = st.sampled_from(
    [
        "1",
        "-1",
        "nan",
        "inf",
        "1e400",
        "9" * 400,
        "0x" + "f" * 400,
        "true",
        '"a"',
        "[[]]",
        "{a = 1}",
        "1979-05-27",
    ]
)


@given(
    st.one_of(
        st.text(max_size=80),
        st.builds(
            lambda key, value: f"[settings]\n{key} = {value}\n",
            st.sampled_from(sorted(SCHEMA)),
            toml_values,
        ),
        st.sampled_from(
            ["a = " + "[" * 9000, "a." * 9000 + "b = 1", "settings = 3", "description = [1]"]
        ),
    )
)
@example("[settings]\nstretch = " + "9" * 400)
@example("a = " + "[" * 9000)
def test_any_preset_is_read_or_refused(text):
    found = refused(preset.parse, "mine", text, SCHEMA)
    if found is not None:
        assert refused(preset.parse, "mine", preset.write(found), SCHEMA) == found
    refused(preset.description, "mine", text)


@given(st.text(max_size=80))
def test_no_name_leads_out_of_a_folder(name):
    own = cache_paths.files_of("/cache/one.pc2")
    for path in own.with_middle(takes.file_word(name)):
        assert path.startswith("/cache/one.")
        assert "/" not in path.removeprefix("/cache/")
    checked = refused(preset.checked_name, name, [], [])
    assert checked is None or not set(checked) & set("/\\:\0")


@given(st.text(max_size=20), st.lists(st.floats(-1e6, 1e6), min_size=9, max_size=9))
def test_a_mesh_file_has_a_line_for_each_thing_whatever_its_name(folder, name, positions):
    path = folder / "any.obj"
    obj_file.write(str(path), name, positions, [[0, 1, 2]])
    lines = path.read_bytes().split(b"\n")
    assert [line[:2] for line in lines] == [b"o ", b"v ", b"v ", b"v ", b"f ", b""]
