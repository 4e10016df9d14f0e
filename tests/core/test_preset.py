"""Presets as TOML: what fits is read as it was written, and what does not is refused by name."""

import pytest
from boucle_addon.core import preset
from boucle_addon.core.preset import Preset, Setting
from boucle_addon.core.refusal import Refusal

SCHEMA = {
    "stretch": Setting("FLOAT", 0.0, 1e9),
    "substeps": Setting("INT", 0, 100),
    "allow_unstable": Setting("BOOLEAN"),
    "limiter": Setting("ENUM", choices=("none", "project")),
}


def test_what_is_written_is_read_again():
    values = {"stretch": 0.1, "substeps": 3, "allow_unstable": True, "limiter": "project"}
    whole = Preset('of "silk",\nin m² and N·s/m', values)
    assert preset.parse("Silk", preset.write(whole), SCHEMA) == whole


def test_a_whole_number_stands_for_a_decimal_one():
    value = preset.parse("Silk", "[settings]\nstretch = 3", SCHEMA).values["stretch"]
    assert value == 3.0 and isinstance(value, float)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("[settings", 'the preset "Silk" is not TOML'),
        ("stretch = 3.0", '"stretch" has no place'),
        ("description = 3", '"description" has no place'),
        ("settings = 3", '"settings" has no place'),
        ("[settings]\nstrech = 3.0", '"strech" is no setting of a preset: did you mean "stretch"?'),
        ("[settings]\nvelvet = 3.0", "known are stretch, substeps"),
        ('[settings]\nstretch = "3"', 'stretch is "3", but accepted is a number from 0 to 1e+09'),
        ("[settings]\nstretch = true", "stretch is true, but accepted is a number"),
        ("[settings]\nstretch = nan", "stretch is nan, but accepted is a number"),
        ("[settings]\nstretch = -1.0", "stretch is -1.0, but accepted is a number from 0"),
        ("[settings]\nstretch = [1.0]", "stretch is [1.0], but accepted is a number"),
        ("[settings]\nstretch = 2020-01-01", 'stretch is "2020-01-01", but accepted is a number'),
        ("[settings]\nsubsteps = 2.0", "substeps is 2.0, but accepted is a whole number from 0 to 100"),
        ("[settings]\nsubsteps = 101", "substeps is 101, but"),
        ("[settings]\nallow_unstable = 1", "allow_unstable is 1, but accepted is true or false"),
        ('[settings]\nlimiter = "elastic"', 'limiter is "elastic", but accepted is one of none, project'),
        ("[settings]\nlimiter = []", "limiter is [], but"),
    ],
)  # fmt: skip
def test_what_does_not_fit_is_refused_in_one_sentence(text, said):
    with pytest.raises(Refusal) as refused:
        preset.parse("Silk", text, SCHEMA)
    assert said in str(refused.value) and '"Silk"' in str(refused.value)
    assert "\n" not in str(refused.value)


def test_a_name_is_taken_as_it_is_without_spaces_around_it():
    assert preset.checked_name("  Été 2 - à sec_1 ", ["Silk"], ["Mine"]) == "Été 2 - à sec_1"


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("  ", "has no name"),
        ("x" * 65, "65 letters"),
        ("../x", "cannot be the name"),
        ("a:b", "cannot be the name"),
        ("x.", "cannot be the name"),
        (".x", "cannot be the name"),
        ("NUL", "cannot be the name"),
        ("con.x", "cannot be the name"),
        ("None", "cannot be the name"),
        ("silk", "choose another"),
        ("MINE", "delete that one first"),
    ],
)
def test_a_name_that_no_file_may_have_or_that_is_taken_is_refused(name, said):
    with pytest.raises(Refusal, match=said):
        preset.checked_name(name, ["Silk"], ["Mine"])
