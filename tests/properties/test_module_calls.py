"""Whatever the module is called with, it answers or refuses in one line, and its numbers are numbers."""

import ctypes
import json
import threading
from array import array

import boucle_core
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

SIDE = 5
COUNT = SIDE * SIDE
SCENE = {
    "scene": {"fps": 24},
    "cloth": [
        {
            "name": "sheet",
            "density": 0.2,
            "pins": {"vertices": [20, 24]},
            "pressure": {"uniform": 0.5},
            "tear": {"enabled": True, "strain": 0.8},
        }
    ],
    "collider": [{"name": "ball", "sphere": {"center": [0.5, 0.5, -0.3], "radius": 0.2}}],
    "force": [
        {"kind": "wind", "velocity": [0, 1, 0], "coefficient": 1e-3},
        {"kind": "water", "level": -0.5},
    ],
}

BUFFERS = ("rows", "point", "numbers", "float32", "corners")
METHODS = {
    "vertex_count": ("index",),
    "spring_count": ("index",),
    "collider_point_count": ("index",),
    "set_positions": ("index", "rows"),
    "set_pin_targets": ("index", "rows"),
    "set_rest": ("index", "rows", "pair"),
    "set_pressure": ("index", "number", "number", "number"),
    "set_collider_targets": ("index", "point"),
    "set_fields": ("fields",),
    "set_wind_velocity": ("index", "triple"),
    "set_water": ("number", "triple"),
    "set_gravity": ("triple",),
    "release_pins": ("index", "vertices"),
    "set_pin_weights": ("index", "numbers"),
    "set_pin_stiffness": ("index", "number"),
    "grab": ("index", "vertices", "rows", "numbers"),
    "let_go": (),
    "advance": (),
    "certificate": ("index",),
    "interrupter": (),
    "read_positions": ("index", "rows"),
    "read_velocities": ("index", "rows"),
    "read_strain": ("index", "float32"),
    "read_tension": ("index", "float32"),
    "read_wetness": ("index", "float32"),
    "read_contacts": ("index", "float32"),
    "read_intersections": ("index", "float32"),
    "read_corners": ("index", "corners"),
    "read_corner_numbers": ("index", "quantity", "corner_float32"),
    "vertex_origins": ("index",),
    "torn_edges": ("index",),
    "edge_tension": ("index",),
    "overstretched_edges": ("index",),
    "read_springs": ("index",),
    "checkpoint": (),
    "restore": ("bytes",),
}
PROPERTIES = {"frame", "cloth_names", "collider_names", "safe_time_step", "substeps"}
FUNCTIONS = {
    "point_triangle_distance": ("fours", "results"),
    "edge_edge_distance": ("fours", "results"),
    "point_triangle_impact": ("fours", "fours", "number", "results"),
    "edge_edge_impact": ("fours", "fours", "number", "results"),
    "edge_crosses_triangle": ("fives", "flags"),
    "fabric_springs": ("preset", "number"),
    "fabric_presets": (),
}
ELSEWHERE = {"bake", "run_batch"}

SHAPES = {
    "rows": (COUNT, 3),
    "point": (1, 3),
    "numbers": (COUNT,),
    "float32": (COUNT,),
    "corners": (4 * (SIDE - 1) ** 2, 3),
    "corner_float32": (4 * (SIDE - 1) ** 2,),
    "starts": ((SIDE - 1) ** 2,),
    "indices": (4 * (SIDE - 1) ** 2,),
    "fours": (7, 4, 3),
    "fives": (7, 5, 3),
    "results": (7,),
    "flags": (7,),
}
DTYPES = [
    "f4", "f8", "f2", "i1", "i2", "i4", "i8", "u1", "u2", "u4", "u8", "?", "c8", "c16", ">f4", ">f8", ">i4", "O", "S4", "U2",
    "M8[s]", "V8",
]  # fmt: skip

odd_floats = st.sampled_from(
    [0.0, -0.0, 1.0, -1.0, 0.5, 1e-300, 5e-324, 1e6, 1e12, 1e30, 1e300, float("nan"), float("inf"), -float("inf")]
)  # fmt: skip
numbers = st.one_of(st.floats(), odd_floats, st.floats(-10, 10))
odd_integers = st.sampled_from(
    [-1, 0, 1, 2**31, -(2**31), 2**32, 2**63 - 1, 2**63, -(2**64), 10**40]
)
integers = st.one_of(st.integers(0, COUNT - 1), st.integers(), odd_integers)
nothing_useful = st.sampled_from(
    [None, True, 3, 0.5, "text", b"bytes", [], {}, [1.0] * 75, object(), np, 2**70]
)
texts = st.one_of(
    st.text(max_size=40), st.sampled_from(["", "\0", "a\nb", "\ud800", "[" * 9000, "é" * 500])
)


def grid():
    across = np.linspace(0, 1, SIDE)
    x, z = np.meshgrid(across, across)
    positions = np.stack([x.ravel(), np.zeros(COUNT), z.ravel()], axis=1)
    first = np.array([row * SIDE + column for row in range(SIDE - 1) for column in range(SIDE - 1)])
    corners = np.stack([first, first + 1, first + SIDE + 1, first + SIDE], axis=1).astype(np.int32)
    return positions, np.arange(0, corners.size, 4, dtype=np.int32), corners.ravel()


