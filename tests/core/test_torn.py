"""The layout of torn caches: its file, the cache in another layout and back, and what is refused."""

import hashlib
import os
from array import array
from pathlib import Path

import pytest
from boucle_addon.core import pc2, points, torn
from boucle_addon.core.refusal import Refusal
from boucle_addon.core.torn import Layout

# Three quads in a row: vertices 0 1 2 3 below, 4 5 6 7 above; the edge from 1 to 5 tears.
CORNERS = array("i", [0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6])
FULL = Layout(8, 12, array("i", [0, 8, 9, 4, 1, 10, 11, 5, 2, 3, 7, 6]), None)
WHOLE = Layout(8, 8, CORNERS, array("i"))
TORN = Layout(8, 10, array("i", [0, 1, 5, 4, 8, 2, 6, 9, 2, 3, 7, 6]), array("i", [1, 5]), "a1b2")


@pytest.fixture(params=["numpy", "array"], autouse=True)
def arrays(request, monkeypatch):
    if request.param == "array":
        monkeypatch.setattr(points, "numpy_module", lambda: None)


def cache(path, layout, samples):
    writer = pc2.Writer.create(str(path), layout.point_count, 4)
    for vertices in samples:
        writer.append(torn.of_vertices(array("f", vertices), layout, CORNERS))
    writer.close()


def lists(path):
    count = pc2.read_header(str(path)).sample_count
    return [list(pc2.read_sample(str(path), index)) for index in range(count)]


REST = [float(k) for k in range(24)]


def test_corners_go_to_points_and_back():
    corners = array("f", [float(k) for k in range(36)])
    assert list(FULL.spread(FULL.gather(corners))) == list(corners)
    assert list(torn.of_vertices(array("f", REST), WHOLE, CORNERS)) == REST
    assert list(torn.of_vertices(array("f", REST), FULL, CORNERS))[:24] == REST
    assert not FULL.is_whole and not TORN.is_whole and WHOLE.is_whole


def test_a_layout_comes_back_from_its_file(tmp_path):
    path = str(tmp_path / "a.tear")
    assert torn.read(path) is None
    for layout in (FULL, WHOLE, TORN):
        torn.write(path, layout)
        found = torn.read(path)
        assert found[:2] == layout[:2]
        assert list(found.points) == list(layout.points)
        assert (found.edges is None) == (layout.edges is None)
        assert list(found.edges if found.edges is not None else ()) == list(layout.edges or ())
        assert found.mesh == layout.mesh
    for damaged in (
        b"",
        b"BOUCLE TEAR 2\n",
        b"BOUCLE TEAR 2\n{}\n",
        b"x" * 300,
        Path(path).read_bytes()[:-1],
        Path(path).read_bytes() * 2 + b"x",
        Path(path).read_bytes().replace(b'"points": 10', b'"points": 11'),
    ):
        (tmp_path / "b.tear").write_bytes(damaged)
        with pytest.raises(Refusal, match=r"b\.tear\" is damaged"):
            torn.read(str(tmp_path / "b.tear"))


def test_files_of_version_1_are_read_and_later_ones_named(tmp_path):
    path = tmp_path / "a.tear"
    head = b'BOUCLE TEAR 1\n{"vertices": 8, "points": 10, "corners": 12, "edges": 1}\n'
    block = head + TORN.points.tobytes() + TORN.edges.tobytes()
    path.write_bytes(block + hashlib.blake2b(block, digest_size=16).digest())
    found = torn.read(str(path))
    assert (found.vertex_count, found.point_count, found.mesh) == (8, 10, "")
    assert (list(found.points), list(found.edges)) == (list(TORN.points), [1, 5])
    path.write_bytes(b"BOUCLE TEAR 3\n{}\nsomething else")
    with pytest.raises(Refusal, match="is of a later version of Boucle"):
        torn.read(str(path))


