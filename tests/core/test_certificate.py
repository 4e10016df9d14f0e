import pytest
from boucle_addon.core import certificate

ROW = {
    "frame": 12, "substeps": 4, "iterations": 24, "max_strain": 0.0492, "p99_strain": 0.0121,
    "kinetic_energy": 1.0, "potential_energy": 2.214, "hash": "0123abcd456789ef",
}  # fmt: skip
EDGES = [{"cloth": "A", "vertices": [5, 6], "strain": 0.142}]


def test_a_certificate_is_one_line():
    assert certificate.line(ROW) == (
        "Frame 12: stretch 4.9 % (99 % of edges below 1.2 %), 24 iterations, 4 substeps, "
        "energy 3.21 J, hash 0123abcd…"
    )


def test_what_does_not_exist_is_left_out():
    line = certificate.line({**ROW, "iterations": 0, "substeps": 1, "kinetic_energy": None})
    assert line == "Frame 12: stretch 4.9 % (99 % of edges below 1.2 %), 1 substep, hash 0123abcd…"
    assert "stretch beyond all numbers" in certificate.line({**ROW, "max_strain": None})
    assert "stretch 0.0 % (" in certificate.line({**ROW, "max_strain": -1e-9})
    assert "hash 0123abcd…" in certificate.line({**ROW, "hash": "xxh3-64:0123abcd456789ef"})
    assert certificate.line({**ROW, "intersections": None}) == certificate.line(ROW)


@pytest.mark.parametrize(
    ("count", "words"), [(0, "no intersections"), (1, "1 intersection"), (7, "7 intersections")]
)
def test_the_intersections_of_a_cloth_that_collides_are_told(count, words):
    assert f", 4 substeps, {words}, energy" in certificate.line({**ROW, "intersections": count})


def test_a_warning_names_how_many_edges_and_the_worst():
    assert certificate.warning(ROW) == ""
    assert certificate.warning({**ROW, "overstretched": []}) == ""
    row = {**ROW, "overstretched": EDGES, "overstretched_count": 12}
    assert certificate.warning(row).startswith(
        "12 edges exceed the deformation rate: the worst stretches 14.2 %, from vertex 5 to 6; "
    )
    row = {**ROW, "overstretched": EDGES, "overstretched_count": 1}
    assert certificate.warning(row).startswith(
        "1 edge exceeds the deformation rate: it stretches 14.2 %, from vertex 5 to 6; "
    )