def simulation(scene=SCENE, mesh=None):
    return boucle_core.Simulation(json.dumps(scene), [mesh or grid()], threads=1)


@st.composite
def plain(draw, role):
    """An array as it should be, but for what stands in it."""
    if role in {"rows", "corners"}:
        rows = grid()[0] if role == "rows" else np.zeros(SHAPES[role])
        rows = rows + draw(st.sampled_from([0.0, 0.01, 0.3, 1e5]))
    else:
        rows = np.full(SHAPES[role], draw(odd_floats) if draw(st.booleans()) else 0.5)
    if role == "flags":
        return np.zeros(rows.shape, np.uint8)
    if draw(st.integers(0, 3)) == 0:
        rows.reshape(-1)[draw(st.integers(0, rows.size - 1))] = draw(numbers)
    with np.errstate(all="ignore"):
        return (
            rows.astype(np.float32)
            if role in {"float32", "corner_float32"} or draw(st.booleans())
            else rows
        )


@st.composite
def hostile(draw, role):
    """An array that is not as it should be."""
    shape = list(SHAPES[role])
    change = draw(st.integers(0, 7))
    if change == 0:
        shape[draw(st.integers(0, len(shape) - 1))] += draw(st.sampled_from([-1, 1, 5]))
    elif change == 1:
        shape[0] = 0
    elif change == 2:
        shape.reverse()
    elif change == 3:
        shape = draw(st.lists(st.integers(0, 5), max_size=5))
    elif change == 4:
        shape = [int(np.prod(shape))]
    one = np.zeros(shape, draw(st.sampled_from(DTYPES)))
    layout = draw(st.integers(0, 9))
    if layout == 0 and one.ndim:
        one = one[::-1]
    elif layout == 1:
        one = np.asfortranarray(one)
    elif layout == 2 and one.ndim:
        one = np.broadcast_to(one[:1], (2**40, *one.shape[1:])) if len(one) else one
    elif layout == 3:
        one.flags.writeable = False
    elif layout == 4 and one.ndim:
        one = np.repeat(one, 2, axis=0)[::2]
    elif layout == 5:
        one = one.T
    elif layout == 6 and one.dtype.kind in "fiu" and one.size:
        one = (ctypes.c_float * one.size)()
    elif layout == 7 and one.dtype.str[1:] in {"f4", "f8"}:
        one = array("f" if one.dtype.itemsize == 4 else "d", one.ravel())
    elif layout == 8 and one.flags.c_contiguous and one.dtype.kind in "fiu":
        one = memoryview(one)
    return one


def argument(role):
    if role in SHAPES:
        return st.one_of(plain(role), plain(role), hostile(role), nothing_useful)
    return st.one_of(
        {
            "index": st.one_of(st.just(0), st.just(0), st.just(0), integers),
            "number": numbers,
            "pair": st.one_of(st.none(), st.tuples(numbers, numbers)),
            "triple": st.one_of(
                st.tuples(numbers, numbers, numbers), st.lists(numbers, max_size=4)
            ),
            "vertices": st.one_of(
                st.none(), st.lists(st.integers(0, COUNT - 1)), st.lists(integers, max_size=5)
            ),
            "fields": st.one_of(texts, fields),
            "quantity": st.one_of(texts, st.sampled_from(["strain", "contact", "force"])),
            "preset": st.one_of(texts, st.sampled_from(sorted(boucle_core.fabric_presets()))),
            "bytes": st.one_of(st.binary(max_size=60), st.just(simulation().checkpoint()), spoiled),
        }[role],
        nothing_useful if role != "index" else integers,
    )


fields = st.lists(
    st.fixed_dictionaries(
        {"kind": st.sampled_from(["point", "vortex", "turbulence", "drag", "harmonic", "magnetic", "wind", "x"])},
        optional={
            "strength": numbers, "flow": numbers, "noise": numbers, "size": numbers, "damping": numbers,
            "rest_length": numbers, "location": st.lists(numbers, max_size=4), "seed": integers,
            "shape": st.sampled_from(["point", "line", "plane", "?"]),
        },
    ),
    max_size=3,
).map(json.dumps)  # fmt: skip


@st.composite
def spoiled(draw):
    bytes_ = bytearray(simulation().checkpoint())
    bytes_[draw(st.integers(0, len(bytes_) - 1))] ^= draw(st.integers(1, 255))
    return bytes(bytes_)


spoiled = spoiled()


def tried(call, *words):
    """What a call answers; None where it refuses in one line."""
    try:
        return call(*words)
    except boucle_core.InternalError:
        raise
    except (boucle_core.BoucleError, TypeError, ValueError, OverflowError) as error:
        text = str(error)
        assert 5 < len(text) < 2000, text
        if isinstance(error, boucle_core.BoucleError):
            assert "\n" not in text, text
    return None


def advance(one):
    """Move on by a frame; interrupt it where it takes long."""
    timer = threading.Timer(1.0, one.interrupter().interrupt)
    timer.start()
    row = tried(one.advance)
    timer.cancel()
    timer.join()
    return row