def test_a_cache_is_arranged_without_loss_and_never_joined_where_it_is_apart(tmp_path):
    path, tear = tmp_path / "a.pc2", str(tmp_path / "a.tear")
    moved = [value + 0.1 for value in REST]
    cache(path, FULL, [REST, moved])
    torn.write(tear, FULL)
    before = lists(path)
    assert torn.arrange(str(path), tear, FULL, WHOLE)
    assert lists(path) == [list(array("f", REST)), list(array("f", moved))]
    assert torn.check(str(path), tear, 8, 12) == ""
    torn.restore_corners(str(path), tear, FULL)
    assert lists(path) == before and torn.read(tear).edges is None
    apart = list(pc2.read_sample(str(path), 1))
    apart[3 * 8] += 1.0  # the first face's corner at vertex 1
    known = [pc2.digest(array("f", positions)) for positions in before]
    writer = pc2.Writer.reopen(str(path), 12, 4, known)
    writer.append(array("f", apart))
    writer.close()
    assert torn.is_apart(array("f", apart), FULL, CORNERS)
    assert not torn.is_apart(array("f", before[1]), FULL, CORNERS)
    assert not torn.arrange(str(path), tear, FULL, WHOLE), "a vertex would be in two places"
    assert len(lists(path)) == 3 and lists(path)[:2] == before
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.pc2", "a.tear"]
    assert not torn.arrange(str(path), tear, FULL, FULL._replace(edges=array("i", [1, 5]))), (
        "nothing gained"
    )
    assert torn.arrange(str(path), tear, FULL, TORN)
    assert pc2.read_header(str(path)).first_frame == 4
    torn.restore_corners(str(path), tear, FULL)
    assert lists(path) == [*before, apart]


class Killed(BaseException):
    """Ends a process at this point."""


def dying(monkeypatch, calls):
    """Die before a file is replaced when so many have been."""
    replace, left = os.replace, [calls]

    def call(*paths):
        left[0] -= 1
        if left[0] < 0:
            raise Killed
        replace(*paths)

    monkeypatch.setattr(os, "replace", call)


def test_a_cache_that_is_killed_while_it_is_arranged_fits_its_layout_at_every_moment(
    tmp_path, monkeypatch
):
    moved = [value + 0.1 for value in REST]
    shown = [list(array("f", REST)), list(array("f", moved))]
    for old, new in ((FULL, WHOLE), (FULL, TORN), (TORN, FULL)):
        for calls in range(4):
            folder = tmp_path / f"{old.point_count} {new.point_count} {calls}"
            folder.mkdir()
            path, tear = folder / "a.pc2", str(folder / "a.tear")
            cache(path, old, [REST, moved])
            torn.write(tear, old)
            with monkeypatch.context() as patch:
                dying(patch, calls)
                try:
                    finished = torn.arrange(str(path), tear, old, new)
                except Killed:
                    finished = False
            assert finished == (calls == 3), "it writes three files"
            assert torn.check(str(path), tear, 8, 12) == ""
            found = torn.read(tear)
            assert list(found.points) == list((new if calls > 1 else old).points)
            corners = [found.spread(array("f", sample)) for sample in lists(path)]
            assert [list(points.scatter(c, CORNERS, 8)) for c in corners] == shown
            torn.restore_corners(str(path), tear, FULL)
            assert list(torn.read(tear).points) == list(FULL.points)
            assert [list(FULL.spread(array("f", sample))) for sample in lists(path)] == [
                list(c) for c in corners
            ]


def test_caches_that_do_not_fit_say_so(tmp_path):
    path, tear = tmp_path / "a.pc2", str(tmp_path / "a.tear")
    assert "is missing" in torn.check(str(path), tear, 8, 12)
    cache(path, FULL, [REST])
    assert "holds 12 vertices and the mesh has 8" in torn.check(str(path), tear, 8, 12)
    torn.write(tear, FULL)
    assert torn.check(str(path), tear, 8, 12) == ""
    assert "is of a torn cloth of 8 vertices and 12 corners" in torn.check(str(path), tear, 7, 12)
    torn.write(tear, WHOLE)
    assert "holds 12 vertices" in torn.check(str(path), tear, 8, 12)
    torn.restore_corners(str(path), tear, FULL)
    assert torn.check(str(path), tear, 8, 12) == "", "what a crash left is mended by Resume"
    cache(path, TORN._replace(point_count=11), [REST])
    with pytest.raises(Refusal, match="of another bake"):
        torn.restore_corners(str(path), tear, FULL)
