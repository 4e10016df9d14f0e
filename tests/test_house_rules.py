"""The rules of this house, read from its own files: who imports whom, sizes, names, units, determinism."""

import ast
import json
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]

ALLOWED_AT_TOP = {
    "Cargo.toml", "rust", "addon", "tests", "scripts", "README.md",
    # what tools and hosts insist on
    "Cargo.lock", "CHANGELOG.md", "LICENSE", ".ci", ".gitignore", "pyproject.toml", "rustfmt.toml",
}  # fmt: skip

CRATES = {
    "boucle-geometry": set(),
    "boucle-solver": {"boucle-geometry"},
    "boucle-scene": {"boucle-geometry", "boucle-solver"},
    "boucle-python": {"boucle-geometry", "boucle-solver", "boucle-scene"},
    "boucle-fuzz": {"boucle-geometry", "boucle-solver", "boucle-scene"},
}
"""Each crate and those of ours that it may use."""

LAYERS = {
    "_identifiers": set(),
    "core": {"_identifiers"},
    "native": {"core"},
    "bridge": {"_identifiers", "core", "native"},
    "properties": {"_identifiers", "bridge"},
    "operators": {"_identifiers", "bridge", "core", "native"},
    "handlers": {"bridge"},
    "panels": {"_identifiers"},
    "preferences": set(),
    "translations": set(),
    "__init__": None,
}
"""Each part of the add-on and the parts that it may import; the whole imports all."""

OUTSIDE = {
    "_identifiers": set(),
    "core": {"numpy"},
    "native": {"boucle_core"},
    "bridge": {"bpy", "bmesh", "blf", "gpu", "mathutils"},
    "properties": {"bpy"},
    "operators": {"bpy", "bmesh", "bpy_extras", "mathutils"},
    "handlers": {"bpy"},
    "panels": {"bpy"},
    "preferences": {"bpy"},
    "translations": {"bpy"},
    "__init__": {"bpy"},
}
"""What each part may import besides the standard library."""

MOST_LINES = 400
MOST_TEST_LINES = 700
"""A test file is a list of true sentences: it may be longer than a module."""

MOST_FUNCTION_LINES = 60
"""Tests may tell a longer story."""

BAD_STEMS = {"utils", "util", "helpers", "helper", "common", "manager", "misc"}

UNSTEADY = {
    "a hash map, whose order changes": (r"\bHashMap\b", "let m: HashMap<u32, f64>;"),
    "a walk over a hash set, whose order changes": (
        r"\bfor [^{;]* in &?(?:mut )?(?:seen|joined|\w*_set)\b|\b(?:seen|joined|\w*_set)\.(?:iter|into_iter|drain)\b",
        "for edge in &seen {",
    ),
    "a parallel sum, whose order changes": (
        r"\bpar_(?:iter|iter_mut|bridge|chunks\w*)\b[^;]*\.(?:sum|reduce|fold|product)\b",
        "let e: f64 = v.par_iter().map(|x| x * x).sum();",
    ),
    "a parallel bridge, which mixes the order": (r"\bpar_bridge\b", "it.par_bridge()"),
    "a fused multiply-add, which not every processor has": (r"\bmul_add\b", "a.mul_add(b, c)"),
    "an atomic number": (
        r"\bAtomic[UI]\w+\b|\bfetch_(?:add|max|min|update)\b",
        "AtomicU64::new(0)",
    ),
}
"""What would make the same input give other bits, each with an example that the pattern must find."""


