import struct

from boucle_addon.core import worst


def test_the_worst_frame_is_the_first_with_the_largest_number():
    rows = {
        3: {"max_strain": 0.2},
        4: {"max_strain": 0.3},
        2: {"max_strain": 0.1},
        5: {"max_strain": 0.3},
    }
    assert worst.frame(rows, worst.STRAIN) == (4, 0.3)
    assert worst.frame({**rows, 6: {"max_strain": None}}, worst.STRAIN)[0] == 6
    assert worst.frame({1: {"intersections": None}}, worst.INTERSECTIONS) == (1, 0.0)
    assert worst.frame({}, worst.STRAIN) is None


def test_strain_is_length_over_rest_length_less_one_and_only_stretch_springs_have_it():
    springs = (
        struct.pack("4i", 1, 0, 0, 2),
        bytes([0, 1]),
        struct.pack("2d", 2.0, 1.0),
    )
    lengths = worst.rest_lengths(springs)
    assert lengths == {(0, 1): 2.0}
    found = worst.edges([0, 0, 0, 3, 0, 0, 0, 1, 0], [0, 1, 0, 2], lengths)
    assert found == [worst.Edge(0, 0.5)]
