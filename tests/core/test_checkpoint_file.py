import pytest
from boucle_addon.core import checkpoint_file
from boucle_addon.core.checkpoint_file import Checkpoint
from boucle_addon.core.refusal import CacheRefusal, Refusal


def test_a_checkpoint_comes_back_as_it_was(tmp_path):
    path = str(tmp_path / "deep" / "a.checkpoint")
    rows = ([{"frame": -4, "hash": "a"}], [])
    kept = Checkpoint(-4, 7, "ab12", bytes(range(256)) * 9, "c", ("A", "B"), rows)
    checkpoint_file.write(path, kept)
    assert checkpoint_file.read(path) == kept
    assert [p.name for p in (tmp_path / "deep").iterdir()] == ["a.checkpoint"]


def test_no_file_is_no_checkpoint(tmp_path):
    assert checkpoint_file.read(str(tmp_path / "none")) is None


def test_a_damaged_file_is_refused_at_every_length(tmp_path):
    path = tmp_path / "a.checkpoint"
    checkpoint_file.write(str(path), Checkpoint(3, 3, "d", b"state" * 20))
    whole = path.read_bytes()
    for length in range(len(whole)):
        path.write_bytes(whole[:length])
        with pytest.raises(Refusal, match="damaged"):
            checkpoint_file.read(str(path))


def test_a_bit_changed_anywhere_is_noticed(tmp_path):
    path = tmp_path / "a.checkpoint"
    checkpoint_file.write(str(path), Checkpoint(3, 3, "d", b"state", rows=([{"frame": 3}],)))
    whole = path.read_bytes()
    for bit in range(8 * len(whole)):
        changed = bytearray(whole)
        changed[bit // 8] ^= 1 << bit % 8
        path.write_bytes(changed)
        with pytest.raises(Refusal, match=r"is damaged: bake from|of another version"):
            checkpoint_file.read(str(path))


@pytest.mark.parametrize("version", [1, 3, 10])
def test_a_checkpoint_of_another_version_is_refused_with_the_cure(tmp_path, version):
    path = tmp_path / "a.checkpoint"
    checkpoint_file.write(str(path), Checkpoint(3, 3, "d", b"state"))
    whole = path.read_bytes()
    path.write_bytes(whole.replace(b"CHECKPOINT 2", b"CHECKPOINT %d" % version))
    with pytest.raises(Refusal, match="of another version of Boucle: go on with that one, or bake"):
        checkpoint_file.read(str(path))


def test_a_folder_in_its_place_is_refused_by_name(tmp_path):
    with pytest.raises(Refusal, match="cannot be read"):
        checkpoint_file.read(str(tmp_path))
    with pytest.raises(CacheRefusal, match="cannot be written"):
        checkpoint_file.write(str(tmp_path), Checkpoint(1, 1, "", b""))
