import math
from array import array

import pytest
from boucle_addon.core import points, shell

STRETCHED = (2.0, 0.0, 0.0, 5.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0)


@pytest.fixture(params=["numpy", "no numpy"])
def either_way(request, monkeypatch):
    if request.param == "no numpy":
        monkeypatch.setattr(points, "numpy_module", lambda: None)


def buffer(*values):
    out = points.empty("f", len(values))
    out[:] = array("f", values)
    return out


@pytest.mark.usefixtures("either_way")
def test_a_side_is_as_far_from_the_surface_as_the_cloth_is_thick():
    above, below = shell.sides(buffer(0, 0, 0, 1, 0, 0), buffer(0, 0, 1, 1, 0, 0), 0.25)
    assert list(above) == [0, 0, 0.25, 1.25, 0, 0]
    assert list(below) == [0, 0, -0.25, 0.75, 0, 0]


@pytest.mark.usefixtures("either_way")
def test_normals_stay_upright_on_a_surface_that_its_object_stretches():
    to_object = points.inverse(STRETCHED)
    slant = math.sqrt(0.5)
    normals = shell.normals_to_world(buffer(slant, slant, 0, 0, 0, 1, 0, 0, 0), to_object)
    along = (2 * -slant, slant)  # where the stretch takes the line that the first normal stands on
    assert along[0] * normals[0] + along[1] * normals[1] == pytest.approx(0.0, abs=1e-7)
    assert math.hypot(*normals[:3]) == pytest.approx(1.0, abs=1e-6)
    assert list(normals[3:]) == [0, 0, 1, 0, 0, 0]
