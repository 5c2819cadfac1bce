"""Meshes for the tests, and the command line for comparing results."""

import importlib
import os
import shutil
from pathlib import Path

import numpy as np
import pytest

import pliant

ROOT = Path(__file__).parents[3]

# A build with the workspace's tests has one more method, as an example of adding one.
METHODS = [name for name in pliant.methods() if name != "identity"]


def bar(around=12, along=40):
    """An open cylinder along y, its vertices ring by ring."""
    angle = np.linspace(0, 2 * np.pi, around, endpoint=False)
    ring = np.c_[0.2 * np.cos(angle), np.zeros(around), 0.2 * np.sin(angle)]
    vertices = np.concatenate([ring + [0, y, 0] for y in np.linspace(0, 1, along)])
    a = np.arange((along - 1) * around)
    b = a // around * around + (a + 1) % around
    faces = np.concatenate([np.c_[a, a + around, b], np.c_[b, a + around, b + around]])
    return vertices, faces


def skip(why):
    """Skips a test; where `PLIANT_PYTHON_TESTS` is `required`, as in CI, a test that can't run has failed."""
    if os.environ.get("PLIANT_PYTHON_TESTS") == "required":
        pytest.fail(f"{why}, and PLIANT_PYTHON_TESTS requires every test")
    pytest.skip(why)


def needed(module):
    """A module that a test needs, or its skip."""
    try:
        return importlib.import_module(module)
    except ImportError:
        packages = {"igl": "libigl", "dask.distributed": "dask distributed", "mcp.client.stdio": "mcp"}
        package = "usd-core" if module.startswith("pxr") else packages.get(module, module)
        skip(f"{module} is not installed: pip install {package}")


def write_off(path, vertices, faces):
    """Writes an OFF file."""
    lines = [f"OFF\n{len(vertices)} {len(faces)} 0"]
    lines += [" ".join(map(repr, map(float, row))) for row in vertices]
    lines += [f"3 {a} {b} {c}" for a, b, c in np.asarray(faces).tolist()]
    path.write_text("\n".join(lines) + "\n")


@pytest.fixture
def mesh():
    return bar()


@pytest.fixture
def ends(mesh):
    """The bar's two ends: the fixed vertices and the handle."""
    height = mesh[0][:, 1]
    return {"fixed": np.flatnonzero(height < 0.1), "handles": {"top": np.flatnonzero(height > 0.9)}}


@pytest.fixture(scope="session")
def program():
    """The `pliant` of this build, or the one in the variable PLIANT."""
    named = os.environ.get("PLIANT") or shutil.which("pliant")
    built = [ROOT / "target" / profile / "pliant" for profile in ("release", "debug")]
    found = [Path(path) for path in [named, *built] if path and Path(path).is_file()]
    if not found:
        skip("pliant is not built: cargo build --release --bin pliant")
    return found[0]


def quarter_turn(translation=(0.3, 0.1, 0.0)):
    """A turn by 90 degrees about z, and a move."""
    matrix = np.eye(4)
    matrix[:2, :2] = [[0, -1], [1, 0]]
    matrix[:3, 3] = translation
    return matrix
