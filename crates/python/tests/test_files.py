"""Files: read, bent like on the command line, and saved with their whole content."""

import errno
import json
import os
import subprocess

import numpy as np
import pytest

import pliant
from conftest import ROOT

ASSETS = ROOT / "assets"
EDIT = json.loads((ASSETS / "creature.edit.json").read_text())


def arguments(edit):
    """An edit's members for `bind`, and its transforms for `step`."""
    members = {name: member for name, member in edit.items() if name not in ("version", "handles")}
    handles = {handle["name"]: {k: v for k, v in handle.items() if k not in ("name", "transform")} for handle in edit["handles"]}
    return {**members, "handles": handles}, {handle["name"]: handle.get("transform", {}) for handle in edit["handles"]}


def applied(program, mesh, edit, folder, extension):
    """The output of `pliant apply` for an edit."""
    (folder / "edit.json").write_text(json.dumps(edit))
    output = folder / f"applied{extension}"
    command = [program, "apply", mesh, "--edit", folder / "edit.json", "--output", output]
    subprocess.run([str(word) for word in command], check=True, capture_output=True)
    return output


@pytest.mark.parametrize("method", ["bilaplacian", "arap", "primo", "poisson", "rbf"])
def test_bending_a_file_gives_the_command_line_s_bytes(program, tmp_path, method):
    edit = {**EDIT, "method": {"name": method}}
    expected = applied(program, ASSETS / "creature.glb", edit, tmp_path, ".glb")
    mesh = pliant.load(ASSETS / "creature.glb")
    members, transforms = arguments(edit)
    bent = mesh.bind(**members).step(transforms)
    pliant.save(tmp_path / "saved.glb", mesh, bent)
    assert (tmp_path / "saved.glb").read_bytes() == expected.read_bytes()


def test_arrays_bend_as_the_file_does_to_the_bit():
    mesh = pliant.load(ASSETS / "creature.glb")
    members, transforms = arguments(EDIT)
    by_file = mesh.bind(**members).step(transforms)
    by_arrays = pliant.bind(mesh.vertices, mesh.faces, **members).step(transforms)
    assert np.array_equal(mesh.file_vertices, np.arange(len(mesh.vertices)))
    assert np.array_equal(by_file, by_arrays)


def test_an_unmoved_mesh_keeps_its_bytes_and_a_moved_one_its_other_content(tmp_path):
    mesh = pliant.load(ASSETS / "creature.glb")
    original = (ASSETS / "creature.glb").read_bytes()
    for vertices in (None, mesh.vertices, mesh.vertices.astype(np.float32)):
        assert pliant.save(tmp_path / "same.glb", mesh, vertices) == []
        assert (tmp_path / "same.glb").read_bytes() == original
    moved = mesh.vertices
    moved[7] += [0.1, 0, 0]
    pliant.save(tmp_path / "moved.glb", mesh, moved)
    again = pliant.load(tmp_path / "moved.glb")
    assert np.array_equal(again.faces, mesh.faces)
    assert np.abs(again.vertices - moved).max() < 1e-6
    assert np.array_equal(np.delete(again.vertices, 7, 0), np.delete(mesh.vertices, 7, 0))


@pytest.mark.parametrize("extension", [".obj", ".ply", ".stl", ".off", ".gltf"])
def test_other_formats_are_written_and_read(tmp_path, extension):
    mesh = pliant.load(ASSETS / "creature.glb")
    pliant.save(tmp_path / f"mesh{extension}", mesh)
    again = pliant.load(os.fspath(tmp_path / f"mesh{extension}"))
    assert len(again.faces) == len(mesh.faces)
    corners = mesh.vertices[mesh.faces]
    assert np.abs(again.vertices[again.faces] - corners).max() < 1e-6


def test_files_that_are_none_are_refused_and_nothing_is_replaced(tmp_path):
    with pytest.raises(FileNotFoundError, match="no such file") as missing:
        pliant.load(tmp_path / "none.glb")
    assert missing.value.filename == os.fspath(tmp_path / "none.glb")
    assert missing.value.errno == errno.ENOENT
    with pytest.raises(IsADirectoryError):
        (tmp_path / "folder.glb").mkdir()
        pliant.load(tmp_path / "folder.glb")
    (tmp_path / "folder.glb").rmdir()
    (tmp_path / "broken.glb").write_bytes(b"nothing")
    with pytest.raises(ValueError, match="broken.glb"):
        pliant.load(tmp_path / "broken.glb")
    with pytest.raises(ValueError, match="xyz"):
        pliant.load(tmp_path / "mesh.xyz")
    mesh = pliant.load(ASSETS / "creature.glb")
    kept = tmp_path / "kept.glb"
    kept.write_bytes(b"kept")
    for wrong, said in [
        (mesh.vertices[:5], "5 rows, but the mesh has"),
        (np.full_like(mesh.vertices, np.nan), "vertex 0 .*single precision"),
        (np.full_like(mesh.vertices, 1e300), "vertex 0 .*single precision"),
    ]:
        with pytest.raises(ValueError, match=said):
            pliant.save(kept, mesh, wrong)
        assert kept.read_bytes() == b"kept"
    with pytest.raises(FileNotFoundError, match="no such file or folder"):
        pliant.save(tmp_path / "no" / "folder.glb", mesh)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["broken.glb", "kept.glb"]


def test_the_first_page_s_program_runs(tmp_path, monkeypatch):
    page = (ROOT / "crates/python/README.md").read_text()
    program = page.split("```python\n")[1].split("```")[0]
    (tmp_path / "scan.glb").write_bytes((ASSETS / "creature.glb").read_bytes())
    monkeypatch.chdir(tmp_path)
    exec(compile(program, "README.md", "exec"), {})
    rest, bent = pliant.load("scan.glb").vertices, pliant.load("bent.glb").vertices
    assert np.abs(bent - rest).max() > 0.1


def test_findings_are_sentences():
    assert all(finding.endswith(".") for finding in pliant.load(ASSETS / "creature.glb").findings)
    square = pliant.bind([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]], handles=[[0]])
    assert any("hole" in finding for finding in square.findings)
