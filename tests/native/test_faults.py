"""scripts/faults.py: some of each fault, and that it sees what breaks. All of them take an hour: README says how."""

import shutil
import struct

import pytest

from faulting import damage, disk, kills, shim, surroundings
from faulting.subject import Row, differs, left, lost, refused, subjects

pytestmark = pytest.mark.skipif(shutil.which("cc") is None, reason="no C compiler")
FRAMES = 8
KINDS = ("bake.py, contact", "add-on, contact", "bake.py, tearing", "add-on, tearing")


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    return shim.build(tmp_path_factory.mktemp("shim"))


@pytest.fixture(scope="module")
def known(tmp_path_factory):
    folder = tmp_path_factory.mktemp("subjects")
    return {subject.name: subject for subject in subjects(folder, FRAMES)}


def held(row, least):
    assert row.broke == []
    assert row.tried >= least


@pytest.mark.parametrize("name", KINDS)
def test_a_bake_that_is_killed_at_random_and_in_the_midst_of_writes_is_equal_to_the_bit(
    known, library, tmp_path, name
):
    held(kills.at_random(known[name], tmp_path, library, 2, 3), 2)
    held(kills.at_every_operation(known[name], tmp_path, library, 40, 5), 1)


@pytest.mark.parametrize("name", KINDS)
@pytest.mark.parametrize("kind", ["full", "gone"])
def test_a_disk_that_is_full_or_gone_loses_no_frame_and_the_cure_is_named(
    known, library, tmp_path, name, kind
):
    row = disk.from_an_operation_on(known[name], tmp_path, library, kind, 40, 7)
    held(row, 1)
    assert "free disk space" in row.said


@pytest.mark.parametrize("name", ["bake.py, contact", "add-on, tearing"])
def test_damage_is_mended_or_told(known, library, tmp_path, name):
    half = damage.half_baked(known[name], tmp_path, library)
    held(damage.cuts(known[name], half, tmp_path, 0, 1), 6)
    held(damage.bits(known[name], half, tmp_path, 1, 2), 2)
    other = next(subject for subject in known.values() if subject.name != name)
    held(damage.versions(known[name], half, tmp_path, other), 3)
    held(surroundings.clocks(known[name], half, tmp_path, library, 1), 4)


def test_the_checks_see_what_breaks(known, tmp_path):
    """A finished bake that is damaged is not taken for whole by any of the looks at it."""
    subject = known["bake.py, contact"]
    out = tmp_path / "out"
    shutil.copytree(subject.undisturbed, out)
    assert differs(subject, out) == lost(subject, out) == ""
    data = (out / "lower.pc2").read_bytes()
    (out / "lower.pc2").write_bytes(data[:-1] + bytes([data[-1] ^ 1]))
    assert differs(subject, out) == "lower.pc2 differs"
    assert "lower.pc2 holds other frames" in lost(subject, out)
    (out / "lower.pc2").write_bytes(data[:28] + struct.pack("<i", FRAMES - 1) + data[32:])
    assert lost(subject, out) == "" and differs(subject, out) == "lower.pc2 differs"
    (out / "lower.pc2").unlink()
    assert differs(subject, out) == "other files: ['lower.pc2']"
    assert len(left(out)) == 5
    done = subject.run(out, resume=True)
    assert refused(done, 4) == "" and "exit code 4" in refused(done, 2)
    row = Row("a fault", subject.name)
    row.note("", "here")
    row.note("it broke", "there")
    assert (row.tried, row.broke) == (2, ["there: it broke"])
