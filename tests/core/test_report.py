import json

import pytest
from boucle_addon.core import report
from boucle_addon.core.report import Report


def row(frame, **values):
    return {
        "frame": frame, "substeps": 3, "iterations": 0, "max_strain": 0.1, "p99_strain": 0.05,
        "intersections": None, "clipped": 0, "contacts": 0, "kinetic_energy": 1.0, "potential_energy": 2.0,
        "hash": "xxh3-64:0", **values,
    }  # fmt: skip


def made(name, rows):
    out = Report("0.1.0", "a.blend", 2, {"name": name, "vertices": 4, "triangles": 2, "springs": 6})
    for values in rows:
        out.add(values, 0.25, f"of {name} at {values['frame']}")
    return out


def test_a_report_is_strict_json_with_the_contracts_keys(tmp_path):
    path = str(tmp_path / "a.json")
    made("A", [row(1), row(2, kinetic_energy=float("inf"))]).write(path)
    text = (tmp_path / "a.json").read_text()
    content = json.loads(text, parse_constant=lambda word: pytest.fail(word))
    assert list(content)[:3] == ["boucle", "scene", "threads"]
    assert content["total_seconds"] == 0.5
    assert content["frames"][1]["kinetic_energy"] is None
    assert content["frames"][0]["seconds"] == 0.25
    assert content["peak_memory_bytes"] > 1_000_000


def test_a_missing_or_damaged_report_is_empty(tmp_path):
    (tmp_path / "a").write_text("[1, 2")
    (tmp_path / "b").write_text("[1, 2]")
    assert [report.read(str(tmp_path / name)) for name in "abc"] == [{}, {}, {}]


def test_reports_of_several_cloths_are_joined_frame_by_frame():
    one = made("A", [row(1, max_strain=0.2), row(2)]).as_dict()
    two = made("B", [row(2, substeps=9, hash="xxh3-64:1"), row(3)]).as_dict()
    assert report.joined([one]) == one
    both = report.joined([one, two])
    assert [cloth["name"] for cloth in both["cloths"]] == ["A", "B"]
    assert [r["frame"] for r in both["frames"]] == [1, 2, 3]
    middle = both["frames"][1]
    assert middle["sample_hashes"] == ["of A at 2", "of B at 2"]
    assert middle["substeps"] == 9 and middle["kinetic_energy"] == 2.0
    assert middle["max_strain"] == 0.1 and middle["intersections"] is None
    assert middle["hash"].startswith("blake2b-64:") and both["frames"][0]["hash"] == "xxh3-64:0"
    assert both["total_seconds"] == 1.0


def test_a_joined_report_counts_the_intersections_of_those_cloths_that_collide():
    one = made("A", [row(1), row(2, intersections=0, contacts=3)]).as_dict()
    two = made("B", [row(1), row(2, intersections=2, contacts=4)]).as_dict()
    three = made("C", [row(1), row(2)]).as_dict()
    rows = report.joined([one, two, three])["frames"]
    assert [r["intersections"] for r in rows] == [None, 2]
    assert [r["contacts"] for r in rows] == [0, 7]


def test_a_joined_report_names_the_worst_edges_of_all_cloths():
    def edges(name, strains):
        return [{"cloth": name, "vertices": [0, 1], "strain": strain} for strain in strains]

    one = made("A", [row(1), row(2, overstretched_count=9, overstretched=edges("A", [0.8, 0.2]))])
    two = made("B", [row(1), row(2, overstretched_count=7, overstretched=edges("B", [0.5] * 7))])
    both = report.joined([made("C", [row(1), row(2)]).as_dict(), one.as_dict(), two.as_dict()])
    first, second = both["frames"]
    assert "overstretched" not in first and "overstretched_count" not in first
    assert second["overstretched_count"] == 16
    strains = [edge["strain"] for edge in second["overstretched"]]
    assert strains == [0.8, *[0.5] * 7]
