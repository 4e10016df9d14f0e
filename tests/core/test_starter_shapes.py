import itertools
import math

from boucle_addon.core import starter_shapes


def lengths(grid, row):
    first = row * grid.columns
    points = grid.points[first : first + grid.columns]
    return [math.dist(a, b) for a, b in itertools.pairwise(points)]


def test_the_waves_of_a_curtain_are_as_long_as_its_fullness_and_evenly_cut():
    grid = starter_shapes.pleated(1.6, 2.0, 161, 5, pleats=8, fullness=1.8)
    found = lengths(grid, 0)
    assert math.isclose(sum(found), 1.8 * 1.6, rel_tol=0.01)
    assert max(found) < 1.1 * min(found)
    assert grid.points[0] == (-0.8, 0.0, -1.0)
    assert math.isclose(grid.points[160][0], 0.8)
    flat = starter_shapes.pleated(1.6, 2.0, 17, 5, pleats=8, fullness=1.0)
    assert max(abs(y) for _, y, _ in flat.points) < 1e-3


def test_faces_name_every_vertex_and_pins_are_a_row_and_a_column():
    grid = starter_shapes.sheet(2.0, 1.0, 4, 3, lying=False)
    assert {vertex for face in grid.faces() for vertex in face} == set(range(12))
    assert len(list(grid.faces())) == 6
    assert grid.top() == [8, 9, 10, 11] and grid.left() == [0, 4, 8]
    assert grid.points[8] == (-1.0, 0.0, 0.5)


def test_a_cape_widens_from_neck_to_hem_and_is_open_in_front():
    grid = starter_shapes.cape(0.1, 0.5, 1.2, 60, 20, pleats=0, opening=1.0)
    radii = [math.hypot(x, y) for x, y, _ in grid.points]
    assert math.isclose(radii[-1], 0.1) and math.isclose(radii[0], 0.5)
    angle = math.acos(
        sum(a * b for a, b in zip(grid.points[0][:2], grid.points[59][:2], strict=True)) / 0.25
    )
    assert math.isclose(angle, 1.0, rel_tol=1e-6)
    assert grid.points[0][1] < 0.0
