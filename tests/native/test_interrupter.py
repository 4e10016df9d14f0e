"""Stopping in the midst of a frame, and the certificate of one cloth among others, as Python sees them."""

import json
import threading
import time

import boucle_core
import pytest


def long_frames(sheet):
    scene = json.loads(sheet.scene())
    scene["solver"] = {"integrator": "symplectic_euler", "substeps": 200_000}
    return boucle_core.Simulation(json.dumps(scene), [sheet.mesh()], 1)


def test_another_thread_stops_a_frame_and_the_state_is_that_of_the_frame_before(sheet):
    simulation = long_frames(sheet)
    before, interrupter = simulation.checkpoint(), simulation.interrupter()
    timer = threading.Timer(0.05, interrupter.interrupt)
    timer.start()
    began = time.monotonic()
    with pytest.raises(boucle_core.InterruptionError, match="frame 2 was interrupted") as raised:
        simulation.advance()
    timer.join()
    assert time.monotonic() - began < 1.0
    assert raised.value.frame == 2
    assert isinstance(raised.value, boucle_core.BoucleError)
    assert simulation.frame == 1 and simulation.checkpoint() == before


def test_an_interrupter_asked_between_frames_stops_the_next_one_alone(sheet):
    simulation = boucle_core.Simulation(sheet.scene(), [sheet.mesh()], 1)
    whole = boucle_core.Simulation(sheet.scene(), [sheet.mesh()], 1)
    simulation.interrupter().interrupt()
    with pytest.raises(boucle_core.InterruptionError):
        simulation.advance()
    assert simulation.advance() == whole.advance()


def test_the_certificate_of_a_cloth_is_its_own_but_for_what_is_shared(sheet):
    scene = json.loads(sheet.scene())
    scene["cloth"].append({"name": "free", "density": 0.2})
    simulation = boucle_core.Simulation(json.dumps(scene), [sheet.mesh(), sheet.mesh()], 1)
    for _ in range(3):
        simulation.advance()
    whole, held, free = (simulation.certificate(which) for which in (None, 0, 1))
    for key in ("substeps", "iterations", "contacts", "clipped", "intersections", "frame"):
        assert whole[key] == held[key] == free[key], key
    assert whole["max_strain"] == max(held["max_strain"], free["max_strain"])
    assert held["max_strain"] > 1e-4 > free["max_strain"]
    assert len({whole["hash"], held["hash"], free["hash"]}) == 3
    total = held["kinetic_energy"] + free["kinetic_energy"]
    assert whole["kinetic_energy"] == pytest.approx(total, rel=1e-12)
    with pytest.raises(boucle_core.SceneError, match=r"cloth = 2; accepted: 0 to 1"):
        simulation.certificate(2)
