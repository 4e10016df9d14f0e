"""Named fabrics as settings of a cloth and as rows of a menu."""

import boucle_core
from boucle_addon.core import fabric_preset

FABRICS = boucle_core.fabric_presets()


def test_rows_stand_in_alphabetical_order_within_their_groups():
    rows = fabric_preset.rows(FABRICS)
    assert [row[1:] for row in rows] == sorted(row[1:] for row in rows)
    assert len(rows) == len(FABRICS)
    assert [row.name for row in rows if row.group == "Silk"] == [
        "silk_chiffon", "silk_crepe_de_chine", "silk_habotai", "silk_organza", "silk_satin"
    ]  # fmt: skip


def test_a_fabric_gives_every_setting_that_it_is_known_by():
    for name, fabric in FABRICS.items():
        springs = boucle_core.fabric_springs(name, 0.02)
        found = fabric_preset.settings(fabric, springs)
        assert set(found) == set(fabric_preset.SETTINGS)
        assert found["use_compression"] == ("compression_warp" in fabric)
        assert found["compression_weft"] == fabric.get("compression_weft", fabric["stretch_weft"])
        assert found["shear"] == fabric["shear"] == springs["shear"], "one number for both models"
        assert found["deformation_rate"] == springs["deformation_rate"]


def test_the_numbers_are_told_in_one_sentence():
    said = fabric_preset.sentence(FABRICS["leather_nappa"])
    assert said == (
        "500 g/m², 0.8 mm thick; along warp and weft it stretches by 15 and 12 kN/m and bends by "
        "24 and 20 µN·m; shear 4800 N/m; it tears at 12 kN/m"
    )