def assert_sound(one):
    row = one.certificate()
    told = {key: value for key, value in row.items() if isinstance(value, float)}
    assert np.isfinite(list(told.values())).all(), row
    assert None not in [row["max_strain"], row["kinetic_energy"], row["potential_energy"]], row
    count = one.vertex_count(0)
    for read in (one.read_positions, one.read_velocities):
        out = np.full((count, 3), np.nan)
        read(0, out)
        assert np.isfinite(out).all()


def test_every_method_and_function_is_tried():
    named = {name for name in dir(boucle_core.Simulation) if not name.startswith("_")}
    assert named == set(METHODS) | PROPERTIES
    functions = {
        name
        for name in dir(boucle_core)
        if not name.startswith("_") and not isinstance(getattr(boucle_core, name), type)
    }
    assert functions - {"boucle_core"} == set(FUNCTIONS) | ELSEWHERE


@given(st.data())
def test_no_calls_of_a_simulation_break_it(data):
    one = simulation()
    for _ in range(data.draw(st.integers(1, 6))):
        name = data.draw(st.sampled_from(sorted(METHODS)))
        words = [data.draw(argument(role)) for role in METHODS[name]]
        if name == "advance":
            advance(one)
        else:
            tried(getattr(one, name), *words)
        assert_sound(one)
    advance(one)
    assert_sound(one)


@pytest.mark.parametrize("name", sorted(METHODS))
@given(st.data())
def test_no_arguments_break_a_method(name, data):
    one = simulation()
    tried(getattr(one, name), *[data.draw(argument(role)) for role in METHODS[name]])
    assert_sound(one)


@pytest.mark.parametrize("name", sorted(FUNCTIONS))
@given(st.data())
def test_no_arguments_break_a_function(name, data):
    words = [data.draw(argument(role)) for role in FUNCTIONS[name]]
    if (
        words
        and data.draw(st.integers(0, 9)) == 0
        and isinstance(words[0], np.ndarray)
        and words[0].flags.c_contiguous
    ):
        words[-1] = words[0].ravel()[:7]  # both in one place
    out = words[-1] if FUNCTIONS[name][-1:] == ("results",) else None
    is_plain = isinstance(out, np.ndarray) and out.dtype == np.float64 and out.shape == (7,)
    given_out = out.copy() if is_plain else None
    tried(getattr(boucle_core, name), *words)
    if is_plain and not np.array_equal(out, given_out, equal_nan=True):
        assert not np.isnan(out).any()


@given(st.data())
def test_no_arrays_of_a_mesh_break_a_simulation(data):
    good = grid()
    mesh = [
        data.draw(st.one_of(st.just(array_), argument(role)))
        for array_, role in zip(good, ("rows", "starts", "indices"), strict=True)
    ]
    roles = st.one_of(st.none(), argument("rows"), argument("corners"))
    words = {
        "threads": data.draw(
            st.one_of(st.just(1), st.just(1), integers.filter(lambda n: not 2 < n < 1025))
        ),
        "colliders": [tuple(mesh)] if data.draw(st.booleans()) else [],
        "rests": data.draw(st.lists(roles, max_size=2)),
        "uvs": data.draw(st.lists(roles, max_size=2)),
    }
    scene = data.draw(st.one_of(st.just(json.dumps(SCENE)), texts))
    one = tried(lambda: boucle_core.Simulation(scene, [tuple(mesh)], **words))
    if one is not None:
        advance(one)
        assert_sound(one)


@given(data=st.data())
def test_nothing_breaks_a_batch_or_a_bake(tmp_path_factory, data):
    folder = tmp_path_factory.mktemp("bake")
    small = {"name": "a", "grid": {"size": [1, 1], "vertices": [3, 3]}}
    good = json.dumps({"cloth": [small], "scene": {"frames": [1, 2]}})
    scenes = data.draw(st.lists(st.one_of(st.just(good), texts), max_size=3))
    words = {
        "folder": data.draw(st.one_of(st.none(), texts)),
        "threads": data.draw(st.sampled_from([1, 2, -1, 1025, 2**70])),
    }
    rows = tried(lambda: boucle_core.run_batch(scenes, **words))
    assert rows is None or len(rows) == len(scenes)
    path = folder / "scene.toml"
    path.write_text(
        '[[cloth]]\nname = "a"\ngrid = { size = [1, 1], vertices = [3, 3] }\n[scene]\nframes = [1, 2]\n'
    )
    words = {
        "frames": data.draw(st.one_of(st.none(), st.tuples(integers, integers))),
        "threads": data.draw(st.sampled_from([1, -1, 1025, 2**70])),
        "overrides": data.draw(st.lists(texts, max_size=2)),
        "resume": data.draw(st.booleans()),
    }
    scene = data.draw(
        st.one_of(st.just(str(path)), st.sampled_from(["", "\0", "no\nsuch", "/", "a\udc80"]))
    )
    report = tried(lambda: boucle_core.bake(scene, str(folder / "out"), **words))
    assert report is None or json.dumps(report, allow_nan=False)
