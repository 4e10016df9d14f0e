from boucle_addon.core import obj_file


def test_vertices_keep_their_order_and_faces_count_from_one(tmp_path):
    path = tmp_path / "a.obj"
    obj_file.write(str(path), "My\ncloth", [0, 0, 0.1, 1, 0, 0, 0, 1, 0], [(0, 1, 2)])
    assert path.read_text() == "o My cloth\nv 0 0 0.1\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
