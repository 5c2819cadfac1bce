"""The stubs and docstrings match the module."""

import ast
import inspect
import json
import os
import pydoc
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import pliant
from conftest import METHODS, skip

USE = """
import numpy as np

import pliant

vertices, faces = np.zeros((4, 3)), np.array([[0, 1, 2]])
bound = pliant.bind(
    vertices, faces, handles={"tip": [0], "side": {"select": np.array([1, 0, 0, 0]), "soft": 1.0}}, stiffness="rigid"
)
bent = bound.step({"tip": np.zeros((1, 3)), "side": (np.eye(3), [0, 0, 1])})
single = bound.step([np.eye(4)[:3], [0.0, 1.0, 0.0]], out=np.empty((4, 3), np.float32))
mesh = (vertices, faces)
posed = pliant.transfer(mesh, bent, pliant.load("target.glb"), correspondences=[[0, 0]])
stretch = pliant.distortion(mesh, bent)["edge_stretch_mean"] + 1.0
sentences = [one["sentence"] for one in pliant.diff("a.glb", pliant.load("b.glb"))]
outcomes = pliant.compare(mesh, {"tip": np.eye(4)}, methods=["arap", {"name": "rbf"}], handles={"tip": [0]})
ratio = outcomes["arap"].get("detail_error_ratio")
report = pliant.apply("a.glb", edit={"version": 1, "method": {"name": "arap"}}, output="b.glb", method="rbf", frames=3)
pliant.animate("a.glb", edit="keys.json", output="wave-####.obj", fps=30)
pliant.sequence("frames", edit="keys.json", output="bent")
holes: int = pliant.fill("a.glb", output="b.glb", largest=1)["holes_filled"]
pliant.cut("a.glb", output="b.glb", plane=[0, 1, 0, 0.5], keep="both")
pliant.merge("a.glb", "b.glb", joins={"version": 1}, output="c.glb")
pliant.bridge("a.glb", borders=(0, 1), output="b.glb")
faults = pliant.info("a.glb")["findings"]
mirror = pliant.symmetry(mesh)
normal: float = mirror["plane"][0] if mirror else 0.0
coverage = pliant.flow(mesh, dye=[{"select": "all", "color": [1, 0, 0]}], gravity=[0, -9.81, 0], seconds=0.1)[:, 3]
"""

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


def documented(body, of=""):
    """Every docstring of the stubs, by its function's, class's or member's name."""
    for node in body:
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            if ast.get_docstring(node):
                yield of + node.name, ast.get_docstring(node)
            if isinstance(node, ast.ClassDef):
                yield from documented(node.body, f"{node.name}.")


def test_help_shows_the_stub_s_text():
    said = dict(documented(STUBS.body))
    for name, text in said.items():
        found = pliant
        for part in name.split("."):
            found = getattr(found, part, None)
        if found is not None:
            assert inspect.getdoc(found) == text, name
    for name in ("bind", "load", "save", "transfer", "compare", "distortion", "diff", "Mesh.bind", "Bound.step"):
        assert said[name].count(":param") >= 2 or name in ("load", "save", "Mesh.bind"), name
    # Some versions of Python put each parameter on a line of its own.
    shown = " ".join(pydoc.render_doc(pliant.bind, renderer=pydoc.plaintext).split())
    for part in ("vertices, faces, *, handles=None", ":param stiffness:", "shape (n, 3)", "By default {"):
        assert part in shown


@pytest.mark.parametrize("checker", [["mypy", "--strict"], ["pyright", "--pythonpath", sys.executable]])
def test_the_stubs_are_clean_under_type_checkers(checker, tmp_path):
    # An environment's own programs are found without activating it.
    places = os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", "")])
    program = shutil.which(checker[0], path=places)
    if not program:
        skip(f"{checker[0]} is not installed: pip install {checker[0]}")
    (tmp_path / "use.py").write_text(USE)
    (tmp_path / "pyrightconfig.json").write_text(json.dumps({"typeCheckingMode": "strict", "include": ["use.py"]}))
    package = tmp_path / "pliant"
    package.mkdir()
    for name in ("__init__.pyi", "py.typed"):
        shutil.copy(Path(pliant.__file__).parent / name, package)
    checked = subprocess.run([program, *checker[1:], "use.py", "pliant/__init__.pyi"], cwd=tmp_path, capture_output=True, text=True)
    assert checked.returncode == 0, checked.stdout + checked.stderr


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
