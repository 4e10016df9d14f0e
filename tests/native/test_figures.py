"""The numbers behind the paper's figures, as scripts/figures.py computes them."""

from __future__ import annotations

import json
import re
import struct
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
FIGURES = ROOT / "scripts" / "figures.py"
NAMES = {
    2: "deformations",
    3: "spring_diagram",
    4: "adjustment",
    5: "stretch",
    6: "shear",
    7: "breakdown",
    8: "spring_over_time",
    9: "energy",
}


def run(*words: object) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, str(FIGURES), *map(str, words)]
    return subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    pytest.importorskip("matplotlib")
    out = tmp_path_factory.mktemp("figures")
    done = run("--quick", "--out", out)
    assert done.returncode == 0, done.stderr
    return out


@pytest.fixture(scope="module")
def numbers(folder: Path) -> dict:
    return json.loads((folder / "numbers.json").read_text(encoding="utf-8"))


def test_every_figure_is_a_picture_that_the_index_shows_with_its_caption(folder):
    index = (folder / "index.md").read_text(encoding="utf-8")
    for number, name in NAMES.items():
        file_name = f"figure{number}_{name}.png"
        header = (folder / file_name).read_bytes()[:24]
        assert header[:8] == b"\x89PNG\r\n\x1a\n"
        width, height = struct.unpack(">II", header[16:])
        assert width == 1300
        assert height > 400
        shown = re.search(rf"\({file_name}\)\n\n(.+)", index)
        assert shown is not None
        assert len(shown[1]) > 100


def test_nine_particles_have_twelve_stretch_eight_shear_and_six_bend_springs(numbers):
    assert numbers["figure3"] == {"stretch": 12, "shear": 8, "bend": 6}


def test_shear_and_bend_springs_alone_resist_leaning_over_and_turning(numbers):
    shapes = numbers["figure2"]
    assert shapes["springs"] == 2 * 20 + 2 * 16 + 2 * 15
    assert shapes["rest"]["energy_shares"] == [0.0, 0.0, 0.0]
    assert shapes["stretched"]["energy_shares"][0] > 0.5
    assert shapes["stretched"]["largest_change"]["stretch"] == pytest.approx(0.25)
    assert shapes["sheared"]["energy_shares"] == pytest.approx([0.0, 1.0, 0.0], abs=1e-9)
    assert shapes["bent"]["energy_shares"] == pytest.approx([0.0, 0.0, 1.0], abs=1e-9)


def test_hanging_cloth_is_superelastic_unless_it_is_limited(numbers):
    worst = numbers["figure4"]["largest_elongation_percent"]
    assert worst["none"] > worst["stiffen"] > 15.0
    assert worst["project"] <= 10.1


def test_a_high_stretch_k_stretches_less_and_has_a_smaller_safe_step(numbers):
    low, high = numbers["figure5"]["largest_elongation_percent"].values()
    assert low > 5.0 * high
    safe_low, safe_high = numbers["figure5"]["safe_time_step_s"].values()
    assert safe_low > safe_high > 0.0


def test_a_high_shear_k_keeps_squares_square(numbers):
    low, high = numbers["figure6"]["largest_shear_degrees"].values()
    assert low > 2.0 * high


def test_a_too_large_step_ends_as_a_divergence_with_the_frames_before_it_kept(numbers):
    end = numbers["figure7"]
    assert end["time_step_s"] > end["safe_time_step_s"] > 0.0
    told = f'diverged at frame {end["frame"]}, vertex {end["vertex"]} of cloth "sheet"'
    assert end["message"] == told
    assert end["frames_kept"] == end["frame"] - 1
    assert 0 <= end["vertex"] < 16 * 16
    assert end["largest_elongation_percent"] > 1e4


def test_the_same_sheet_with_safe_steps_does_not_break_down(numbers):
    end = numbers["figure7"]
    assert end["message_with_safe_steps"] == ""
    assert end["largest_elongation_percent_with_safe_steps"] < 150.0


def test_equation_6_overshoots_the_allowed_length_and_project_does_not(numbers):
    tracks = numbers["figure8"]
    assert tracks["allowed_length_m"] == pytest.approx(1.1 * tracks["rest_length_m"])
    assert tracks["none"]["peak_over_allowed_points"] > 20.0
    stiffen = tracks["stiffen"]
    assert 10.0 < stiffen["peak_over_allowed_points"] < 20.0
    assert stiffen["end_over_allowed_points"] > 5.0
    assert tracks["project"]["peak_over_allowed_points"] <= 0.1
    assert tracks["project"]["worst_edge_percent"] <= 10.1
    assert tracks["provot"]["peak_over_allowed_points"] < 1.0


def test_equation_6_raises_k_by_the_ratio_of_the_length_to_rest_and_the_others_leave_it(numbers):
    tracks = numbers["figure8"]
    stiffen = tracks["stiffen"]
    expected = 500.0 * stiffen["peak_length_m"] / tracks["rest_length_m"]
    assert stiffen["largest_stiffness"] == pytest.approx(expected, rel=1e-6)
    for name in ("none", "provot", "project"):
        assert tracks[name]["largest_stiffness"] == 500.0


def test_the_readme_shows_or_links_every_figure_as_a_small_picture():
    folder = FIGURES.parent / "pictures"
    readme = (FIGURES.parents[1] / "README.md").read_text(encoding="utf-8")
    names = {f"figure{number}_{name}.png" for number, name in NAMES.items()}
    assert {path.name for path in folder.glob("figure*.png")} == names
    for name in names:
        assert f"(scripts/pictures/{name})" in readme
        assert (folder / name).stat().st_size < 150_000


def test_wrong_use_is_told_in_one_line_and_exit_code_2(tmp_path):
    pytest.importorskip("matplotlib")
    occupied = tmp_path / "file"
    occupied.write_text("")
    done = run("--quick", "--only", 3, "--out", occupied)
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1
    assert str(occupied) in done.stderr
