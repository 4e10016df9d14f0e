"""What a sweep's file makes: grids, lists, Latin hypercubes, refusals, and the words that bake.py reads."""

import math
import tomllib

import pytest

from sweeping import description, sampling
from sweeping.toml_text import text_of


@pytest.fixture
def read(tmp_path):
    """Read a sweep's file made of its parts."""
    (tmp_path / "scene.toml").write_text("")

    def read(text, method="grid", head=""):
        path = tmp_path / "sweep.toml"
        path.write_text(f'[sweep]\nscene = "scene.toml"\nmethod = "{method}"\n{head}\n{text}')
        return description.read(path)

    return read


def test_a_grid_has_every_combination_once_and_the_last_parameter_changes_fastest(read):
    sweep = read(
        '[parameters]\na = [1, 2, 3]\n"b.0" = ["x", "y"]\n'
        'c = { from = 1.0, to = 100.0, count = 3, scale = "log" }'
    )
    rows = [tuple(run.parameters.values()) for run in sweep.runs]
    assert len(rows) == len(set(rows)) == 3 * 2 * 3
    assert rows[:4] == [(1, "x", 1.0), (1, "x", 10.0), (1, "x", 100.0), (1, "y", 1.0)]
    assert [run.name for run in sweep.runs[:2]] == ["000", "001"]
    assert sweep.parameters == ["a", "b.0", "c"]


def test_a_range_holds_its_ends_and_even_steps_between(read):
    sweep = read(
        "[parameters]\na = { from = -1, to = 1, count = 5 }\nb = { from = 2, to = 3, count = 1 }"
    )
    assert [run.parameters["a"] for run in sweep.runs] == [-1.0, -0.5, 0.0, 0.5, 1.0]
    assert {run.parameters["b"] for run in sweep.runs} == {2.0}
    whole = read("[parameters]\na = { from = 1, to = 3, count = 9, integer = true }")
    assert [run.parameters["a"] for run in whole.runs] == [1, 2, 3]


def test_a_list_is_taken_as_it_stands_and_runs_may_set_different_keys(read):
    sweep = read("[[run]]\na = 1\n[[run]]\nb = [1.5, 2]\n[[run]]\n", method="list")
    assert [run.parameters for run in sweep.runs] == [{"a": 1}, {"b": [1.5, 2]}, {}]
    assert sweep.parameters == ["a", "b"]
    assert sweep.overrides(sweep.runs[1]) == ["b=[1.5, 2]"]


@pytest.mark.parametrize("samples", [1, 7, 64])
def test_a_latin_hypercube_has_one_sample_in_every_stratum_of_every_parameter(read, samples):
    sweep = read(
        "[parameters]\na = { from = 2, to = 10 }\n"
        'b = { from = 0.01, to = 100, scale = "log" }\nc = { from = -1, to = 0 }',
        method="latin_hypercube",
        head=f"samples = {samples}\nseed = 5",
    )
    assert len(sweep.runs) == samples
    places = {
        "a": lambda value: (value - 2) / 8,
        "b": lambda value: math.log(value / 0.01) / math.log(1e4),
        "c": lambda value: value + 1,
    }
    for key, place in places.items():
        strata = sorted(int(place(run.parameters[key]) * samples) for run in sweep.runs)
        assert strata == list(range(samples)), key


def test_a_latin_hypercube_spreads_choices_and_whole_numbers_evenly(read):
    sweep = read(
        '[parameters]\na = ["x", "y", "z"]\nb = { from = 4, to = 7, integer = true }',
        method="latin_hypercube",
        head="samples = 12",
    )
    for key, values in (("a", "xyz"), ("b", range(4, 8))):
        seen = [run.parameters[key] for run in sweep.runs]
        assert {value: seen.count(value) for value in values} == dict.fromkeys(
            values, 12 // len(values)
        )


def test_the_same_seed_gives_the_same_runs_and_another_one_others(read):
    def runs(seed):
        text = "[parameters]\na = { from = 0, to = 1 }\nb = { from = 0, to = 1 }"
        return read(text, "latin_hypercube", f"samples = 16\nseed = {seed}").runs

    assert runs(3) == runs(3)
    assert runs(3) != runs(4)
    a, b = ([run.parameters[key] for run in runs(3)] for key in "ab")
    assert sorted(range(16), key=a.__getitem__) != sorted(range(16), key=b.__getitem__)


def test_the_digest_changes_with_whatever_changes_the_result(read, tmp_path):
    text = "[parameters]\na = [1, 2]"
    (tmp_path / "scene.toml").write_text('[[cloth]]\nmesh = "shirt.obj"')
    (tmp_path / "shirt.obj").write_text("v 0 0 0")
    first = read(text).digest()
    assert read(text).digest() == first
    assert read("[parameters]\na = [1, 3]").digest() != first
    assert read(text, head="frames = [1, 5]").digest() != first
    assert read(text, head='set = { "b" = 1 }').digest() != first
    (tmp_path / "shirt.obj").write_text("v 0 0 1")
    assert read(text).digest() != first
    (tmp_path / "shirt.obj").write_text("v 0 0 0")
    (tmp_path / "scene.toml").write_text('[[cloth]]\nmesh = "shirt.obj" # changed')
    assert read(text).digest() != first


