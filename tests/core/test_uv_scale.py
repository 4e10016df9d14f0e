import math
from array import array

import pytest
from boucle_addon.core import points, uv_scale


@pytest.fixture(params=["numpy", "no numpy"])
def either_way(request, monkeypatch):
    if request.param == "no numpy":
        monkeypatch.setattr(points, "numpy_module", lambda: None)


def sheet(width, height, turn=0.0, zoom=1.0):
    """Two triangles of a rectangle in space and in a map that shows it as a square, turned and zoomed."""
    corners = [(0, 0), (1, 0), (1, 1), (0, 0), (1, 1), (0, 1)]
    positions, uvs = [], []
    for u, v in corners:
        positions += [width * u, 0.6 * height * v, 0.8 * height * v]
        c, s = math.cos(turn), math.sin(turn)
        uvs += [zoom * (c * u - s * v), zoom * (s * u + c * v)]
    return array("f", positions), array("f", uvs)


@pytest.mark.usefixtures("either_way")
def test_a_unit_of_the_map_is_as_many_metres_as_the_cloth_is_wide_and_high():
    assert uv_scale.metres(*sheet(1.7, 0.5)) == pytest.approx((1.7, 0.5), rel=1e-6)
    assert uv_scale.metres(*sheet(1.7, 0.5, zoom=4.0)) == pytest.approx((0.425, 0.125), rel=1e-6)


@pytest.mark.usefixtures("either_way")
def test_a_map_that_is_turned_keeps_the_metres_of_an_even_one():
    assert uv_scale.metres(*sheet(2.0, 2.0, turn=0.7)) == pytest.approx((2.0, 2.0), rel=1e-6)


@pytest.mark.usefixtures("either_way")
def test_a_map_without_area_is_taken_as_metres():
    positions, uvs = sheet(1.0, 1.0, zoom=0.0)
    assert uv_scale.metres(positions, uvs) == (1.0, 1.0)
    assert uv_scale.metres(array("f"), array("f")) == (1.0, 1.0)


def test_a_projected_map_is_in_metres_wherever_a_face_looks():
    for axis in range(3):
        flat = [0.0, 0.0, 0.0]
        corners = []
        for place in ((0, 0), (3, 0), (3, 2)):
            corner = list(flat)
            corner[axis - 2], corner[axis - 1] = place
            corners += corner
        projected = uv_scale.projected(array("f", corners))
        assert uv_scale.metres(array("f", corners), projected) == pytest.approx((1.0, 1.0))
