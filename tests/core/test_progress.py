from boucle_addon.core import progress


def test_the_status_bar_says_where_how_fast_and_how_long():
    line = progress.line("Curtain", 34, 250, 0.0312, 217)
    assert line == "Curtain: frame 34/250, 0.03 s/frame, 7 s left, Esc stops and keeps"


def test_durations_and_sizes_are_readable():
    assert [progress.duration(s) for s in (0.2, 59.4, 200, 7500)] == [
        "0 s", "59 s", "3 min 20 s", "2 h 05 min",
    ]  # fmt: skip
    assert [progress.size(n) for n in (0, 999, 12_300_000)] == ["0.0 kB", "1.0 kB", "12.3 MB"]
