from array import array

import pytest
from boucle_addon.core import grip, points

GRID = array("d", (x for row in range(5) for column in range(5) for x in (column, 0.0, row)))
"""25 vertices in the plane y = 0, 1 m apart."""


@pytest.fixture(params=["numpy", "array"], autouse=True)
def arrays(request, monkeypatch):
    if request.param == "array":
        monkeypatch.setattr(points, "numpy_module", lambda: None)


def test_the_nearest_vertex_is_held_with_its_neighbours_ever_less():
    held = grip.close(GRID, (2.2, 0.3, 1.9), 1.5)
    assert held.vertex == 12 and held.vertices == [6, 7, 8, 11, 12, 13, 16, 17, 18]
    assert held.point == (2.2, 0.3, 1.9), "nothing jumps as the hand closes"
    near, far = (1 - 1 / 2.25) ** 2, (1 - 2 / 2.25) ** 2
    assert list(held.weights) == pytest.approx([far, near, far, near, 1, near, far, near, far])
    assert list(held.places[12:15]) == [2.0, 0.0, 2.0]
    assert grip.close(GRID, (4.0, 0.0, 4.0), 0.0).vertices == [24]
    assert grip.size(GRID) == pytest.approx(32**0.5)


def test_the_hand_moves_in_the_plane_of_the_view():
    held = grip.close(GRID, (2.0, 0.0, 2.0), 0.0)
    origin, normal = (2.0, -10.0, 2.0), (0.0, 1.0, 0.0)
    assert grip.offset(origin, (0.0, 1.0, 0.0), held, normal) == pytest.approx((0, 0, 0))
    assert grip.offset(origin, (0.03, 1.0, -0.05), held, normal) == pytest.approx((0.3, 0, -0.5))
    oblique = grip.offset((2.0, -10.0, 2.3), (0.0, 2.0, 0.0), held, (0.0, 1.0, 1.0))
    assert oblique == pytest.approx((0.0, -0.3, 0.3)), "in the plane, not along the ray"
    assert list(held.targets((0.5, 0.0, 1.0))) == [2.5, 0.0, 3.0]
    for direction in ((1.0, 0.0, 0.0), (0.0, -1.0, 0.0)):
        assert grip.offset(origin, direction, held, normal) is None
