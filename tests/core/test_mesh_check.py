import math

from boucle_addon.core import mesh_check
from boucle_addon.core.mesh_check import Severity

QUAD = [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0]
EDGES = [0, 1, 1, 2, 2, 3, 3, 0]


def problems(positions=QUAD, starts=(0,), corners=(0, 1, 2, 3), ends=EDGES):
    return mesh_check.check(positions, starts, corners, ends)


def test_a_sound_mesh_has_no_problems():
    assert problems() == []


def test_a_concave_polygon_is_sound():
    dart = [0, 0, 0, 2, 0, 0, 0.5, 0.5, 0, 0, 2, 0]
    assert problems(dart) == []


def test_each_problem_names_its_vertices_and_its_cure():
    loose = problems([*QUAD, 5, 5, 5])
    assert [(p.severity, list(p.vertices)) for p in loose] == [(Severity.ERROR, [4])]
    assert loose[0].sentence == "1 vertex that no face uses (4): delete them"
    broken = problems([*QUAD[:9], math.nan, 1, 0])
    assert list(broken[0].vertices) == [3]
    endless = problems([*QUAD[:9], math.inf, 1, 0])
    assert list(endless[0].vertices) == [3]
    flat = problems([0, 0, 0, 1, 0, 0, 2, 0, 0], corners=(0, 1, 2), ends=[0, 1, 1, 2, 2, 0])
    assert list(flat[0].vertices) == [0, 1, 2] and "no area" in flat[0].sentence
    short = problems([*QUAD[:9], 1, 1, 0])
    assert list(short[0].vertices) == [2, 3] and "no length" in short[0].sentence


def test_vertices_that_lie_on_each_other_are_a_warning():
    twice = problems(
        [*QUAD, *QUAD], starts=(0, 4), corners=range(8), ends=[*EDGES, *(e + 4 for e in EDGES)]
    )
    assert [p.severity for p in twice] == [Severity.WARNING]
    assert list(twice[0].vertices) == list(range(8))
    assert "(0, 1, 2, 3, 4, ...)" in twice[0].sentence


def test_a_mesh_without_faces_is_an_error():
    for empty in (problems([], [], [], []), problems(QUAD, [], [], EDGES)):
        assert [p.severity for p in empty] == [Severity.ERROR]


def test_a_cloth_thicker_than_half_an_edge_is_told_and_one_of_a_quarter_is_not():
    slim = [0, 0, 0, 1, 0, 0, 1, 0.1, 0, 0, 0.1, 0]
    assert mesh_check.thick_for_edges(slim, EDGES, 0.05) == []
    (found,) = mesh_check.thick_for_edges(slim, [*EDGES, 0, 2], 0.06)
    assert found.severity is Severity.WARNING
    assert list(found.vertices) == [0, 1, 2, 3]
    assert "Thickness is 0.06 m" in found.sentence and "the shortest is 0.1 m" in found.sentence
