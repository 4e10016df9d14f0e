"""The class Simulation, as Python sees it."""

import json
import struct
from array import array

import boucle_core
import numpy as np
import pytest


def positions_of(simulation, cloth=0):
    out = np.empty((simulation.vertex_count(cloth), 3))
    simulation.read_positions(cloth, out)
    return out


def test_a_simulation_starts_at_rest_at_the_first_frame_of_its_scene(sheet):
    scene = json.loads(sheet.scene())
    scene["scene"]["frames"] = [-5, 10]
    simulation = boucle_core.Simulation(json.dumps(scene), [sheet.mesh()])
    assert simulation.frame == -5
    assert simulation.cloth_names == ["sheet"]
    assert simulation.vertex_count(0) == 36
    assert np.array_equal(positions_of(simulation).ravel(), np.array(sheet.positions))
    assert simulation.certificate()["max_strain"] == pytest.approx(0.0, abs=1e-12)


def test_the_safe_time_step_is_a_frame_where_any_step_is_stable_and_else_it_is_kept(sheet):
    scene = json.loads(sheet.scene())
    simulation = boucle_core.Simulation(json.dumps(scene), [sheet.mesh()])
    assert simulation.safe_time_step == pytest.approx(1 / 24)
    assert simulation.substeps > 0
    scene["solver"] = {"integrator": "symplectic_euler"}
    simulation = boucle_core.Simulation(json.dumps(scene), [sheet.mesh()])
    assert 0.0 < simulation.safe_time_step < 1 / 24
    assert simulation.substeps >= 1 / 24 / simulation.safe_time_step


def test_a_frame_moves_what_is_free_and_holds_what_is_pinned(simulation, sheet):
    before = positions_of(simulation)
    certificate = simulation.advance()
    after = positions_of(simulation)
    pins = sheet.top_corners
    assert np.array_equal(after[pins], before[pins])
    free = [vertex for vertex in range(36) if vertex not in pins]
    assert (after[free, 2] < before[free, 2]).all()
    assert simulation.frame == certificate["frame"] == 2
    assert certificate == simulation.certificate()


def test_a_certificate_is_a_row_of_the_report_without_seconds(simulation):
    certificate = simulation.advance()
    assert set(certificate) == {
        "frame",
        "substeps",
        "iterations",
        "max_strain",
        "p99_strain",
        "max_shear_strain",
        "intersections",
        "clipped",
        "contacts",
        "kinetic_energy",
        "potential_energy",
        "hash",
    }
    assert certificate["intersections"] is None
    assert len(certificate["hash"]) == 16
    assert int(certificate["hash"], 16) >= 0


def held_sheet(make_sheet, limiter, integrator="bdf2", pull=0.0, **springs):
    """A sheet of 6 x 6 whose upper corners move apart in the first frame."""
    sheet = make_sheet()
    scene = json.loads(sheet.scene(springs={"limiter": limiter, **springs}))
    scene["solver"] = {"integrator": integrator}
    simulation = boucle_core.Simulation(json.dumps(scene), [sheet.mesh()])
    targets = np.array(sheet.positions).reshape(-1, 3)
    targets[sheet.top_corners[1], 0] += pull
    simulation.set_pin_targets(0, targets)
    return simulation


@pytest.mark.parametrize("limiter", ["none", "stiffen", "provot", "project"])
@pytest.mark.parametrize("integrator", ["bdf2", "implicit_euler"])
def test_implicit_steps_hold_the_cloth_with_every_limiter(make_sheet, limiter, integrator):
    simulation = held_sheet(make_sheet, limiter, integrator)
    certificates = [simulation.advance() for _ in range(24)]
    assert all(row["iterations"] >= row["substeps"] > 0 for row in certificates)
    assert max(row["max_strain"] for row in certificates) < 0.1
    assert all("overstretched" not in row for row in certificates)


@pytest.mark.parametrize("integrator", ["bdf2", "symplectic_euler"])
@pytest.mark.parametrize("limiter", ["stiffen", "provot", "project"])
def test_edges_over_the_deformation_rate_are_counted_and_named(make_sheet, limiter, integrator):
    simulation = held_sheet(make_sheet, limiter, integrator, pull=0.6)
    assert simulation.overstretched_edges(0) == []
    row = [simulation.advance() for _ in range(3)][-1]
    edges = simulation.overstretched_edges(0)
    assert row["overstretched_count"] == len(edges) >= 5  # the five edges between the pins
    strains = [strain for _, _, strain in edges]
    assert strains == sorted(strains, reverse=True) and strains[-1] > 0.101
    assert strains[0] == pytest.approx(row["max_strain"], abs=1e-12)
    named = [(*edge["vertices"], edge["strain"]) for edge in row["overstretched"]]
    assert named == edges[:8]
    assert {edge["cloth"] for edge in row["overstretched"]} == {"sheet"}
    strain = np.empty(36, dtype=np.float32)
    simulation.read_strain(0, strain)
    for one, other, value in edges:
        assert max(strain[one], strain[other]) >= np.float32(value)
    over = {vertex for one, other, _ in edges for vertex in (one, other)}
    assert over == set(np.flatnonzero(strain > 0.101))


