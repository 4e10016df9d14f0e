"""The virtual fabric lab: every instrument reads what went into the fabric, as far as a closed form tells."""

import json

import boucle_core
import numpy as np
import pytest

import measure
from instruments import (
    bending,
    cantilever,
    cutting,
    drape,
    lineup,
    resting,
    shear,
    sheet,
    tensile,
    twisting,
)
from instruments.elastica import FLAT_TIP, gamma_of_chord, profile
from instruments.fabric import Fabric
from instruments.resting import Load, Restless, Specimen, settle

DENIM = Fabric("denim")
DRAPED = ("silk_habotai", "silk_satin", "wool_worsted", "cotton_poplin", "denim")
IN_ORDER = ("silk_habotai", "wool_worsted", "cotton_poplin", "denim")


@pytest.fixture(scope="module")
def draped():
    """The first specimen of each fabric whose drape was published, on a grid."""
    return {preset: drape.measure(Fabric(preset), drape.COARSE) for preset in DRAPED}


@pytest.mark.parametrize(
    ("gamma", "droop"), [(0.1, 0.0124996), (1.0, 0.124562), (10.0, 1.06680), (100.0, 5.88810)]
)
def test_the_elastica_droops_as_tabulated(gamma, droop):
    assert profile(gamma).droop == pytest.approx(droop, rel=1e-5)


def test_at_the_angle_of_d1388_the_overhang_is_twice_the_bending_length():
    assert gamma_of_chord(FLAT_TIP) == pytest.approx(8.0, rel=2e-3)


def test_the_elastica_is_refused_where_it_is_not_solved():
    with pytest.raises(ValueError, match="gamma = 500; accepted: above 0, up to 140"):
        profile(500.0)


@pytest.mark.parametrize("kind", ["grid", "delaunay"])
def test_cuts_cover_their_area_with_faces_that_turn_to_the_left(kind):
    ring = np.pi * (drape.DISC**2 - (drape.PLATE - drape.COARSE) ** 2)
    cuts = [
        (cutting.annulus(drape.DISC, drape.PLATE, drape.COARSE, kind), ring),
        (cutting.strip(0.2, 0.05, (40, 10), kind), 0.01),
        (cutting.strip(0.2, 0.05, (40, 10), kind, turn=45.0), 0.01),
    ]
    for cut, area in cuts:
        twice = cutting.doubled_areas(cut.points, cut.triangles)
        assert twice.min() > 0.2 * twice.mean()
        assert twice.sum() / 2.0 == pytest.approx(area, rel=5e-3)
        assert set(cut.triangles.ravel()) == set(range(len(cut.points)))


@pytest.mark.parametrize("kind", ["grid", "delaunay"])
@pytest.mark.parametrize("direction", ["warp", "weft", "bias"])
def test_a_strip_is_as_stiff_as_its_fabric(direction, kind):
    read = tensile.measure(DENIM, direction, 24, kind)
    assert abs(read.error) < 0.015
    assert read.poisson == pytest.approx(read.expected_poisson, abs=0.01)


def test_a_strip_along_the_yarns_stretches_by_load_over_stiffness():
    read = tensile.measure(DENIM, "warp", 24)
    for gram, extension in read.extensions.items():
        small = gram * tensile.GRAM_FORCE_PER_CENTIMETRE / DENIM.number("stretch_warp")
        # The law is one of Green strain: its force grows by three halves of the strain.
        assert extension == pytest.approx(small * (1.0 - 1.5 * small), rel=2e-3)


@pytest.mark.parametrize("kind", ["grid", "delaunay"])
@pytest.mark.parametrize("direction", ["warp", "weft"])
def test_a_frame_shears_with_the_stiffness_of_its_fabric(direction, kind):
    read = shear.measure(DENIM, direction, 12, kind)
    law = DENIM.number("shear") * np.sin(np.radians(read.degrees))
    assert read.stresses == pytest.approx(law, rel=2e-3)
    assert read.kes == pytest.approx(DENIM.number("shear"), rel=0.02)


