"""USDZ as Pixar's own library reads it, with its validators and its checks for phones."""

import json

import numpy as np

import pliant
from conftest import ROOT, needed
from test_file_commands import BEND

CREATURE = ROOT / "assets" / "creature.glb"


def written(tmp_path, name, edit):
    """The creature bent by an edit, as a file with this name."""
    pliant.apply(CREATURE, edit=edit, output=tmp_path / name)
    return tmp_path / name


def test_pixar_s_library_finds_no_fault_and_the_same_shape(tmp_path):
    usd = needed("pxr.Usd")
    validation = needed("pxr.UsdValidation")
    from pxr import UsdGeom

    edit = json.loads((ROOT / "assets" / "creature.edit.json").read_text())
    stage = usd.Stage.Open(str(written(tmp_path, "bent.usdz", edit)))
    validators = validation.ValidationRegistry().GetOrLoadAllValidators()
    # The package for Python has no definitions of shaders for this one.
    validators = [each for each in validators if "ShaderSdr" not in each.GetMetadata().name]
    assert len(validators) > 20
    faults = validation.ValidationContext(validators).Validate(stage)
    assert [fault.GetMessage() for fault in faults] == []

    meshes = [UsdGeom.Mesh(prim) for prim in stage.Traverse() if prim.IsA(UsdGeom.Mesh)]
    points, faces = meshes[0].GetPointsAttr().Get(), meshes[0].GetFaceVertexIndicesAttr().Get()
    assert len(meshes) == 1
    own = pliant.load(written(tmp_path, "bent.glb", edit))
    assert np.array_equal(np.array(points), own.vertices.astype(np.float32))
    assert np.array_equal(np.array(faces).reshape(-1, 3), own.faces)


def test_a_file_of_pixar_s_library_is_read_and_bent(tmp_path):
    usd = needed("pxr.Usd")
    from pxr import Gf, Sdf, UsdGeom

    stage = usd.Stage.CreateNew(str(tmp_path / "bar.usda"))
    root = UsdGeom.Xform.Define(stage, "/Root")
    root.AddTranslateOp().Set(Gf.Vec3d(1, 2, 3))
    root.AddRotateXYZOp().Set(Gf.Vec3f(10, 20, 30))
    mesh = UsdGeom.Mesh.Define(stage, "/Root/Bar")
    rows = np.arange(24)
    points = np.c_[rows % 2, rows // 2, np.zeros(24)]
    mesh.CreatePointsAttr([tuple(point) for point in points.tolist()])
    mesh.CreateFaceVertexCountsAttr([4] * 11)
    quads = [[2 * row, 2 * row + 1, 2 * row + 3, 2 * row + 2] for row in range(11)]
    mesh.CreateFaceVertexIndicesAttr([corner for quad in quads for corner in quad])
    matrix = np.array(mesh.ComputeLocalToWorldTransform(0))
    stage.GetRootLayer().Save()
    with Sdf.ZipFileWriter.CreateNew(str(tmp_path / "bar.usdz")) as archive:
        archive.AddFile(str(tmp_path / "bar.usda"), "bar.usda")

    loaded = pliant.load(tmp_path / "bar.usdz")
    assert np.allclose(loaded.vertices, points @ matrix[:3, :3] + matrix[3, :3], atol=1e-12)

    edit = {**BEND, "handles": [{**BEND["handles"][0], "transform": {"translation": [0.3, 0, 0]}}]}
    pliant.apply(tmp_path / "bar.usdz", edit=edit, output=tmp_path / "bent.usdz")
    stage = usd.Stage.Open(str(tmp_path / "bent.usdz"))     # a prim lives no longer than its stage
    bent = stage.GetPrimAtPath("/Root/Bar")
    shown = np.array(bent.GetAttribute("points").Get()) @ matrix[:3, :3] + matrix[3, :3]
    assert np.allclose(shown, pliant.load(tmp_path / "bent.usdz").vertices, atol=1e-6)
    assert not np.allclose(shown, loaded.vertices, atol=0.1)
