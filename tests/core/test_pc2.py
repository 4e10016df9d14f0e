import struct
from array import array
from pathlib import Path

import pytest
from boucle_addon.core import pc2
from boucle_addon.core.refusal import CacheRefusal


def sample(value, vertices=2):
    return array("f", [value] * (3 * vertices))


@pytest.fixture
def path(tmp_path):
    return str(tmp_path / "made" / "a.pc2")


def written(path, count):
    writer = pc2.Writer.create(path, 2, -3)
    for value in range(count):
        writer.append(sample(float(value)))
    return writer


def test_the_layout_is_that_of_pc2(path):
    written(path, 2).close()
    data = Path(path).read_bytes()
    assert data[:32] == struct.pack("<12siiffi", b"POINTCACHE2\0", 1, 2, -3.0, 1.0, 2)
    assert data[32:] == struct.pack("<12f", *[0.0] * 6, *[1.0] * 6)
    assert list(pc2.read_sample(path, 1)) == [1.0] * 6


def test_the_file_is_whole_after_every_sample(path):
    writer = written(path, 0)
    assert pc2.read_header(path) == (2, -3.0, 0)
    for count in range(1, 4):
        writer.append(sample(float(count)))
        assert pc2.read_header(path).sample_count == writer.sample_count == count
        assert pc2.check(path, 2) == ""


def test_a_sample_that_does_not_fit_the_disk_leaves_the_ones_before(path):
    writer = written(path, 2)
    real = writer._file

    class Full:
        """A disk with room for 8 more bytes."""

        def __getattr__(self, name):
            return getattr(real, name)

        def write(self, data):
            if len(data) > 8:
                return real.write(bytes(data[:8]))
            raise OSError(28, "No space left on device")

    writer._file = Full()
    with pytest.raises(CacheRefusal, match=r"No space left on device.*frames so far are kept"):
        writer.append(sample(9.0))
    writer.close()
    assert pc2.read_header(path).sample_count == 2
    assert len(Path(path).read_bytes()) == 32 + 2 * 24
    assert pc2.check(path, 2) == ""


def digests(*values):
    return [pc2.digest(sample(value)) for value in values]


def test_going_on_drops_later_samples(path):
    written(path, 5).close()
    writer = pc2.Writer.reopen(path, 2, -3, digests(0.0, 1.0, 2.0))
    writer.append(sample(7.0))
    writer.close()
    assert pc2.read_header(path) == (2, -3.0, 4)
    assert [pc2.read_sample(path, k)[0] for k in range(4)] == [0.0, 1.0, 2.0, 7.0]


def test_going_on_from_too_short_or_another_file_is_refused(path):
    written(path, 2).close()
    for vertices, first, count in ((2, -3, 3), (4, -3, 1), (2, 1, 1)):
        with pytest.raises(CacheRefusal, match="bake from the start"):
            pc2.Writer.reopen(path, vertices, first, digests(0.0, 1.0, 2.0)[:count])


def test_a_file_with_a_bit_changed_or_cut_off_is_refused_or_mended(path):
    written(path, 3).close()
    longer = Path(path).read_bytes()
    count = 32 + 2 * 24
    whole = longer[:28] + b"\2" + longer[29:count]
    for bit in range(8 * len(longer)):
        changed = bytearray(longer)
        changed[bit // 8] ^= 1 << bit % 8
        Path(path).write_bytes(changed)
        try:
            pc2.Writer.reopen(path, 2, -3, digests(0.0, 1.0)).close()
        except CacheRefusal:
            assert bit // 8 < count
        else:
            assert Path(path).read_bytes() == whole
    for length in range(len(longer)):
        Path(path).write_bytes(longer[:length])
        try:
            pc2.Writer.reopen(path, 2, -3, digests(0.0, 1.0)).close()
        except CacheRefusal:
            assert length < count
        else:
            assert length >= count and Path(path).read_bytes() == whole
    Path(path).write_bytes(longer[: count - 1] + b"x" + longer[count:])
    with pytest.raises(CacheRefusal, match="frame -2 is not as it was baked"):
        pc2.Writer.reopen(path, 2, -3, digests(0.0, 1.0))


def test_a_sample_of_another_size_is_refused(path):
    writer = written(path, 0)
    with pytest.raises(ValueError, match="24 bytes"):
        writer.append(sample(0.0, vertices=3))


def test_a_file_where_a_folder_should_be_is_refused_by_name(tmp_path):
    (tmp_path / "made").write_text("in the way")
    with pytest.raises(CacheRefusal, match=r"a\.pc2.*cannot be written"):
        pc2.Writer.create(str(tmp_path / "made" / "a.pc2"), 2, 1)


def test_what_is_wrong_with_a_file_is_said_in_words(path, tmp_path):
    written(path, 3).close()
    whole = Path(path).read_bytes()
    assert "is missing" in pc2.check(str(tmp_path / "none.pc2"), 2)
    assert "holds 2 vertices and the mesh has 5" in pc2.check(path, 5)
    for data, words in (
        (whole[:-1], "2 of 3 frames"),
        (whole[:31], "not a PC2 file"),
        (b"x" * 200, "not a PC2 file"),
        (whole[:28] + struct.pack("<i", 0), "holds no frame"),
        (whole[:28] + struct.pack("<i", -1), "damaged"),
    ):
        Path(path).write_bytes(data)
        assert words in pc2.check(path, 2)
    with pytest.raises(CacheRefusal, match="cannot be read"):
        pc2.read_header(str(tmp_path / "none.pc2"))


def test_a_sample_that_is_not_there_is_refused(path):
    written(path, 2).close()
    for index in (-1, 2):
        with pytest.raises(CacheRefusal, match="holds 2"):
            pc2.read_sample(path, index)
