"""Distances, collisions and intersections against ipctk and against plain numpy, a million questions each.

The second oracle goes through all features of both sides with longer numbers than ours: no clamping, no choice. A million
are asked in portions that fit the processor's cache.
"""

import boucle_core
import ipctk
import numpy as np
import pytest

COUNT = 1_000_000
PORTION = 20_000
KINDS = 8

TOLERANCE = max(1e-9, 2 * np.sqrt(float(np.finfo(np.longdouble).eps)))
"""Of the size of the input. The oracle's normal equations square the thinness of slivers: half of its digits are good."""

DISTANCES = {
    "point_triangle": (boucle_core.point_triangle_distance, ipctk.point_triangle_distance),
    "edge_edge": (boucle_core.edge_edge_distance, ipctk.edge_edge_distance),
}
IMPACTS = {
    "point_triangle": (boucle_core.point_triangle_impact, "point_triangle_ccd"),
    "edge_edge": (boucle_core.edge_edge_impact, "edge_edge_ccd"),
}


def four_points(rng, count, scales=9, far=1e3):
    """Four points, of kinds in turn: generic, lattice, plane, sliver, needle, parallel edges, touching, a line.

    They are tiny to large (10 to the power of plus or minus `scales`), and some `far` from the origin.
    """
    x = rng.uniform(-1, 1, (count, 4, 3))
    share = rng.uniform(-1, 1, (count, 1))
    thin = rng.uniform(-1, 1, (count, 3)) * 10.0 ** -rng.integers(4, 17, (count, 1))
    kind = np.arange(count) % KINDS
    x[kind == 1] = rng.integers(-1, 2, (count, 4, 3))[kind == 1]
    x[kind == 2, :, 2] = 0.5
    sliver = x[:, 1] + (x[:, 2] - x[:, 1]) * share + thin
    x[kind == 3, 3] = sliver[kind == 3]
    x[kind == 4, 2] = (x[:, 1] + thin)[kind == 4]
    parallel = x[:, 2] + (x[:, 1] - x[:, 0]) * share + thin
    x[kind == 5, 3] = parallel[kind == 5]
    touching = x[:, 1] * share + x[:, 2] * (0.7 - share) + x[:, 3] * 0.3 + thin
    x[kind == 6, 0] = touching[kind == 6]
    along = np.concatenate([0 * share, 1 + 0 * share, share, 2 * share], axis=1)[..., None]
    x[kind == 7] = (x[:, :1] + x[:, 1:2] * along)[kind == 7]
    x += far * rng.uniform(-1, 1, (count, 1, 3)) * (rng.random((count, 1, 1)) < 0.25)
    return x * 10.0 ** rng.integers(-scales, scales + 1, (count, 1, 1))


def dot(a, b):
    return (a * b).sum(axis=-1)


def lengths(a):
    return np.sqrt(dot(a, a))


def inside(p, origin, sides):
    """Distance of p and the parallelogram or triangle spanned at the origin, by the normal equations; infinite if its foot
    lies outside. `sides` are two vectors and a function that says which parameters are inside.
    """
    u, v, is_inside = sides
    r = p - origin
    uu, uv, vv, ru, rv = dot(u, u), dot(u, v), dot(v, v), dot(r, u), dot(r, v)
    determinant = uu * vv - uv * uv
    s, t = (ru * vv - rv * uv) / determinant, (rv * uu - ru * uv) / determinant
    reached = lengths(r - s[:, None] * u - t[:, None] * v)
    return np.where((s >= 0) & (t >= 0) & is_inside(s, t), reached, np.inf)


def to_segment(p, a, b):
    """Distance of a point and a segment: of its ends, and of its foot if that lies on it."""
    t = dot(p - a, b - a) / dot(b - a, b - a)
    foot = np.where((t >= 0) & (t <= 1), lengths(p - a - t[:, None] * (b - a)), np.inf)
    return np.fmin(foot, np.minimum(lengths(p - a), lengths(p - b)))


def by_features(name, x):
    """The least distance over all pairs of features."""
    a, b, c, d = (x[:, i].astype(np.longdouble) for i in range(4))
    with np.errstate(all="ignore"):
        if name == "point_triangle":
            face = inside(a, b, (c - b, d - b, lambda s, t: s + t <= 1))
            borders = [to_segment(a, *border) for border in ((b, c), (c, d), (d, b))]
        else:
            face = inside(a, c, (d - c, a - b, lambda s, t: (s <= 1) & (t <= 1)))
            borders = [to_segment(end, c, d) for end in (a, b)]
            borders += [to_segment(end, a, b) for end in (c, d)]
        return np.fmin(face, np.minimum.reduce(borders)).astype(float)


def in_portions(function, *arrays):
    """A function of arrays, put together from portions of them."""
    portions = range(0, len(arrays[0]), PORTION)
    return np.concatenate([function(*(a[i : i + PORTION] for a in arrays)) for i in portions])