@pytest.mark.parametrize(
    "value",
    [1, -7, 0.1, 1e-9, 1e300, 5e-324, True, False, "rk4", 'a "b" \\ c', "é \x7f 😀\n", [1, [2.5, "x"]], {"a b": [True]}],
)  # fmt: skip
def test_a_value_comes_back_from_its_text_to_the_bit(value):
    back = tomllib.loads(f"value = {text_of(value)}")["value"]
    assert back == value
    assert type(back) is type(value)


@pytest.mark.parametrize("value", [math.nan, -math.inf, None, [math.inf], object()])
def test_what_is_no_value_is_refused(value):
    with pytest.raises(ValueError, match=r"no finite number|no accepted kind"):
        text_of(value)


@pytest.mark.parametrize(
    ("text", "method", "head", "said"),
    [
        ("", "grid", "", "[parameters] is missing"),
        ("[parameters]", "grid", "", "[parameters] is empty"),
        ("[parameters]\na = 1", "grid", "", "parameters.a = 1; accepted: a list"),
        ("[parameters]\na = []", "grid", "", "parameters.a = []; accepted: at least one"),
        ("[parameters]\na.b = [1]", "grid", "", "parameters.a is a table without from and to"),
        ("[parameters]\na = { from = 1, to = 2 }", "grid", "", "a.count = None; accepted"),
        ("[parameters]\na = { from = 2, to = 2, count = 2 }", "grid", "", "from < to"),
        ("[parameters]\na = { from = nan, to = 2, count = 2 }", "grid", "", "from nan to 2"),
        (
            '[parameters]\na = { from = 0, to = 2, scale = "log" }',
            "latin_hypercube",
            "samples = 3",
            "parameters.a.from = 0; accepted with a log scale: a number above 0",
        ),
        ("[parameters]\na = { from = 0, to = 2, scales = 1 }", "grid", "", "a.scales is not known"),
        ("[parameters]\na = [1]", "random", "", "sweep.method = 'random'; accepted: \"grid\""),
        ("[parameters]\na = [1]", "latin_hypercube", "", "sweep.samples = None; accepted"),
        ("[parameters]\na = [1]", "latin_hypercube", "samples = 0", "sweep.samples = 0; accepted"),
        (
            "[parameters]\na = [1]",
            "latin_hypercube",
            "samples = 2\nseed = -1",
            "sweep.seed = -1; accepted",
        ),
        ("[parameters]\na = [1]", "grid", "samples = 3", "samples = 3; accepted only with"),
        ("[parameters]\na = [1]\n[[run]]\n", "grid", "", "[[run]] is accepted only with"),
        ("[parameters]\na = [1]\n[[run]]\n", "list", "", "[parameters] is not accepted with"),
        ("", "list", "", 'method = "list" without [[run]]'),
        ("[[run]]\na = 2020-01-01", "list", "", "run 0: a: 2020-01-01 is of no accepted kind"),
        ("[parameters]\na = [1]", "grid", "frames = 3", "sweep.frames = 3; accepted"),
        ("[parameters]\na = [1]", "grid", "timeout = 0", "sweep.timeout = 0; accepted"),
        ("[parameters]\na = [1]", "grid", "set = { a = 2 }", "sweep.set.a is a parameter, too"),
        ("[parameters]\na = [1]", "grid", "speed = 1", "sweep.speed is not known"),
        ("[other]", "grid", "", "other is not known; accepted: sweep, parameters, run"),
        (
            "[parameters]\n" + "\n".join(f"p{i} = [1, 2]" for i in range(17)),
            "grid",
            "",
            "the grid's size = 131072; accepted: 1 to 100000 runs",
        ),
    ],
)  # fmt: skip
def test_what_is_not_accepted_is_told_in_one_line(read, text, method, head, said):
    with pytest.raises(description.Wrong) as wrong:
        read(text, method, head)
    assert said in str(wrong.value)
    assert "sweep.toml: " in str(wrong.value)
    assert "accepted" in str(wrong.value)
    assert "\n" not in str(wrong.value)


def test_a_file_that_is_missing_or_no_toml_is_told_in_one_line(tmp_path):
    for path, said in (
        (tmp_path / "nowhere.toml", "cannot be read"),
        (tmp_path / "bad.toml", "no TOML"),
    ):
        (tmp_path / "bad.toml").write_text("[sweep")
        with pytest.raises(description.Wrong, match=said):
            description.read(path)


def test_a_scene_that_is_missing_is_named(read, tmp_path):
    (tmp_path / "scene.toml").unlink()
    with pytest.raises(description.Wrong, match=r"sweep.scene = 'scene.toml'; accepted"):
        read("[parameters]\na = [1]")


def test_the_middle_of_a_logarithmic_range_is_the_geometric_mean():
    middle = sampling.Range(10, 1000, 3, is_log=True).values()[1]
    assert middle == pytest.approx(100, rel=1e-15)


def test_the_example_is_accepted_and_its_keys_are_known(scenes, run_bake):
    sweep = description.read(scenes / "sweeps" / "sphere.toml")
    assert len(sweep.runs) == 16
    words = [*sweep.overrides(sweep.runs[3]), "scene.frames=[1, 2]"]
    assert run_bake(sweep.scene, "--out", "out", "--quiet", "--set", *words).returncode == 0
