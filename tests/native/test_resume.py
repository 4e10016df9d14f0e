"""Bakes that are killed, stopped and resumed give the bits of a bake that was not."""

import json
import signal
import struct
import time

import pytest

SCENE = """
[scene]
frames = [1, 100000]

[[cloth]]
name = "sheet"
grid = { size = [1.0, 1.0], vertices = [24, 24], plane = "xz" }
pins = ["top_left", { names = ["top_right"], weight = 0.7, motion = [
    { frame = 1 },
    { frame = 400, location = [0.3, 0.2, 0.1], rotation_deg = [0, 0, 20] },
] }, { names = ["bottom_right"], weight = 0.3, release = 20 }]

[cloth.springs]
damping = 0.01

[collision]
enabled = false
"""


class Folder:
    """The folder of a bake, read while the bake may be under way."""

    def __init__(self, path):
        self.path = path

    def samples(self):
        """How many samples the cache's header tells of."""
        try:
            with open(self.path / "sheet.pc2", "rb") as file:
                header = file.read(32)
        except FileNotFoundError:
            return 0
        return struct.unpack("<i", header[28:])[0] if len(header) == 32 else 0

    def cache(self):
        """The cache up to its last sample."""
        data = (self.path / "sheet.pc2").read_bytes()
        return data[32 : 32 + 12 * 576 * self.samples()]

    def hashes(self):
        report = json.loads((self.path / "report.json").read_text())
        return [row["hash"] for row in report["frames"]]

    def has_checkpoint(self):
        return (self.path / "boucle.checkpoint").exists()


def wait_until(process, is_true):
    """Wait until something is true of a bake that must still be running."""
    end = time.monotonic() + 60
    while not is_true():
        assert process.poll() is None, process.communicate()
        assert time.monotonic() < end
        time.sleep(0.01)


@pytest.fixture
def scene(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text(SCENE)
    return path


def test_a_bake_that_is_killed_again_and_again_is_equal_to_the_bit(start_bake, scene, tmp_path):
    killed = Folder(tmp_path / "killed")
    reached = 0
    for _ in range(3):
        process = start_bake(scene, "--out", killed.path, "--resume", "--quiet")
        wait_until(process, lambda least=reached + 40: killed.samples() > least)
        wait_until(process, killed.has_checkpoint)
        process.send_signal(signal.SIGKILL)
        assert process.wait() == -signal.SIGKILL
        # Whatever the moment: a valid cache, a whole report, and the one at most a frame ahead of the other.
        reached = killed.samples()
        assert len(killed.cache()) == 12 * 576 * reached
        assert reached - len(killed.hashes()) in (0, 1)
    process = start_bake(scene, "--out", killed.path, "--resume")
    wait_until(process, lambda: killed.samples() > reached + 40)
    process.send_signal(signal.SIGINT)
    assert process.wait(60) == 130
    count = killed.samples()
    assert len(killed.hashes()) == count

    whole = Folder(tmp_path / "whole")
    process = start_bake(scene, "--out", whole.path, "--quiet")
    wait_until(process, lambda: whole.samples() >= count)
    process.send_signal(signal.SIGTERM)
    assert process.wait(60) == 130
    assert whole.hashes()[:count] == killed.hashes()
    assert whole.cache()[: len(killed.cache())] == killed.cache()


def test_a_stopped_bake_goes_on_to_the_end_with_the_same_bits(
    start_bake, run_bake, scene, tmp_path
):
    words = [scene, "--quiet", "--set", "scene.frames=[1, 300]", "--out"]
    stopped = Folder(tmp_path / "stopped")
    process = start_bake(*words, stopped.path)
    wait_until(process, lambda: stopped.samples() > 20)
    process.send_signal(signal.SIGINT)
    assert process.wait(60) == 130
    count = stopped.samples()
    assert 20 < count < 300
    result = run_bake(*words, stopped.path, "--resume", "--threads", "2")
    assert result.returncode == 0, result.stderr
    assert run_bake(*words, tmp_path / "whole", "--threads", "1").returncode == 0
    whole = Folder(tmp_path / "whole")
    assert stopped.hashes() == whole.hashes()
    assert (stopped.path / "sheet.pc2").read_bytes() == (whole.path / "sheet.pc2").read_bytes()


def test_a_damaged_or_foreign_checkpoint_is_refused(run_bake, scene, tmp_path):
    words = [scene, "--quiet", "--out", tmp_path / "out", "--set", "scene.frames=[1, 5]"]
    assert run_bake(*words).returncode == 0
    result = run_bake(*words, "cloth.0.density=0.3", "--resume")
    assert (result.returncode, result.stderr.count("\n")) == (2, 1)
    assert "another scene" in result.stderr
    path = tmp_path / "out" / "boucle.checkpoint"
    data = bytearray(path.read_bytes())
    data[len(data) // 2] ^= 4
    path.write_bytes(data)
    result = run_bake(*words, "--resume")
    assert (result.returncode, result.stderr.count("\n")) == (2, 1)
    assert "boucle.checkpoint: the checkpoint is damaged" in result.stderr


def test_a_cache_that_was_taken_away_is_told(run_bake, scene, tmp_path):
    words = [scene, "--quiet", "--out", tmp_path / "out", "--set", "scene.frames=[1, 5]"]
    assert run_bake(*words).returncode == 0
    (tmp_path / "out" / "sheet.pc2").unlink()
    result = run_bake(*words, "--resume")
    assert (result.returncode, result.stderr.count("\n")) == (4, 1)
    assert "sheet.pc2 cannot be read" in result.stderr
