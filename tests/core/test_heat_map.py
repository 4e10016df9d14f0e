import itertools
import math
from array import array

import pytest
from boucle_addon.core import heat_map, points


@pytest.fixture(params=["numpy", "no numpy"])
def either_way(request, monkeypatch):
    if request.param == "no numpy":
        monkeypatch.setattr(points, "numpy_module", lambda: None)


def lightness(color):
    """CIE L* of a colour that a screen shows."""
    red, green, blue = heat_map.linear(color)
    luminance = 0.2126 * red + 0.7152 * green + 0.0722 * blue
    return 116 * luminance ** (1 / 3) - 16 if luminance > 0.008856 else 903.3 * luminance


def test_the_map_grows_brighter_in_equal_steps():
    steps = [lightness(heat_map.color(k / 40)) for k in range(41)]
    rises = [after - before for before, after in itertools.pairwise(steps)]
    mean = (steps[-1] - steps[0]) / 40
    assert steps[0] < 16 and steps[-1] > 89
    assert all(0.7 * mean < rise < 1.4 * mean for rise in rises), rises


@pytest.mark.usefixtures("either_way")
def test_numbers_get_the_colours_of_their_places_and_ends_hold_beyond():
    values = array("f", [2.0, 7.0, 12.0, -1e9, 1e9, math.nan, math.inf, -math.inf])
    colors = list(heat_map.colors(values, 2.0, 12.0, 0.5))
    rows = [colors[k : k + 4] for k in range(0, len(colors), 4)]
    low, middle, high = (heat_map.color(place) for place in (0.0, 0.5, 1.0))
    for row, color in zip(rows, (low, middle, high, low, high, low, high, low), strict=True):
        assert row[:3] == pytest.approx(color, abs=0.012)
        assert row[3] == 0.5
    assert memoryview(heat_map.colors(values, 0.0, 1.0, 1.0)).format == "f"


@pytest.mark.usefixtures("either_way")
def test_a_range_without_width_has_one_colour():
    colors = list(heat_map.colors(array("f", [1.0, 2.0]), 3.0, 3.0, 1.0))
    assert colors[:4] == colors[4:]


@pytest.mark.usefixtures("either_way")
def test_the_range_ends_at_a_round_number_that_nothing_exceeds():
    assert heat_map.span(array("f", [-0.2, 0.031, math.nan])) == (0.0, pytest.approx(0.05))
    assert heat_map.span(array("f", [0.0, -1.0])) == (0.0, 1e-6)
    assert heat_map.span(array("f")) == (0.0, 1.0)
    for number in (1e-5, 0.02, 0.0999, 1.0, 1.01, 17.0, 24.0, 26.0, 99.0, 12345.0):
        most = heat_map.round_up(number)
        assert number <= most * 1.00001 <= 2.6 * number, number


@pytest.mark.parametrize(
    ("span", "factor", "texts"),
    [
        ((0.0, 0.1), 100.0, ["0", "2.5", "5", "7.5", "10"]),
        ((0.0, 2.5), 1.0, ["0", "0.625", "1.25", "1.875", "2.5"]),
        ((-1.0, 1.0), 1.0, ["-1", "-0.5", "0", "0.5", "1"]),
        ((0.0, 1e-6), 1.0, ["0.00e+00", "2.50e-07", "5.00e-07", "7.50e-07", "1.00e-06"]),
        ((0.0, 5e4), 1.0, ["0", "12500", "25000", "37500", "50000"]),
        ((3.0, 3.0), 1.0, ["3", "3", "3", "3", "3"]),
    ],
)
def test_the_legend_tells_the_range_in_numbers_that_can_be_read(span, factor, texts):
    ticks = heat_map.ticks(*span, factor)
    assert [tick.place for tick in ticks] == [0.0, 0.25, 0.5, 0.75, 1.0]
    assert [tick.text for tick in ticks] == texts


@pytest.mark.parametrize(
    ("span", "texts"),
    [
        ((0.0, 5.0), ["0", "1", "2", "3", "4", "5"]),
        ((0.0, 2.0), ["0", "1", "2"]),
        ((0.0, 1.0), ["0", "1"]),
        ((0.0, 20.0), ["0", "5", "10", "15", "20"]),
        ((2.0, 5.0), ["2", "3", "4", "5"]),
        ((0.0, 2.5), ["0", "0.625", "1.25", "1.875", "2.5"]),
    ],
)
def test_what_is_counted_has_whole_numbers_in_its_legend(span, texts):
    ticks = heat_map.whole_ticks(*span)
    assert [tick.text for tick in ticks] == texts
    assert ticks[0].place == 0.0 and ticks[-1].place == 1.0
