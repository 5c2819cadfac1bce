"""The scripts of the manual's page "Coming from libigl and Open3D" run, and give the shapes of the other library."""

import re

import numpy as np
import pytest

import pliant
from conftest import ROOT, bar, needed, write_off

PAGE = ROOT / "docs" / "libigl-and-open3d.md"


def scripts(title):
    """The scripts of a section: the other library's, and Pliant's."""
    section = PAGE.read_text(encoding="utf-8").split(f"\n## {title}\n")[1].split("\n## ")[0]
    return re.findall(r"```python\n(.*?)```", section, re.DOTALL)


def run(script):
    names = {}
    exec(compile(script, PAGE.name, "exec"), names)  # noqa: S102
    return names


@pytest.fixture
def knight(tmp_path, monkeypatch):
    """A bar in place of the knight, with sets of vertices at its base, in its middle and at its top."""
    vertices, faces = bar(18, 24)
    write_off(tmp_path / "decimated-knight.off", vertices * [1.5, 1, 1.5] + [0.5, 0, 0], faces)
    height = vertices[:, 1]
    sets = np.select([height > 0.95, np.abs(height - 0.5) < 0.03, height < 0.05], [0, 1, 3], -1)
    numbers = "\n".join(map(str, sets))
    (tmp_path / "decimated-knight-selection.dmat").write_text(f"1 {len(sets)}\n{numbers}\n")
    monkeypatch.chdir(tmp_path)


def test_libigl_s_tutorial_gives_its_shape(knight):
    needed("igl")
    theirs, own = scripts("libigl, chapter 405")
    own = run(own)
    moved = np.abs(own["U"] - own["V"]).max()
    assert moved > 0.1 and own["bound"].converged
    assert np.array_equal(own["U"][own["b"]], own["targets"](1))
    # libigl stops after its limit of steps: the more it takes, the nearer it comes.
    distances = []
    for limit in (100, 1000):
        one = run(theirs.replace("max_iter = 100", f"max_iter = {limit}"))
        assert np.array_equal(own["V"], one["V"]) and np.array_equal(own["b"], one["b"])
        distances.append(np.abs(own["U"] - one["U"]).max())
    assert distances[1] < 0.25 * distances[0] and distances[1] < 0.03 * moved


@pytest.fixture
def armadillo(tmp_path, monkeypatch):
    """A bar in place of the armadillo: of its size, with a vertex 2490 in its upper half."""
    vertices, faces = bar(48, 60)
    write_off(tmp_path / "bar.off", vertices * 120 - [0, 60, 0], faces)
    pliant.save(tmp_path / "armadillo.ply", pliant.load(tmp_path / "bar.off"))
    monkeypatch.chdir(tmp_path)


def test_open3d_s_tutorial_moves_the_hand_and_holds_the_legs(armadillo, tmp_path):
    own = run(scripts("Open3D")[1])
    assert own["bound"].converged
    assert np.array_equal(own["bent"][own["static_ids"]], own["vertices"][own["static_ids"]])
    assert np.array_equal(own["bent"][2490], own["vertices"][2490] - 40)
    assert np.allclose(pliant.load(tmp_path / "bent.ply").vertices, own["bent"], atol=1e-4)


def test_open3d_s_tutorial_gives_its_shape(armadillo):
    pytest.importorskip("open3d", reason="open3d is not installed: pip install open3d (half a gigabyte)")
    theirs, own = scripts("Open3D")
    bent = run(own)["bent"]
    distances = []
    for limit in (50, 1000):
        one = run(theirs.replace("max_iter=50", f"max_iter={limit}"))
        distances.append(np.abs(bent - np.asarray(one["bent"].vertices)).max())
    assert distances[1] < 0.05 * distances[0] and distances[1] < 0.01 * np.abs(bent - one["vertices"]).max()
