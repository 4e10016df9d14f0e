"""The systems of the literature: their scenes, what each claims, which runs its picture shows.

README's section "The literature" lists them, `scripts/literature.py` draws them, the tests that each names hold its claim.
"""

from __future__ import annotations

from dataclasses import dataclass

from gallery_scenes import Exhibit
from integrator_words import WORDS
from paper.view import View

SIDE_VIEW = View(center=(0.0, 0.0, -0.62), width=2.5, height=3.5, turn=18.0, lift=8.0)
SWING_VIEW = View(center=(-0.06, 0.29, -0.48), width=1.4, height=1.36, turn=60.0, lift=8.0)
DRAWN_VIEW = View(center=(0.18, 0.0, 0.0), width=1.7, height=1.3, turn=0.0, lift=0.0)
DEMO_VIEW = View(center=(0.0, 0.4, -0.1), width=3.2, height=3.2, turn=48.0, lift=12.0)
COURSE_VIEW = View(center=(0.5, 0.25, 0.4), width=1.6, height=1.4, turn=25.0, lift=14.0)
EXERCISE_VIEW = View(center=(0.0, 0.0, 0.3), width=1.6, height=1.2, turn=25.0, lift=22.0)
TABLE_VIEW = View(center=(0.0, 0.0, -0.15), width=2.1, height=1.575, turn=25.0, lift=24.0)
TEAR_VIEW = View(center=(0.0, 0.0, -0.25), width=2.0, height=1.5, turn=25.0, lift=28.0)
FABRIC = (
    "cloth.sheet.model=fabric",
    "cloth.sheet.fabric.preset=denim",
    "solver.integrator=bdf2",
    "solver.substeps=8",
)
EXPLICIT = ("solver.integrator=symplectic_euler", "solver.allow_unstable=true")


@dataclass(frozen=True)
class System:
    """One system of the literature and its picture: a row of one or more runs."""

    name: str
    """Of its picture."""
    source: str
    panels: tuple[Exhibit, ...]
    largest: float | None = None
    """Elongation (%) of the last color; without one cloth has two plain sides."""
    columns: int = 4
    tells: str = ""
    """What the titles give of the frame: "strain", the largest elongation, or "energy", what was won or lost."""
    holds: tuple[str, ...] = ()
    """Tests that hold its claim, each in one of the project's test files."""

    @property
    def scenes(self) -> set[str]:
        """Its scene files, from tests/scenes on."""
        return {f"{panel.scene}.toml" for panel in self.panels}


def hung(limiter: str, words: str) -> tuple[Exhibit]:
    """The hanging cloth with one limiter, where it is drawn out most."""
    override = f"cloth.sheet.springs.limiter={limiter}"
    return (Exhibit("literature/hanging", words, 19, SIDE_VIEW, (override,)),)


def swung(integrator: str) -> Exhibit:
    """The swinging sheet by one integrator, after two and a half seconds or when it has just burst."""
    frame = 11 if integrator == "forward_euler" else 61
    overrides = (f"solver.integrator={integrator}", f"scene.frames=[1,{frame}]")
    return Exhibit("literature/swing", WORDS[integrator], frame, SWING_VIEW, overrides)


SYSTEMS = (
    System(
        "plain_springs",
        "Provot 1995, of springs alone",
        hung("none", "springs alone"),
        100.0,
        tells="strain",
        holds=("test_springs_alone_stretch_like_rubber_beside_the_pins",),
    ),
    System(
        "equation_6",
        "The paper that this project starts from",
        hung("stiffen", "equation 6"),
        100.0,
        tells="strain",
        holds=("test_equation_six_lessens_the_stretch_and_still_passes_what_is_allowed",),
    ),
    System(
        "provot",
        "Provot 1995",
        hung("provot", "Provot"),
        100.0,
        tells="strain",
        holds=("test_provots_correction_comes_nearer_to_the_limit_the_smaller_its_steps",),
    ),
    System(
        "zhong_xu",
        "Zhong and Xu 2009",
        hung("project", "position and velocity"),
        100.0,
        tells="strain",
        holds=("test_position_and_velocity_correction_holds_the_limit_in_every_frame",),
    ),
    System(
        "dynamic_stiffness",
        "Bayraktar, Güdükbay and Özgüç 2007",
        tuple(
            Exhibit(
                "literature/dynamic_stiffness",
                words,
                37,
                DRAWN_VIEW,
                (f"cloth.sheet.springs.limiter={limiter}",),
            )
            for limiter, words in (("none", "constant stiffness"), ("stiffen", "dynamic stiffness"))
        ),
        40.0,
        2,
        tells="strain",
        holds=("test_dynamic_stiffness_follows_the_load_and_goes_back_with_it",),
    ),
    System(
        "numpy_demo",
        "A demo in plain numpy",
        (Exhibit("numpy_demo", "wind on one corner", 101, DEMO_VIEW),),
        40.0,
        holds=(
            "the_numpy_demonstration_moves_as_the_plain_method_does",
            "test_the_numpy_demonstration_bears_its_step_and_bursts_beyond_the_stable_one",
        ),
    ),
    System(
        "exercise",
        "The exercise of courses, Baraff and Witkin 1997",
        (
            Exhibit("literature/exercise", "springs, forward Euler", 37, EXERCISE_VIEW, plane=1.6),
            Exhibit(
                "literature/exercise",
                "no springs: denim, BDF2",
                37,
                EXERCISE_VIEW,
                FABRIC,
                plane=1.6,
            ),
        ),
        columns=2,
        holds=(
            "test_the_exercise_comes_to_rest_alike_by_each_of_its_integrators",
            "test_the_exercise_can_be_done_without_springs",
        ),
    ),
    System(
        "integrators",
        "Integrators compared (Hairer, Lubich and Wanner 2006)",
        tuple(map(swung, WORDS)),
        100.0,
        tells="energy",
        holds=(
            "test_the_error_of_an_integrator_falls_by_its_order",
            "test_energy_grows_stays_or_falls_as_the_textbook_says",
        ),
    ),
    System(
        "cs184_pinned",
        "Berkeley's CS184, 2018",
        (
            Exhibit("pinned2", "two corners held", 60, COURSE_VIEW),
            Exhibit("pinned4", "four corners held", 60, COURSE_VIEW),
        ),
        20.0,
        2,
        tells="strain",
        holds=(
            "the_courses_curtain_on_two_corners_ends_within_its_deformation_rate",
            "sag_from_two_corners_falls_as_the_springs_stiffen_from_50_to_50000",
            "test_no_frame_has_an_intersection_by_our_count_by_ipctk_or_by_distance",
        ),
    ),
    System(
        "large_steps",
        "Baraff and Witkin 1998",
        (
            Exhibit("literature/large_steps", "implicit, one step a frame", 49, TABLE_VIEW),
            Exhibit(
                "literature/large_steps",
                "explicit, the same step",
                5,
                TABLE_VIEW,
                (*EXPLICIT, "scene.frames=[1,5]"),
            ),
        ),
        columns=2,
        holds=("test_an_implicit_rule_bears_steps_in_which_an_explicit_one_bursts",),
    ),
    System(
        "tearing",
        "Terzopoulos and Fleischer 1988",
        (
            Exhibit("literature/tearing", "strained", 22, TEAR_VIEW),
            Exhibit("literature/tearing", "torn", 38, TEAR_VIEW),
        ),
        columns=2,
        holds=("test_cloth_tears_where_it_is_strained_beyond_its_limit_and_loses_no_face",),
    ),
)