def sizes(x):
    return np.maximum(np.abs(x).max(axis=(1, 2)), 1e-300)


@pytest.mark.parametrize("name", DISTANCES)
def test_distances_are_those_of_the_nearest_features(name):
    x = four_points(np.random.default_rng(1), COUNT)
    out = np.empty(COUNT)
    DISTANCES[name][0](x, out)
    error = np.abs(out - in_portions(lambda x: by_features(name, x), x)) / sizes(x)
    assert error.max() <= TOLERANCE, x[error.argmax()].tolist()


def is_whole(name, x):
    """Whether triangles are no slivers, and edges have a length: ipctk trusts the plane or line of what hardly has one."""
    a, b, c, d = (x[:, i] for i in range(4))
    if name == "point_triangle":
        return lengths(np.cross(c - b, d - b)) > 1e-8 * lengths(c - b) * lengths(d - b)
    return (lengths(b - a) > 0) & (lengths(d - c) > 0)


@pytest.mark.parametrize("name", DISTANCES)
def test_distances_are_those_of_ipctk(name):
    ours, theirs = DISTANCES[name]
    x = four_points(np.random.default_rng(2), COUNT)
    x = x[is_whole(name, x)]
    out = np.empty(len(x))
    ours(x, out)
    error = np.abs(out - np.sqrt([theirs(*points) for points in x])) / sizes(x)
    assert len(x) > 0.7 * COUNT
    # Nearly parallel edges cost ipctk half of its digits: its lines are crossed by normal equations.
    assert error.max() <= 1e-7, x[error.argmax()].tolist()


def paths(name, seed, count):
    """Starts and ends of ordinary size, with the time at which half of the paths make the features meet."""
    rng = np.random.default_rng(seed)
    starts = four_points(rng, count, scales=0, far=0)
    ends = np.where(
        rng.random((count, 1, 1)) < 0.5,
        rng.uniform(-1, 1, starts.shape),
        starts + rng.uniform(-0.1, 0.1, (count, 1, 3)) + rng.uniform(-0.01, 0.01, starts.shape),
    )
    first = 1 if name == "point_triangle" else 2
    weights = rng.random((count, 4))
    weights[:, :first] /= weights[:, :first].sum(axis=1, keepdims=True)
    weights[:, first:] /= -weights[:, first:].sum(axis=1, keepdims=True)
    meets = rng.uniform(0.05, 1, count)
    now = moved(starts, ends, meets)
    missed = (now * weights[..., None]).sum(axis=1) / meets[:, None]
    half = slice(0, count, 2)
    ends[half, :first] -= missed[half, None]
    meets[1::2] = np.inf
    return starts, ends, meets


def moved(starts, ends, times):
    times = np.reshape(times, (-1, 1, 1))
    return starts * (1 - times) + ends * times


def impacts(name, starts, ends, gap):
    times = np.empty(len(starts))
    IMPACTS[name][0](starts, ends, gap, times)
    return times


@pytest.mark.parametrize("name", IMPACTS)
def test_features_made_to_meet_have_their_impact_no_later(name):
    starts, ends, meets = paths(name, 3, COUNT)
    times = impacts(name, starts, ends, 0.0)
    assert (times <= meets).all()
    assert np.isinf(times).mean() > 0.1


@pytest.mark.parametrize("name", IMPACTS)
def test_the_gap_is_kept_at_any_time_before_the_impact(name):
    gap = 1e-3
    starts, ends, _meets = paths(name, 4, COUNT)
    start = in_portions(lambda x: by_features(name, x), starts)
    times = impacts(name, starts, ends, gap)
    assert (times[start < gap - 1e-12] == 0).all()
    assert (times[start > gap + 1e-12] > 0).all()
    share = np.random.default_rng(5).random(COUNT) ** 0.25
    now = moved(starts, ends, share * np.minimum(times, 1))[start > gap]
    assert in_portions(lambda x: by_features(name, x), now).min() > gap - TOLERANCE


@pytest.mark.parametrize(
    ("detector", "count"), [("AdditiveCCD", 100_000), ("TightInclusionCCD", 2_000)]
)
@pytest.mark.parametrize("name", IMPACTS)
def test_impacts_that_ipctk_finds_are_found_no_later(name, detector, count):
    """ipctk stops early, mostly nearer than our gap: then ours comes first. Else its own distance says that it was early."""
    gap = 1e-3
    starts, ends, _meets = paths(name, 6, count)
    times = impacts(name, starts, ends, gap)
    asked = is_whole(name, starts) & is_whole(name, ends) & (times > 0)
    starts, ends, times = starts[asked], ends[asked], times[asked]
    settings = {"conservative_rescaling": 0.9999, "max_iterations": 100_000}
    collide = getattr(getattr(ipctk, detector)(**settings), IMPACTS[name][1])
    found = [collide(*start, *end) for start, end in zip(starts, ends, strict=True)]
    theirs = np.array([time if is_hit else np.inf for is_hit, time in found])
    measure = DISTANCES[name][1]
    is_late = times > theirs
    for points in moved(starts, ends, np.minimum(theirs, 1))[is_late]:
        assert measure(*points) > gap**2
    assert np.isfinite(theirs).sum() > 0.2 * count
    assert is_late.mean() < 0.02


