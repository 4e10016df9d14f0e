import os

from boucle_addon.core import cache_paths


def test_a_saved_file_keeps_its_caches_beside_it_under_its_own_name():
    folder = cache_paths.own_folder("/shots/s01.final.blend", "/tmp/session")
    assert folder == os.path.join("/shots", "boucle_cache", "s01.final")
    path = os.path.join(folder, "abc.pc2")
    relative = cache_paths.relative_to_blend(path, "/shots/s01.final.blend")
    assert relative == "//boucle_cache/s01.final/abc.pc2"
    assert cache_paths.is_within(path, folder)
    assert not cache_paths.is_within(path, "/shots")


def test_an_unsaved_file_keeps_them_in_the_session():
    folder = cache_paths.own_folder("", "/tmp/session")
    assert folder == os.path.join("/tmp/session", "boucle_cache")
    assert cache_paths.relative_to_blend("/tmp/session/a.pc2", "") == "/tmp/session/a.pc2"


def test_the_files_of_a_bake_lie_together():
    files = cache_paths.files_of("/c/a.b.pc2")
    assert files == (
        "/c/a.b.pc2", "/c/a.b.json", "/c/a.b.checkpoint", "/c/a.b.strain", "/c/a.b.tension",
        "/c/a.b.contact", "/c/a.b.intersection", "/c/a.b.force", "/c/a.b.tear",
    )  # fmt: skip
    assert files.previous.pc2 == "/c/a.b.previous.pc2"


def test_a_live_file_is_known_by_its_folder_on_every_system():
    assert cache_paths.is_live(cache_paths.live_file("/tmp/session", 7))
    assert cache_paths.is_live("C:\\Temp\\blender_x\\boucle\\boucle_live\\7.pc2")
    assert not cache_paths.is_live("//boucle_cache/my_boucle_live_shot/7.pc2")
    assert not cache_paths.is_live("")


def test_what_names_or_holds_files_of_ours_is_known():
    assert cache_paths.is_identity("0123456789abcdef0123456789abcdef")
    for text in (
        "",
        "../" * 11 + "etc",
        "0123456789ABCDEF0123456789ABCDEF",
        "0" * 31,
        "0" * 32 + "\n",
    ):
        assert not cache_paths.is_identity(text)
    assert cache_paths.is_ours("/shots/boucle_cache/s01/a.take-1.pc2")
    for path in ("/shots/a.pc2", "/shots/boucle_cache", "/shots/boucle_cache/../a.pc2"):
        assert not cache_paths.is_ours(path)
