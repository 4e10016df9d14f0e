"""How far a bake is, in words."""

from __future__ import annotations


def line(name: str, frame: int, last: int, seconds_a_frame: float, frames_left: int) -> str:
    """The status bar's text during a bake; seconds_a_frame is the mean so far."""
    left = seconds_a_frame * frames_left
    return (
        f"{name}: frame {frame}/{last}, {seconds_a_frame:.2f} s/frame, {duration(left)} left, "
        "Esc stops and keeps"
    )


def duration(seconds: float) -> str:
    """A duration: "7 s", "3 min 20 s" or "2 h 05 min"."""
    whole = round(seconds)
    if whole < 60:
        return f"{whole} s"
    if whole < 3600:
        return f"{whole // 60} min {whole % 60:02d} s"
    return f"{whole // 3600} h {whole % 3600 // 60:02d} min"


def size(count: int) -> str:
    """A number of bytes: "12.3 MB" or "4.5 kB"."""
    return f"{count / 1e6:.1f} MB" if count >= 1_000_000 else f"{count / 1e3:.1f} kB"
