"""The chapters of the report, in its order, and what it does not measure."""

from __future__ import annotations

from importlib import import_module
from importlib.util import find_spec

from .row import Finding, Row

CHAPTERS = {
    "integrators": "Integrators on x'' = -w² x",
    "lattice": "Spring lattices: largest stable step and elastic moduli",
    "statics": "Chains, strips and catenaries at rest",
    "bending": "Fabric that bends",
    "waves": "Standing waves of fabric",
    "dynamics": "Cloth in motion",
    "flows": "Cloth in wind and water",
    "laws": "What every law keeps",
    "friction_contact": "Friction and contact",
    "drape": "Drape of named fabrics",
    "course_scenes": "Scenes of the course assignment, and the numpy demo",
}
"""Names as `--only` takes them, and headings. A chapter is the module of its name."""

NOT_MEASURED = [
    (
        "Hessian = derivative of the force",
        "The module shows no Hessian. Rust tests hold it by central differences: "
        "the_matrix_is_the_derivative_of_the_residual_where_all_springs_are_stretched, "
        "the_matrix_is_the_derivative_of_the_residual_of_equation_six, "
        "the_matrix_of_drawn_fabric_is_the_derivative_of_the_residual, "
        "the_matrix_of_contacts_is_the_derivative_of_their_force.",
    ),
]
"""What ought to be validated and this report cannot show."""


def rows_of(chapter: str) -> list[Row]:
    """The rows of a chapter; one that fails where they cannot be told."""
    try:
        return import_module(f".{chapter}", __package__).rows()
    except Exception as fault:  # noqa: BLE001 - what is wrong with a chapter is told as a row

        def fail(reason: Exception = fault) -> Finding:
            raise reason

        return [Row(chapter, f"the rows of chapter {chapter}", "rows", "", "", "", fail)]


def not_measured() -> list[tuple[str, str]]:
    """What is not measured here, and why."""
    missing = []
    if find_spec("instruments") is None:
        why = "The instruments that read them (scripts/instruments) are not there yet."
        missing = [("Drape coefficients and the cantilever test of named fabrics", why)]
    return NOT_MEASURED + missing
