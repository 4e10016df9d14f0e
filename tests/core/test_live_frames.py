from array import array

from boucle_addon.core.live_frames import Action, Frame, LiveFrames


def frames(count, limit=10_000):
    kept = LiveFrames(5, frame(0), limit)
    for value in range(1, count):
        kept.add(frame(value))
    return kept


def frame(value, **numbers):
    return Frame(array("f", [float(value)] * 3), {"frame": 5 + value}, numbers)


def test_only_the_frame_after_the_last_is_simulated():
    kept = frames(3)
    assert (kept.first, kept.last) == (5, 7)
    assert [kept.action(frame, 0.0, 20) for frame in (4, 5, 7, 8, 9, 30)] == [
        Action.SHOW, Action.SHOW, Action.SHOW, Action.STEP, Action.WAIT, Action.SHOW,
    ]  # fmt: skip


def test_sub_frames_are_left_alone():
    assert frames(3).action(8, 0.25, 20) is Action.IGNORE
    assert frames(3).action(6, 0.75, 20) is Action.IGNORE


def test_nothing_is_simulated_beyond_the_end():
    assert frames(3).action(8, 0.0, 7) is Action.SHOW
    assert frames(3).action(8, 0.0, 8) is Action.STEP


def test_full_memory_stops_the_simulation():
    kept = frames(3, limit=36)
    assert kept.size_bytes == 36
    assert kept.action(8, 0.0, 20) is Action.FULL
    assert kept.action(9, 0.0, 20) is Action.FULL
    assert kept.action(7, 0.0, 20) is Action.SHOW


def test_numbers_at_the_vertices_count_in_the_memory():
    kept = frames(3, limit=44)
    kept.add(frame(3, strain=array("f", [0.5])))
    assert kept.size_bytes == 52
    assert kept.action(9, 0.0, 20) is Action.FULL
    assert kept.nearest(8).numbers["strain"][0] == 0.5 and not kept.nearest(7).numbers


def test_a_certificate_is_told_only_of_frames_that_are_there():
    kept = frames(3)
    assert [kept.certificate(number) for number in (4, 5, 7, 8)] == [
        {}, {"frame": 5}, {"frame": 7}, {},
    ]  # fmt: skip
    assert [len(kept.positions_from(index)) for index in (0, 2, 3)] == [3, 1, 0]


def test_beyond_the_ends_the_nearest_frame_is_shown():
    kept = frames(3)
    assert [kept.nearest(number).positions[0] for number in (-9, 5, 6, 7, 99)] == [
        0.0,
        0.0,
        1.0,
        2.0,
        2.0,
    ]
