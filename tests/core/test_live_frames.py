from array import array

from boucle_addon.core.live_frames import Action, LiveFrames


def frames(count, limit=10_000):
    kept = LiveFrames(5, array("f", [0.0] * 3), limit)
    for value in range(1, count):
        kept.add(array("f", [float(value)] * 3))
    return kept


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


def test_beyond_the_ends_the_nearest_frame_is_shown():
    kept = frames(3)
    assert [kept.nearest(frame)[0] for frame in (-9, 5, 6, 7, 99)] == [0.0, 0.0, 1.0, 2.0, 2.0]