def test_without_a_limiter_no_edge_is_named(make_sheet):
    simulation = held_sheet(make_sheet, "none", pull=0.6)
    row = simulation.advance()
    assert row["max_strain"] > 0.11
    assert "overstretched" not in row and simulation.overstretched_edges(0) == []


def test_the_same_input_gives_the_same_bits_for_any_number_of_threads(make_sheet):
    sheet = make_sheet(40)
    hashes = set()
    for threads in (1, 2, 3, 4, 8):
        simulation = boucle_core.Simulation(sheet.scene(), [sheet.mesh()], threads=threads)
        hashes.add(tuple(simulation.advance()["hash"] for _ in range(4)))
    assert len(hashes) == 1


def test_a_restored_simulation_goes_on_bit_for_bit(sheet):
    first = boucle_core.Simulation(sheet.scene(), [sheet.mesh()])
    first.advance()
    first.advance()
    kept = first.checkpoint()
    hashes = [first.advance()["hash"] for _ in range(5)]
    second = boucle_core.Simulation(sheet.scene(), [sheet.mesh()])
    second.restore(kept)
    assert second.frame == 3
    assert [second.advance()["hash"] for _ in range(5)] == hashes
    first.restore(kept)
    assert first.advance()["hash"] == hashes[0]


def test_a_damaged_or_foreign_checkpoint_is_refused_and_changes_nothing(simulation, make_sheet):
    simulation.advance()
    kept = simulation.checkpoint()
    hash_before = simulation.certificate()["hash"]
    other = make_sheet(5)
    foreign = boucle_core.Simulation(other.scene(), [other.mesh()]).checkpoint()
    flipped = bytearray(kept)
    flipped[len(kept) // 2] ^= 1
    for bad in (b"", kept[:-1], bytes(flipped), foreign):
        with pytest.raises(boucle_core.SceneError, match="checkpoint"):
            simulation.restore(bad)
    assert simulation.certificate()["hash"] == hash_before


def test_pins_arrive_at_their_targets_at_the_end_of_the_frame(simulation, sheet):
    targets = np.full((36, 3), np.nan, np.float32)
    rest = positions_of(simulation)
    for vertex in sheet.top_corners:
        targets[vertex] = rest[vertex] + [0.0, 0.05, 0.1]
    simulation.set_pin_targets(0, targets)
    simulation.advance()
    after = positions_of(simulation)
    for vertex in sheet.top_corners:
        assert after[vertex] == pytest.approx(targets[vertex], abs=1e-7)


def test_released_pins_fall_all_of_them_or_those_that_are_named(simulation, sheet):
    left, right = sheet.top_corners
    simulation.release_pins(0, [left])
    simulation.advance()
    heights = positions_of(simulation)[:, 2]
    assert heights[left] < 1.0
    assert heights[right] == 1.0
    simulation.release_pins(0)
    simulation.advance()
    assert positions_of(simulation)[right, 2] < 1.0


def test_pins_of_the_scene_move_and_let_go_by_themselves(sheet):
    left, right = sheet.top_corners
    pins = [
        {"vertices": [left], "motion": [{"frame": 1}, {"frame": 3, "location": [0, 0, 0.2]}]},
        {"vertices": [right], "release": 2},
    ]
    simulation = boucle_core.Simulation(sheet.scene(pins=pins), [sheet.mesh()])
    simulation.advance()
    heights = positions_of(simulation)[:, 2]
    assert heights[left] == pytest.approx(1.1, abs=1e-12)
    assert heights[right] == 1.0
    simulation.advance()
    heights = positions_of(simulation)[:, 2]
    assert heights[left] == pytest.approx(1.2, abs=1e-12)
    assert heights[right] != 1.0


def test_positions_that_are_set_are_taken_at_rest_with_the_rest_lengths_kept(simulation):
    simulation.advance()
    stretched = positions_of(simulation)
    stretched = np.array(stretched, dtype=np.float32)
    stretched[:, 1] += 0.5
    simulation.set_positions(0, stretched)
    assert np.array_equal(positions_of(simulation), stretched.astype(float))
    velocities = np.ones((36, 3), np.float32)
    simulation.read_velocities(0, velocities)
    assert not velocities.any()


def test_springs_and_strain_are_read_with_their_kinds_and_lengths(simulation, sheet):
    ends, kinds, lengths, stiffness, damping = simulation.read_springs(0)
    count = simulation.spring_count(0)
    ends = np.frombuffer(ends, np.int32).reshape(count, 2)
    kinds = np.frombuffer(kinds, np.uint8)
    lengths = np.frombuffer(lengths)
    n, cell = sheet.n, 1.0 / (sheet.n - 1)
    assert np.bincount(kinds).tolist() == [
        2 * n * (n - 1),
        2 * (n - 1) ** 2,
        2 * n * (n - 2),
    ]
    for kind, length in enumerate([cell, cell * 2**0.5, 2 * cell]):
        assert lengths[kinds == kind] == pytest.approx(length)
    rest = np.array(sheet.positions).reshape(-1, 3)
    assert np.linalg.norm(rest[ends[:, 0]] - rest[ends[:, 1]], axis=1) == pytest.approx(lengths)
    assert np.frombuffer(stiffness)[kinds == 0] == pytest.approx(500.0)
    assert len(damping) == 8 * count
    simulation.advance()
    strain = array("f", [0.0] * 36)
    simulation.read_strain(0, strain)
    assert max(strain) == pytest.approx(simulation.certificate()["max_strain"], rel=1e-5)


def test_tension_is_what_the_springs_pull_with(simulation):
    simulation.advance()
    simulation.advance()
    tension, positions = np.empty(36, np.float32), np.empty((36, 3))
    simulation.read_tension(0, tension)
    simulation.read_positions(0, positions)
    ends, kinds, lengths, stiffness, _ = simulation.read_springs(0)
    ends = np.frombuffer(ends, np.int32).reshape(-1, 2)
    spans = positions[ends[:, 0]] - positions[ends[:, 1]]
    longer = np.linalg.norm(spans, axis=1) - np.frombuffer(lengths)
    pulls = np.frombuffer(stiffness) * longer * (np.frombuffer(kinds, np.uint8) < 2)
    expected = np.zeros(36)
    for pull, pair in zip(pulls, ends, strict=True):
        expected[pair] = np.maximum(expected[pair], pull)
    assert longer.max() < 0.05 * 0.2, "no edge is at its limit, which would pull beside its spring"
    assert expected.max() > 1e-3
    assert tension == pytest.approx(expected, rel=1e-5, abs=1e-9)


def test_several_cloths_are_told_apart_by_their_number(make_sheet):
    small, large = make_sheet(3), make_sheet(5)
    scene = {
        "collision": {"enabled": False},
        "cloth": [{"name": "small"}, {"name": "large", "pins": {"vertices": [0]}}],
    }
    simulation = boucle_core.Simulation(json.dumps(scene), [small.mesh(), large.mesh()])
    assert simulation.cloth_names == ["small", "large"]
    assert [simulation.vertex_count(cloth) for cloth in (0, 1)] == [9, 25]
    simulation.advance()
    assert positions_of(simulation, 1)[0] == pytest.approx([0, 0, 0])


def test_a_transform_places_the_mesh(sheet):
    transform = {"location": [0, 0, 3], "rotation_deg": [0, 0, 90], "scale": 2}
    simulation = boucle_core.Simulation(sheet.scene(transform=transform), [sheet.mesh()])
    assert positions_of(simulation)[-1] == pytest.approx([0, 2, 5])


def test_face_starts_may_hold_the_end_of_the_last_face(sheet):
    closed = array("i", [*sheet.starts, len(sheet.corners)])
    meshes = [(sheet.positions, starts, sheet.corners) for starts in (sheet.starts, closed)]
    hashes = {boucle_core.Simulation(sheet.scene(), [mesh]).advance()["hash"] for mesh in meshes}
    assert len(hashes) == 1


def test_a_divergence_tells_where_and_keeps_the_last_good_frame(sheet):
    scene = json.loads(sheet.scene(springs={"stretch": 1e6, "limiter": "none"}))
    scene["solver"] = {"integrator": "forward_euler", "substeps": 1, "allow_unstable": True}
    simulation = boucle_core.Simulation(json.dumps(scene), [sheet.mesh()])
    with pytest.raises(
        boucle_core.DivergedError, match=r"^diverged at frame \d+, vertex"
    ) as caught:
        for _ in range(1000):
            simulation.advance()
    error = caught.value
    assert isinstance(error, ArithmeticError)
    assert isinstance(error, boucle_core.BoucleError)
    assert error.frame == simulation.frame + 1
    assert 0 <= error.vertex < 36
    assert f"frame {error.frame}, vertex {error.vertex} of cloth" in str(error)
    assert np.isfinite(positions_of(simulation)).all()


def test_bytes_of_a_checkpoint_are_plain_bytes(simulation):
    kept = simulation.checkpoint()
    assert isinstance(kept, bytes)
    assert len(kept) > 36 * 6 * struct.calcsize("d")