@pytest.mark.parametrize(
    ("kind", "direction"), [("grid", "warp"), ("grid", "weft"), ("delaunay", "warp")]
)
def test_kes_reads_the_stiffness_and_the_hysteresis_of_its_fabric(kind, direction):
    width = 1e-3
    read = bending.measure(Fabric("denim", {"bend_hysteresis": width}), direction, 8, kind)
    assert abs(read.error) < 0.015
    assert read.width == pytest.approx(width, rel=0.02)
    # Friction turns over within 50 /m, so that the loop is a parallelogram.
    moments, curvatures = (np.array(of[bending.STEPS :]) for of in (read.moments, read.curvatures))
    loop = 0.5 * np.dot(moments[1:] + moments[:-1], np.diff(curvatures))
    assert loop == pytest.approx(width * (2.0 * bending.MOST - 50.0), rel=0.02)
    stiffness = (read.moments[1] - read.moments[0]) / read.curvatures[1]
    assert stiffness == pytest.approx(read.expected + width / 50.0, rel=0.02)


@pytest.mark.parametrize("kind", ["grid", "delaunay"])
def test_kes_reads_no_hysteresis_of_an_elastic_fabric_and_a_plateau_of_one_that_creases(kind):
    elastic = bending.measure(DENIM, "weft", 8, kind)
    assert abs(elastic.error) < 0.015
    assert abs(elastic.width) < 1e-4 * max(elastic.moments)
    creased = bending.measure(Fabric("denim", {"yield_curvature": 150.0}), "weft", 8, kind)
    assert max(creased.moments) == pytest.approx(150.0 * creased.expected, rel=0.01)
    # What clamps bend by 250 /m keeps 100 /m: there it feels no moment.
    flat = np.interp(0.0, creased.moments[100:49:-1], creased.curvatures[100:49:-1])
    assert flat == pytest.approx(100.0, rel=0.02)


@pytest.mark.parametrize("kind", ["grid", "delaunay"])
@pytest.mark.parametrize("direction", ["warp", "weft", "bias"])
def test_d1388_reads_the_bending_stiffness_of_its_fabric(kind, direction):
    # The first strip is cut for another fabric.
    guess = 1.2 * cantilever.expected_rigidity(DENIM, direction)
    read = cantilever.measure(DENIM, direction, kind=kind, guess=guess)
    assert abs(read.error) < 0.02
    assert abs(read.strip.chord - FLAT_TIP) < cantilever.NEAR
    assert read.strip.droop == pytest.approx(read.exact.droop, rel=0.02)
    apart = np.hypot(
        read.strip.out / read.strip.length - np.interp(*along(read), read.exact.out),
        read.strip.down / read.strip.length - np.interp(*along(read), read.exact.down),
    )
    assert apart.max() < 0.01


@pytest.mark.parametrize("kind", ["grid", "delaunay"])
@pytest.mark.parametrize(("cells", "near"), [(5, 0.03), (8, 0.01)])
def test_d1388_reads_the_same_on_a_coarse_mesh(kind, cells, near):
    assert abs(cantilever.measure(DENIM, "warp", cells, kind).error) < near


@pytest.mark.parametrize("preset", ["silk_chiffon", "wool_worsted", "rib_knit"])
@pytest.mark.parametrize("direction", ["warp", "weft"])
def test_d1388_reads_fabrics_of_all_kinds_along_their_yarns(preset, direction):
    assert abs(cantilever.measure(Fabric(preset), direction).error) < 0.02


def test_a_strip_on_the_bias_bends_and_twists_as_a_rod_if_it_is_narrow(monkeypatch):
    """Rib bends twice as stiffly along as across; a strip as wide as it is long cannot twist freely."""
    rib, errors = Fabric("rib_knit"), []
    for width in (0.025, 0.003):
        monkeypatch.setattr(cantilever, "WIDTH", width)
        errors.append(cantilever.measure(rib, "bias").error)
    read_at = gamma_of_chord(FLAT_TIP)
    assert twisting.chord(1.0, 1.0, read_at) == pytest.approx(FLAT_TIP, abs=0.02)
    twisted = twisting.chord(rib.number("bend_warp"), rib.number("bend_weft"), read_at)
    expected = read_at / gamma_of_chord(twisted) - 1.0
    assert errors[0] > 0.03
    assert 0.01 < expected < 0.02
    assert abs(errors[1] - expected) < 0.005


def along(read):
    """Where the points of a strip's middle line lie along it, and where those of the elastica do."""
    return np.linspace(0.0, 1.0, len(read.strip.out)), read.exact.along