@pytest.mark.parametrize("name", IMPACTS)
def test_where_there_is_no_impact_ipctk_sees_the_gap_all_along(name):
    gap = 1e-3
    starts, ends, _meets = paths(name, 7, 100_000)
    keeps = np.isinf(impacts(name, starts, ends, gap)) & is_whole(name, starts)
    measure = DISTANCES[name][1]
    assert keeps.sum() > 10_000
    for time in np.linspace(0, 1, 9):
        now = moved(starts[keeps], ends[keeps], time)
        now = now[is_whole(name, now)]
        assert min(measure(*points) for points in now) > (gap * (1 - 1e-6)) ** 2


def five_points(rng, count):
    """An edge and a triangle on lattices of 3 to 9 points a side: whole numbers, whose determinants numpy has exactly."""
    reach = rng.integers(1, 5, (count, 1, 1))
    return np.minimum(np.floor((2 * reach + 1) * rng.random((count, 5, 3))), 2 * reach) - reach


def determinants(a, b, c, d):
    return dot(np.cross(b - a, c - a), d - a)


def meetings(x):
    codes = np.empty(len(x), np.uint8)
    boucle_core.edge_crosses_triangle(x, codes)
    return codes


def test_edges_meet_triangles_as_whole_numbers_say():
    x = five_points(np.random.default_rng(8), COUNT)
    # Eighths far from the origin: other numbers, without roundings.
    codes = meetings(x / 8 + 1024)
    p, q, a, b, c = (x[:, i].astype(np.int64) for i in range(5))
    ends = np.sign([determinants(a, b, c, p), determinants(a, b, c, q)])
    turns = np.sign([determinants(p, q, a, b), determinants(p, q, b, c), determinants(p, q, c, a)])
    is_flat = (ends == 0).all(axis=0)
    is_apart = (ends[0] == ends[1]) | ((turns.min(axis=0) < 0) & (turns.max(axis=0) > 0))
    is_touch = (ends == 0).any(axis=0) | (turns == 0).any(axis=0)
    expected = np.where(is_apart, 0, np.where(is_touch, 1, 2))
    assert np.array_equal(codes[~is_flat], expected[~is_flat])
    # In a plane, by distance: on these lattices it is nothing, or not small.
    x, codes = x[is_flat], codes[is_flat]
    ends = [by_features("point_triangle", x[:, [end, 2, 3, 4]]) for end in (0, 1)]
    borders = [by_features("edge_edge", x[:, [0, 1, *ab]]) for ab in ((2, 3), (3, 4), (4, 2))]
    distance = np.minimum.reduce(ends + borders)
    assert not ((distance > 1e-9) & (distance < 1e-3)).any()
    assert np.array_equal(codes, distance < 1e-6)
    assert min(codes.sum(), (1 - codes).sum()) > 10_000


def test_edges_meet_triangles_where_ipctk_says_so():
    """ipctk counts much in the plane of its triangle as met, and misses some touches: on the rest both must agree."""
    rng = np.random.default_rng(9)
    x = np.concatenate([five_points(rng, 500_000), rng.uniform(-1, 1, (500_000, 5, 3))])
    codes = meetings(x)
    theirs = np.array([ipctk.is_edge_intersecting_triangle(*points) for points in x])
    p, q, a, b, c = (x[:, i] for i in range(5))
    is_flat = (determinants(a, b, c, p) == 0) & (determinants(a, b, c, q) == 0)
    assert theirs[codes == 2].all()
    assert (codes[theirs & ~is_flat] > 0).all()
    assert (codes == 2).sum() > 50_000


@pytest.mark.parametrize("name", IMPACTS)
def test_wrong_arguments_are_refused(name):
    impact = IMPACTS[name][0]
    points, out = np.zeros((2, 4, 3)), np.empty(2)
    refused = [
        ((points, points[:1], 0.0, out), "ends holds 1 rows; accepted: as many ends as starts, 2"),
        ((points, points, -1.0, out), "gap is -1 m; accepted: numbers from 0"),
        ((points, points, float("nan"), out), "gap is NaN m"),
        ((points.reshape(4, 2, 3), points, 0.0, out), r"starts has the shape \[4, 2, 3\]"),
        ((points + np.nan, points, 0.0, out), "starts holds NaN; accepted: finite numbers"),
        ((points, points, 0.0, out[:1]), r"out has the shape \[1\]; accepted: \(2,\)"),
        ((points, points, 0.0, np.empty(2, np.float32)), "accepted: float64"),
    ]
    for arguments, match in refused:
        with pytest.raises(boucle_core.SceneError, match=match):
            impact(*arguments)
