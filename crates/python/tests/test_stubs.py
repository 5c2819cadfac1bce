"""The stubs and docstrings match the module."""

import ast
import inspect
from pathlib import Path

import pliant
from conftest import METHODS

STUBS = ast.parse((Path(pliant.__file__).parent / "__init__.pyi").read_text())


def defined(body):
    return {node.name: node for node in body if isinstance(node, (ast.FunctionDef, ast.ClassDef))}


def parameters(node):
    arguments = node.args
    return [own.arg for own in arguments.posonlyargs + arguments.args + arguments.kwonlyargs]


def test_every_function_and_member_is_in_the_stubs_with_its_parameters():
    stubs = defined(STUBS.body)
    for name in pliant.__all__:
        found = getattr(pliant, name)
        if isinstance(found, type):
            members = {member for member in vars(found) if not member.startswith("__")}
            own = defined(stubs[name].body)
            assert set(own) == members, name
            for member in members:
                assert inspect.getdoc(getattr(found, member)), (name, member)
                if callable(getattr(found, member)):
                    assert parameters(own[member]) == list(inspect.signature(getattr(found, member)).parameters)
        elif callable(found):
            assert parameters(stubs[name]) == list(inspect.signature(found).parameters), name
        if name != "__version__":
            assert inspect.getdoc(found), name


def test_the_stubs_name_every_method():
    values = {
        node.targets[0].id: node.value
        for node in STUBS.body
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name)
    }
    listed = [name.value for name in values["MethodName"].slice.elts]
    assert listed == METHODS


def test_methods_tell_their_options():
    arap = pliant.methods()["arap"]
    assert arap["options"]["energy"]["default"] == "spokes-and-rims"
    assert "smooth" in arap["options"]["energy"]["allowed"]
    for method in pliant.methods().values():
        assert method["title"] and method["when_to_use"]
        for option in method["options"].values():
            assert set(option) - {"range", "choices"} == {"default", "first_choice", "allowed", "unit", "help"}
            for value in (option["default"], option["first_choice"]):
                if "range" in option:
                    low, high = option["range"]
                    assert low <= value <= high
                elif "choices" in option:
                    assert value in option["choices"]
                else:
                    assert isinstance(value, bool)
    assert arap["options"]["energy"]["choices"] == ["spokes", "spokes-and-rims", "smooth"]
    assert arap["options"]["energy"]["first_choice"] == "smooth"
