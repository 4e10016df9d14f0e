"""No label leaks: whatever the interface says has a French translation, and no translation is left over."""

import re

PLACEHOLDER = re.compile(r"\{[^}]*\}|%[sdifg]")
UNIT = re.compile(r"\((?:N/m|N·s/m|kg/m²|kg/m³|kg|m/s²|m/s|m|s|N|Pa|N/m²|W|°|rad)\)")


def literals(folder):
    """Texts that the sources hand to Blender: `text=` of a layout, and what is marked by a call of pgettext."""
    import ast
    import os

    for place, _, names in os.walk(folder):
        for name in names:
            if not name.endswith(".py"):
                continue
            with open(os.path.join(place, name), encoding="utf-8") as file:
                tree = ast.parse(file.read())
            for call in ast.walk(tree):
                if not isinstance(call, ast.Call):
                    continue
                marked = getattr(call.func, "id", "").startswith("pgettext")
                values = [k.value for k in call.keywords if k.arg == "text"]
                for value in [*values, *(call.args[:1] if marked else [])]:
                    if isinstance(value, ast.IfExp):
                        yield from ((one, name) for one in (value.body, value.orelse))
                    else:
                        yield value, name


def texts_of(rna, places):
    """Names, tooltips and choices of the properties of a class, each with the place where it is declared."""
    for prop in rna.properties:
        place = places.get(prop.identifier)
        if place and not prop.is_hidden:
            items = getattr(prop, "enum_items_static", ())
            for text in (prop.name, prop.description, *(i.name for i in items)):
                yield text, place
            yield from ((item.description, place) for item in items)


def collect():
    import ast
    import os
    import sys

    import bpy
    from cloths import addon

    found = {}

    def add(text, place):
        if text.strip():
            found.setdefault(text, place)

    for kind in sys.modules["bl_ext.user_default.boucle"]._CLASSES:
        name = kind.__name__
        stem = kind.__module__.rpartition(".")[2]
        ours = [one for one in kind.__mro__ if one.__module__.startswith("bl_ext")]
        own = {
            key: one.__module__.rpartition(".")[2]
            for one in ours
            for key in vars(one).get("__annotations__", {})
        }
        rna = kind.bl_rna
        if name.startswith("BOUCLE_OT_"):
            rna = getattr(bpy.ops.boucle, name.removeprefix("BOUCLE_OT_")).get_rna_type()
            add(rna.description, stem)
        if hasattr(kind, "bl_label"):
            add(kind.bl_label, stem)
            add(getattr(kind, "bl_description", ""), stem)
        for text, place in texts_of(rna, own):
            add(text, place)
    for text, place in texts_of(bpy.types.Object.bl_rna, {"boucle": "cloth"}):
        add(text, place)
    package = os.path.dirname(addon("native").__file__)
    for value, place in literals(package):
        if isinstance(value, ast.Constant) and isinstance(value.value, str):
            add(value.value, place)
    for row in addon("bridge.presets").shipped():
        add(row.group, "fabrics")
        add(row.title, "fabrics")
    translations = addon("translations")
    unknown = {
        prop.translation_context
        for prop in bpy.types.Object.bl_rna.properties["boucle"].fixed_type.properties
    } - set(translations._CONTEXTS)
    assert not unknown, f"nothing is translated in {unknown}"
    said = bpy.app.translations.pgettext("Pin Group")
    return {"found": found, "fr": translations.read("fr"), "said": said}


def pages(root):
    import tomllib

    for path in sorted(root.glob("*.toml")):
        yield from ((key, path.name) for key in tomllib.loads(path.read_text(encoding="utf-8")))


def test_everything_that_is_shown_is_translated(new_blender):
    result = new_blender.run(collect)
    found, french = result["found"], result["fr"]
    missing = {text: place for text, place in found.items() if text not in french}
    lines = "\n".join(f'{quoted(text)} = ""  # {place}' for text, place in missing.items())
    assert not missing, f"add these lines to the files of addon/translations/fr:\n{lines}"
    stale = sorted(set(french) - set(found))
    assert stale == [], "nothing says this any more: remove it from addon/translations/fr"
    for text, translated in french.items():
        assert translated.strip() == translated != "", text
        for pattern in (PLACEHOLDER, UNIT):
            assert sorted(pattern.findall(text)) == sorted(pattern.findall(translated)), text
        assert text.endswith(".") == translated.endswith("."), text
    assert result["said"] in {"Pin Group", french["Pin Group"]}


def quoted(text):
    import json

    return json.dumps(text, ensure_ascii=False)


def test_no_text_is_translated_in_two_places():
    from pathlib import Path

    root = Path(__file__).resolve().parents[2] / "addon" / "translations" / "fr"
    places = {}
    for text, name in pages(root):
        places.setdefault(text, []).append(name)
    assert {text: names for text, names in places.items() if len(names) > 1} == {}