def test_a_stiff_disc_droops_as_a_plate():
    """Against Kirchhoff's plate, clamped at its inner circle, free at the outer, without Poisson's ratio."""
    stiffness = 2e-3
    disc = Fabric("denim", {"bend_warp": stiffness, "bend_weft": stiffness})
    hanging = drape.measure(disc, drape.COARSE)
    inner, outer, load = drape.PLATE, drape.DISC, disc.weight / stiffness
    # w = load r⁴/64 + a + b ln r + c r² + d r² ln r: no height and slope inside, no moment and shear force outside.
    conditions = np.array(
        [
            [1.0, np.log(inner), inner**2, inner**2 * np.log(inner)],
            [0.0, 1.0 / inner, 2.0 * inner, inner * (2.0 * np.log(inner) + 1.0)],
            [0.0, -1.0 / outer**2, 2.0, 2.0 * np.log(outer) + 3.0],
            [0.0, 0.0, 0.0, 4.0 / outer],
        ]
    )
    own = load * np.array([inner**4 / 64, inner**3 / 16, 3 * outer**2 / 16, outer / 2])
    a, b, c, d = np.linalg.solve(conditions, -own)
    log = np.log(outer)
    expected = load * outer**4 / 64 + a + b * log + c * outer**2 + d * outer**2 * log
    rim = cutting.norm(hanging.resting.specimen.cut.points) > drape.DISC - 1e-9
    droop = -hanging.resting.positions[rim, 2]
    assert droop.mean() == pytest.approx(expected, rel=0.05)
    assert np.ptp(droop) < 0.05 * expected
    assert hanging.coefficient == pytest.approx(100.0, abs=1.5)
    assert hanging.nodes == 0


def test_the_shadow_of_a_flat_disc_is_the_disc_and_a_cone_s_is_smaller():
    cut = cutting.annulus(drape.DISC, drape.PLATE, drape.FINE)
    flat = np.column_stack([cut.points, np.zeros(len(cut.points))])
    cone = flat.copy()
    radius = cutting.norm(cut.points)
    narrow = drape.PLATE + 0.5 * np.clip(radius - drape.PLATE, 0.0, None)
    cone[:, :2] *= np.minimum(narrow / radius, 1.0)[:, None]
    for positions, rim in ((flat, drape.DISC), (cone, 0.5 * (drape.DISC + drape.PLATE))):
        area = drape.shadow(positions, cut.triangles).sum() * drape.PIXEL**2
        # The rim is a polygon.
        assert area == pytest.approx(np.pi * rim**2, rel=2e-3)


@pytest.mark.parametrize("preset", DRAPED)
def test_the_drape_coefficient_lies_where_it_was_published(draped, preset):
    low, high = Fabric(preset).band
    assert low <= draped[preset].coefficient <= high
    assert draped[preset].intersections == 0
    assert draped[preset].resting.unbalanced <= drape.LEFT


def test_the_limper_the_fabric_the_less_it_stands_out(draped):
    coefficients = [draped[preset].coefficient for preset in IN_ORDER]
    assert coefficients == sorted(coefficients)
    assert draped["silk_habotai"].nodes > draped["denim"].nodes >= 3


def test_a_mesh_without_a_direction_drapes_like_a_grid(draped):
    scattered = drape.measure(DENIM, drape.COARSE, "delaunay")
    assert scattered.coefficient == pytest.approx(draped["denim"].coefficient, abs=5.0)


def test_the_same_specimen_drapes_to_the_same_bits():
    first, second = (drape.measure(DENIM, 0.02) for _ in range(2))
    assert first.resting.positions.tobytes() == second.resting.positions.tobytes()
    assert drape.measure(DENIM, 0.02, specimen=2).coefficient != first.coefficient


def test_what_cannot_come_to_rest_is_told(monkeypatch):
    monkeypatch.setattr(resting, "STALL", 40)
    hanging = Specimen(DENIM, cutting.strip(0.1, 0.05, (4, 2)), np.array([0]))
    with pytest.raises(Restless, match="denim does not come to rest in"):
        settle(hanging, hanging.rest, Load(force=1e-12, energy=1e3, gravity=9.81))


def test_a_specimen_that_gains_energy_goes_on_with_shorter_steps():
    """A step of a tenth of a second is far too long for denim to swing."""
    hanging = Specimen(DENIM, cutting.strip(0.1, 0.05, (8, 4)), np.arange(0, 45, 9))
    load = Load(force=0.02, energy=1e-3, gravity=9.81, step=0.1, left=1e-2)
    rest = settle(hanging, hanging.rest, load)
    assert rest.load.step < load.step
    assert rest.positions[8, 2] < -0.09


