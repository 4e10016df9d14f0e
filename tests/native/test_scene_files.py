"""The scenes in tests/scenes are what they say they are."""

import struct

import numpy as np

AFTER_TWO_SECONDS = {
    0: (-0.0292366, -0.2852436, -0.0004073),
    13: (2.1915309, -0.0588015, 0.9073038),
    90: (1.1929574, 0.8712401, -0.0066413),
}
"""Positions (m) of the solver's own numpy demonstration, rust/solver/tests/validation/scenes.rs, which is upright along y and
begins at the origin."""


def test_the_numpy_demonstration_is_the_system_that_the_solver_is_validated_with(
    run_bake, scenes, tmp_path
):
    words = ["--out", "out", "--quiet", "--frames", "51:51"]
    assert run_bake(scenes / "numpy_demo.toml", *words).returncode == 0
    data = (tmp_path / "out" / "demo.pc2").read_bytes()
    assert struct.unpack("<i", data[28:32]) == (1,)
    frame = np.frombuffer(data[32:], "<f4").reshape(196, 3).astype(float)
    upright = (frame + np.array([1.3, 0.0, 1.3]))[:, [0, 2, 1]]
    for vertex, expected in AFTER_TWO_SECONDS.items():
        # The unevenness of a millionth of an edge has grown no larger than float32 tells apart.
        assert np.abs(upright[vertex] - expected).max() < 2e-6, (vertex, upright[vertex])
