from array import array

import pytest
from boucle_addon.core import points

TURNED = (0.0, -2.0, 0.0, 5.0, 1.0, 0.0, 0.5, -7.0, 0.0, 0.0, 3.0, 0.25)


@pytest.fixture(params=["numpy", "no numpy"])
def either_way(request, monkeypatch):
    if request.param == "no numpy":
        monkeypatch.setattr(points, "numpy_module", lambda: None)


@pytest.mark.usefixtures("either_way")
def test_points_move_by_the_matrix():
    moved = points.transform(array("f", [1, 2, 3, 0, 0, 0]), TURNED, "d")
    assert list(moved) == [1.0, -4.5, 9.25, 5.0, -7.0, 0.25]
    assert memoryview(moved).format == "d"


@pytest.mark.usefixtures("either_way")
def test_the_identity_only_changes_the_kind():
    values = array("f", [0.1, 0.2, 0.3])
    moved = points.transform(values, points.IDENTITY, "d")
    assert list(moved) == list(values) and memoryview(moved).format == "d"
    assert moved is not values


@pytest.mark.usefixtures("either_way")
def test_there_and_back_again_is_the_same_float32():
    values = array("f", [0.1, -20.3, 1e-3, 7.0, 123.456, -0.0001])
    back = points.transform(points.transform(values, TURNED, "d"), points.inverse(TURNED), "f")
    assert list(back) == pytest.approx(list(values), rel=1e-6)


@pytest.mark.usefixtures("either_way")
def test_buffers_have_the_kind_that_was_asked_for():
    for kind, size in (("f", 4), ("d", 8), ("i", 4)):
        view = memoryview(points.empty(kind, 6))
        assert (view.format, view.nbytes, sum(view)) == (kind, 6 * size, 0)


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_an_inverse_is_found_at_every_scale(scale):
    matrix = tuple(scale * value for value in TURNED)
    product = points.transform(
        points.transform(array("d", [1, 2, 3]), matrix, "d"), points.inverse(matrix), "d"
    )
    assert list(product) == pytest.approx([1.0, 2.0, 3.0])


def test_a_matrix_that_flattens_space_has_no_inverse():
    assert points.inverse((1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0)) is None
    assert points.inverse((0.0,) * 12) is None
    assert points.inverse((float("nan"),) * 12) is None
    assert points.inverse((1, 2, 3, 0, 2, 4, 6, 0, 0, 0, 1, 0)) is None


def test_an_affine_matrix_is_the_upper_three_rows():
    rows = [[1, 2, 3, 4], [5, 6, 7, 8], [9, 10, 11, 12], [0, 0, 0, 1]]
    assert points.affine(rows) == tuple(float(value) for value in range(1, 13))