def test_a_sheet_tells_what_was_read_beside_the_preset(tmp_path, capsys):
    words = ["cotton_poplin", "--instrument", "shear", "--cells", "8", "--out", str(tmp_path)]
    words += ["--instrument", "bending", "--set", "bend_hysteresis=5e-4"]
    assert measure.main([*words, "--set", "shear=60"]) == 0
    printed = capsys.readouterr().out
    assert "Cotton poplin" in printed
    assert "picture frame" in printed
    numbers = json.loads((tmp_path / "cotton_poplin" / "numbers.json").read_text(encoding="utf-8"))
    assert numbers["changes"] == {"bend_hysteresis": 5e-4, "shear": 60.0}
    assert numbers["bending"]["weft"]["hysteresis"] == pytest.approx(5e-4, rel=0.02)
    assert (tmp_path / "cotton_poplin" / "bending.png").stat().st_size > 10_000
    assert numbers["shear"]["warp"]["stiffness"] == pytest.approx(60.0, rel=2e-3)
    assert numbers["tensile"] == {}
    assert (tmp_path / "cotton_poplin" / "shear.png").stat().st_size > 10_000
    assert "60.0" in (tmp_path / "cotton_poplin" / "sheet.txt").read_text(encoding="utf-8")


def test_a_table_tells_fabrics_beside_their_own_numbers_and_goes_on_where_it_was_stopped(
    tmp_path, capsys, monkeypatch
):
    words = ["denim", "felt", "--instrument", "shear", "--cells", "8", "--out", str(tmp_path)]
    assert measure.main(words) == 0
    whole = capsys.readouterr().out
    _, denim, felt = (
        line for line in whole.splitlines()[3:] if line[:5] in ("-----", "denim", "felt ")
    )
    assert denim.split() == ["denim", "122", "(122)"]
    assert felt.startswith("felt")
    (tmp_path / "table" / "felt.json").unlink()
    measured = []
    monkeypatch.setattr(
        sheet,
        "measure",
        lambda fabric, order: measured.append(fabric.preset) or sheet.Sheet(fabric, order),
    )
    assert measure.main([*words, "--resume"]) == 0
    assert measured == ["felt"]
    assert denim in capsys.readouterr().out
    assert measure.main([*words, "--resume", "--set", "shear=60"]) == 0
    assert measured == ["felt", "denim", "felt"]


def test_a_table_says_whether_fabrics_drape_as_they_are_said_to():
    found = {
        "fabric": "silk", "tensile": {}, "shear": {}, "cantilever": {},
        "drape": [{"coefficient_percent": c, "nodes": 5} for c in (30.0, 40.0)],
    }  # fmt: skip
    assert lineup.row({**found, "drape_band_percent": [20, 40]})[-3:] == (
        "35.0 (20 to 40)",
        "in",
        "5",
    )
    assert lineup.row({**found, "drape_band_percent": [36, 40]})[-2] == "OUT"
    assert lineup.row({**found, "drape_band_percent": None})[-3:] == ("35.0", "", "5")
    assert len(lineup.row({**found, "drape_band_percent": None})) == len(lineup.HEADINGS)


@pytest.mark.parametrize(
    ("words", "complaint"),
    [
        (["denim", "--resume"], "--resume of denim alone; accepted: of all, or of several"),
        (["denim", "velour"], "there is no fabric 'velour'; accepted: "),
        (["velour"], "there is no fabric 'velour'; accepted: cashmere_coating, "),
        (["denim", "--cells", "3"], "--cells 3: accepted: 8 to 400"),
        (["denim", "--specimens", "0"], "--specimens 0: accepted: 1 to 20"),
        (["denim", "--set", "colour=1"], "--set colour=1: accepted keys: density, "),
        (["denim", "--set", "shear=soft"], "--set shear=soft: accepted: shear=NUMBER"),
    ],
)
def test_wrong_use_is_told_in_a_line(capsys, words, complaint):
    assert measure.main(words) == 2
    assert capsys.readouterr().err.startswith(f"measure.py: {complaint}")


def test_every_preset_says_where_its_drape_lies_or_nothing():
    for preset in boucle_core.fabric_presets():
        band = Fabric(preset).band
        assert band is None or 0.0 < band[0] < band[1] < 100.0


def test_numbers_are_told_without_exponents():
    assert [sheet.figure(value, 3) for value in (25839.2, 0.01234, -1.5, 0.0, 1e-9)] == [
        "25839",
        "0.0123",
        "-1.50",
        "0",
        "0",
    ]
