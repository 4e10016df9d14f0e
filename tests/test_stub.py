"""The stub boucle_core.pyi says of the compiled module what is true."""

import ast
import inspect
from pathlib import Path

import boucle_core
import pytest

STUB = Path(__file__).resolve().parents[1] / "rust" / "python" / "boucle_core.pyi"
TREE = ast.parse(STUB.read_text())

CLASSES = {node.name: node for node in TREE.body if isinstance(node, ast.ClassDef)}
FUNCTIONS = {node.name: node for node in TREE.body if isinstance(node, ast.FunctionDef)}
VARIABLES = {node.target.id for node in TREE.body if isinstance(node, ast.AnnAssign)}


def parameters_of_stub(node):
    """The parameters in order: name, whether by keyword only, whether there is a default."""
    positional = node.args.args
    bare = len(positional) - len(node.args.defaults)
    rows = [(argument.arg, False, index >= bare) for index, argument in enumerate(positional)]
    keywords = zip(node.args.kwonlyargs, node.args.kw_defaults, strict=True)
    rows += [(argument.arg, True, default is not None) for argument, default in keywords]
    return [row for row in rows if row[0] not in ("self", "cls")]


def parameters_of_module(function):
    rows = inspect.signature(function).parameters.values()
    keyword = inspect.Parameter.KEYWORD_ONLY
    return [
        (row.name, row.kind is keyword, row.default is not inspect.Parameter.empty)
        for row in rows
        if row.name != "self"
    ]


def public(names):
    return {name for name in names if not name.startswith("_")}


def test_the_module_has_the_names_of_the_stub_and_no_others():
    # The compiled part lies in the package under its own name.
    have = public(dir(boucle_core)) - {"boucle_core"}
    assert have == public([*CLASSES, *FUNCTIONS, *VARIABLES])
    assert "__version__" in VARIABLES
    assert isinstance(boucle_core.__version__, str)


@pytest.mark.parametrize("name", [name for name in CLASSES if name.endswith("Error")])
def test_exceptions_have_the_bases_and_the_words_of_the_stub(name):
    kind = getattr(boucle_core, name)
    assert [base.__name__ for base in kind.__bases__] == [base.id for base in CLASSES[name].bases]
    assert kind.__module__ == "boucle_core"
    assert kind.__doc__ == ast.get_docstring(CLASSES[name])


def test_the_simulation_has_the_members_of_the_stub_and_no_others():
    members = {node.name: node for node in CLASSES["Simulation"].body if hasattr(node, "name")}
    have = public(vars(boucle_core.Simulation))
    assert have == public(members)
    for name, node in members.items():
        member = getattr(boucle_core.Simulation, name)
        if any(
            isinstance(mark, ast.Name) and mark.id == "property" for mark in node.decorator_list
        ):
            assert inspect.isgetsetdescriptor(member), name
        elif name != "__new__":
            assert parameters_of_module(member) == parameters_of_stub(node), name
    assert parameters_of_module(boucle_core.Simulation) == parameters_of_stub(members["__new__"])
    with pytest.raises(TypeError):
        type("Child", (boucle_core.Simulation,), {})  # final


@pytest.mark.parametrize("name", FUNCTIONS)
def test_functions_take_what_the_stub_says(name):
    function = getattr(boucle_core, name)
    assert parameters_of_module(function) == parameters_of_stub(FUNCTIONS[name])


def test_every_parameter_and_result_of_the_stub_has_a_type():
    for node in ast.walk(TREE):
        if isinstance(node, ast.FunctionDef):
            arguments = [*node.args.args, *node.args.kwonlyargs]
            bare = [row.arg for row in arguments if row.annotation is None]
            assert set(bare) <= {"self", "cls"}, node.name
            assert node.returns is not None, node.name