def tracked():
    """The project's files: those of git, and new ones that git does not ignore."""
    command = ["git", "ls-files", "--cached", "--others", "--exclude-standard"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    return [Path(line) for line in done.stdout.splitlines() if (ROOT / line).is_file()]


def sources(folder, suffix):
    """Paths and texts of all files of a kind below a folder."""
    found = [p for p in tracked() if p.parts[0] == folder and p.suffix == suffix]
    assert found, f"{folder} holds no {suffix} file"
    return [(path, (ROOT / path).read_text(encoding="utf-8")) for path in found]


def imports_of(path, text):
    """The imports of an add-on module: (part of the add-on or None, module outside or None, line)."""
    package = path.relative_to("addon").parts[:-1]
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Import):
            yield from ((None, alias.name.partition(".")[0], node.lineno) for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.level == 0:
            yield None, node.module.partition(".")[0], node.lineno
        elif isinstance(node, ast.ImportFrom):
            base = package[: len(package) + 1 - node.level]
            inside = (*base, *node.module.split(".")) if node.module else base
            parts = [inside[0]] if inside else [alias.name for alias in node.names]
            yield from ((part, None, node.lineno) for part in parts)


def wrong_imports(path, text):
    """What an add-on module imports against the layers, as sentences."""
    part = path.relative_to("addon").parts[0].removesuffix(".py")
    if part not in LAYERS:
        return [f"{path}: no layer is known for {part!r}"]
    wrong = []
    for inside, outside, line in imports_of(path, text):
        allowed = LAYERS[part]
        if inside is not None and allowed is not None and inside not in allowed | {part}:
            wrong.append(f"{path}:{line}: {part} imports {inside}")
        if outside is not None and outside not in sys.stdlib_module_names | OUTSIDE[part]:
            wrong.append(f"{path}:{line}: {part} imports {outside}")
    return wrong


def test_the_top_level_holds_only_what_the_design_allows():
    assert {path.parts[0] for path in tracked()} - ALLOWED_AT_TOP == set()


def test_crates_use_each_other_only_downwards():
    command = ["cargo", "metadata", "--format-version", "1", "--no-deps"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    packages = {package["name"]: package for package in json.loads(done.stdout)["packages"]}
    assert set(packages) == set(CRATES)
    for name, allowed in CRATES.items():
        ours = {d["name"] for d in packages[name]["dependencies"] if d["name"] in CRATES}
        assert ours <= allowed, name


def test_only_the_python_crate_knows_python():
    for path, text in sources("rust", ".toml"):
        if path.parts[1] != "python":
            assert "pyo3" not in text, path


def test_addon_modules_import_only_the_layers_below():
    assert [w for path, text in sources("addon", ".py") for w in wrong_imports(path, text)] == []


@pytest.mark.parametrize(
    ("path", "line"),
    [
        ("addon/core/bake.py", "import bpy"),
        ("addon/core/bake.py", "from ..bridge import slot"),
        ("addon/panels/cache.py", "from ..bridge import cache"),
        ("addon/panels/cache.py", "from .. import native"),
        ("addon/bridge/slot.py", "import boucle_core"),
        ("addon/bridge/slot.py", "import scipy"),
        ("addon/bridge/slot.py", "from addon.core import pc2"),
        ("addon/helpers/slot.py", ""),
    ],
)
def test_a_wrong_import_is_found(path, line):
    assert len(wrong_imports(Path(path), line)) == 1


def test_every_python_file_is_under_ruff():
    import verify

    python = {path for path in tracked() if path.suffix in {".py", ".pyi"}}
    assert ROOT / "rust" / "python" / "boucle_core.pyi" in {ROOT / path for path in python}
    covered = [Path(source) for source in verify.PYTHON_SOURCES]
    assert [p for p in python if not any(p == c or c in p.parents for c in covered)] == []


def test_files_are_short():
    long = {}
    for folder in ("rust", "addon", "scripts", "tests"):
        for path in tracked():
            if path.parts[0] == folder and path.suffix in {".py", ".rs"}:
                is_test = folder == "tests" or "tests" in path.parts or path.stem == "tests"
                count = len((ROOT / path).read_text(encoding="utf-8").splitlines())
                if count > (MOST_TEST_LINES if is_test else MOST_LINES):
                    long[str(path)] = count
    assert long == {}


def python_functions(text):
    """Name and lines of every function."""
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            yield node.name, node.end_lineno - node.lineno + 1


def rust_functions(text):
    """Name and lines of every function with a body, whose closing brace stands below its `fn`."""
    head = r"^( *)(?:pub(?:\([^)]*\))? )?(?:const )?fn (\w+)(?:[^;{]|; [^;\])]*\])*\{\n"
    for found in re.finditer(head + r"(?:.*\n)*?\1\}$", text, re.MULTILINE):
        yield found[2], found[0].count("\n") + 1


def test_functions_are_short():
    long = {}
    for suffix, functions in ((".py", python_functions), (".rs", rust_functions)):
        for folder in ("rust",) if suffix == ".rs" else ("addon", "scripts"):
            for path, text in sources(folder, suffix):
                is_test = "tests" in path.parts or path.stem == "tests"
                for name, count in () if is_test else functions(text):
                    if count > MOST_FUNCTION_LINES:
                        long[f"{path}: {name}"] = count
    assert long == {}


@pytest.mark.parametrize(
    ("functions", "text"),
    [
        (python_functions, "def long():\n" + "    pass\n" * 60),
        (rust_functions, "    pub(crate) fn long() {\n" + "        f();\n" * 59 + "    }\n"),
    ],
)
def test_a_long_function_is_found(functions, text):
    assert list(functions(text)) == [("long", MOST_FUNCTION_LINES + 1)]


def test_names_say_what_a_file_is_about():
    parts = [(path, part) for path in tracked() for part in (*path.parent.parts, path.stem)]
    assert [str(path) for path, part in parts if part.lower() in BAD_STEMS] == []


def swallowed(text):
    """Lines of handlers that catch everything without a type, or drop what they catch."""
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.ExceptHandler):
            says_nothing = all(isinstance(part, ast.Pass) for part in node.body)
            if node.type is None or says_nothing:
                yield node.lineno


def test_no_exception_is_swallowed():
    found = {
        f"{path}:{line}"
        for folder in ("addon", "scripts", "tests")
        for path, text in sources(folder, ".py")
        for line in swallowed(text)
    }
    assert found == set()


@pytest.mark.parametrize("clause", ["except:\n    raise", "except OSError:\n    pass"])
def test_a_swallowed_exception_is_found(clause):
    assert list(swallowed(f"try:\n    f()\n{clause}")) == [3]


def without_tests(text):
    """Rust code without comments and without its test module."""
    return re.sub(r"//[^\n]*", "", text.partition("#[cfg(test)]")[0])


@pytest.mark.parametrize("what", UNSTEADY)
def test_the_physics_has_one_order(what):
    pattern, example = UNSTEADY[what]
    assert re.search(pattern, example), "the pattern does not find its own example"
    found = []
    for path, text in sources("rust", ".rs"):
        if path.parts[1] in {"solver", "geometry"} and path.parts[2] == "src":
            match = re.search(pattern, without_tests(text))
            found += [f"{path}: {match[0]!r}"] if match else []
    assert found == []


def properties():
    """Every Blender property that the add-on declares: (place, kind, keyword arguments)."""
    for path, text in sources("addon", ".py"):
        for node in ast.walk(ast.parse(text)):
            call = node.annotation if isinstance(node, ast.AnnAssign) else None
            if isinstance(call, ast.Call) and getattr(call.func, "id", "").endswith("Property"):
                words = {k.arg: ast.unparse(k.value) for k in call.keywords}
                yield f"{path}:{node.target.id}", call.func.id, words, path.parts[1]


def test_every_property_says_what_it_is_and_in_which_unit():
    found = []
    for place, kind, words, _part in properties():
        is_hidden = "HIDDEN" in words.get("options", "") or place.endswith(":uuid")
        if not is_hidden and not ("name" in words and "description" in words):
            found.append(f"{place}: no name or description")
        has_unit = re.search(r"\([^()]+\)|fraction", words.get("description", ""))
        if kind.startswith("Float") and not has_unit:
            found.append(f"{place}: no unit in {words.get('description')}")
    assert found == []


def test_every_setting_can_be_overridden_in_a_linked_file():
    places = [place for place, _kind, _words, part in properties() if part == "properties"]
    assert len(places) > 20
    assert [
        place
        for place, _kind, words, part in properties()
        if part == "properties" and "override" not in words
    ] == []


def test_the_version_is_the_same_everywhere():
    read = {
        name: tomllib.loads((ROOT / name).read_text(encoding="utf-8"))
        for name in ("Cargo.toml", "addon/blender_manifest.toml")
    }
    version = read["Cargo.toml"]["workspace"]["package"]["version"]
    assert read["addon/blender_manifest.toml"]["version"] == version
    import boucle_core

    assert boucle_core.__version__ == version
    changelog = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    assert re.search(rf"^## \[?{re.escape(version)}\b", changelog, re.MULTILINE)
    for path, text in sources("rust", ".toml"):
        if path.name == "Cargo.toml":
            assert "version.workspace = true" in text, path


def test_every_requirement_is_pinned():
    for path in sorted((ROOT / "scripts").glob("requirements*.txt")):
        for line in path.read_text(encoding="utf-8").splitlines():
            assert not line or line.startswith("#") or re.fullmatch(r"[\w-]+==[\w.]+", line), line
    manifest = tomllib.loads((ROOT / "Cargo.toml").read_text(encoding="utf-8"))
    for name, value in manifest["workspace"]["dependencies"].items():
        version = value if isinstance(value, str) else value.get("version", "=")
        assert version.startswith("="), f"{name} {version}"
