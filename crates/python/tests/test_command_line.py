"""Functions with the names and results of the command line's commands."""

import json
import subprocess

import numpy as np
import pytest

import pliant
from conftest import METHODS, ROOT, bar, quarter_turn, skip, write_off

CREATURE = ROOT / "assets" / "creature.glb"


def run(program, *words):
    command = [str(word) for word in (program, *words)]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


@pytest.fixture
def creature(tmp_path):
    """Files of the creature and of the creature with a wave in it."""
    mesh = pliant.load(CREATURE)
    bent = mesh.vertices + 0.1 * np.sin(3 * mesh.vertices[:, ::-1])
    pliant.save(tmp_path / "pose.glb", mesh, bent)
    return mesh, pliant.load(tmp_path / "pose.glb"), tmp_path


def test_transfer_gives_the_command_line_s_bytes(program, creature):
    source, pose, folder = creature
    scaled = folder / "target.glb"
    pliant.save(scaled, source, source.vertices * [1.2, 1, 0.9])
    target = pliant.load(scaled)
    posed = pliant.transfer(source, pose, target)
    pliant.save(folder / "own.glb", target, posed)
    run(program, "transfer", CREATURE, folder / "pose.glb", scaled, "--output", folder / "expected.glb")
    assert (folder / "own.glb").read_bytes() == (folder / "expected.glb").read_bytes()
    pairs = [(mesh.vertices, mesh.faces) for mesh in (source, target)]
    assert np.array_equal(pliant.transfer(pairs[0], pose.vertices, pairs[1]), posed)


def test_a_rigid_pose_is_transferred_rigidly_by_correspondences(mesh):
    vertices, faces = mesh
    fine = bar(24, 60)
    matrix = quarter_turn((0, 0, 0))
    pose = vertices @ matrix[:3, :3].T
    pairs = np.c_[np.zeros(40, int), np.arange(40) * 70]
    posed = pliant.transfer(mesh, pose, fine, correspondences=pairs)
    expected = fine[0] @ matrix[:3, :3].T
    assert np.abs((posed - posed.mean(0)) - (expected - expected.mean(0))).max() < 1e-6
    for wrong, said in [
        ([[0, 10**6]], r"correspondences\[0\] is \[0, 1000000\], but source has"),
        ([[0, 1], [1, 1]], r"correspondences\[1\] names target's triangle 1 again"),
        ([[0, 1, 2]], r"shape \[1, 3\]"),
        ([], "correspondences is empty"),
        (None, "give correspondences"),
    ]:
        with pytest.raises(ValueError, match=said):
            pliant.transfer(mesh, pose, fine, correspondences=wrong)
    with pytest.raises(ValueError, match="pose has 479 rows, but source has 480"):
        pliant.transfer(mesh, pose[1:], mesh)
    with pytest.raises(ValueError, match="target is not a mesh: give a result of `load`"):
        pliant.transfer(mesh, pose, vertices)


def test_diff_tells_what_the_command_line_tells(program, creature):
    source, pose, folder = creature
    told = pliant.diff(CREATURE, folder / "pose.glb")
    assert told == json.loads(run(program, "diff", CREATURE, folder / "pose.glb", "--json"))["differences"]
    assert told and all(one["place"] and one["sentence"] for one in told)
    assert pliant.diff(source, pose) == told
    assert pliant.diff(source, str(CREATURE)) == []
    with pytest.raises(FileNotFoundError):
        pliant.diff(CREATURE, folder / "none.glb")


def test_distortion_is_the_report_s(program, tmp_path):
    edit = json.loads((ROOT / "assets" / "creature.edit.json").read_text())
    paths = {name: tmp_path / name for name in ("edit.json", "bent.glb", "report.json")}
    paths["edit.json"].write_text(json.dumps({**edit, "method": {"name": "poisson"}}))
    run(program, "apply", CREATURE, "--edit", paths["edit.json"], "--output", paths["bent.glb"], "--report", paths["report.json"])
    expected = json.loads(paths["report.json"].read_text())["distortion"]
    mesh = pliant.load(CREATURE)
    found = pliant.distortion(mesh, pliant.load(paths["bent.glb"]).vertices)
    assert list(found) == list(expected)
    # The saved positions are rounded to single precision.
    assert np.allclose(list(found.values()), list(expected.values()), rtol=1e-4)


def test_a_rigid_motion_distorts_nothing_and_a_stretch_does(mesh):
    vertices, _ = mesh
    matrix = quarter_turn()
    rigid = pliant.distortion(mesh, vertices @ matrix[:3, :3].T + matrix[:3, 3])
    assert rigid["flipped_faces"] == 0
    assert np.allclose([rigid["edge_stretch_mean"], rigid["edge_stretch_max"], rigid["volume_ratio"]], 1)
    doubled = pliant.distortion(mesh, 2 * vertices)
    assert np.allclose([doubled["edge_stretch_mean"], doubled["volume_ratio"]], [2, 8])
    with pytest.raises(ValueError, match="bent has 479 rows, but the mesh has 480"):
        pliant.distortion(mesh, vertices[1:])
    with pytest.raises(ValueError, match=r"bent\[3\] is not finite"):
        pliant.distortion(mesh, np.where(np.arange(480)[:, None] == 3, np.nan, vertices))


def test_compare_bends_by_every_method_as_bind_does(mesh, ends):
    outcomes = pliant.compare(mesh, quarter_turn(), **ends)
    assert [name for name in outcomes if name != "identity"] == METHODS
    for name in ("arap", "rbf", "poisson"):
        bound = pliant.bind(*mesh, **ends, method=name)
        own = outcomes[name]
        assert np.array_equal(own["vertices"], bound.step(quarter_turn()))
        assert (own["energy"], own["converged"], own["method"]) == (bound.energy, bound.converged, name)
        assert own["distortion"] == pliant.distortion(mesh, own["vertices"])
    assert min(own["detail_error_ratio"] for own in outcomes.values()) == 1


def test_compare_takes_labels_and_tells_refusals(mesh, ends):
    vertices, top = mesh[0], ends["handles"]["top"]
    methods = {"smooth": {"name": "arap", "energy": "smooth"}, "plain": "arap", "space": "mls"}
    outcomes = pliant.compare(mesh, {"top": vertices[top] + 0.1}, methods=methods, **ends)
    assert list(outcomes) == ["smooth", "plain", "space"]
    assert "takes no positions" in outcomes["space"]["refused"] and len(outcomes["space"]) == 1
    assert np.array_equal(outcomes["smooth"]["vertices"][top], vertices[top] + 0.1)
    with pytest.raises(ValueError, match="methods names arap twice"):
        pliant.compare(mesh, np.eye(4), methods=["arap", {"name": "arap", "energy": "smooth"}], **ends)


def test_compare_has_the_command_line_s_figures(program, tmp_path):
    edit = json.loads((ROOT / "assets" / "creature.edit.json").read_text())
    (tmp_path / "edit.json").write_text(json.dumps(edit))
    sheet, report = tmp_path / "sheet.png", tmp_path / "report.json"
    words = ["compare", CREATURE, "--edit", tmp_path / "edit.json", "--methods", "poisson,mls", "--report", report]
    try:
        run(program, *words, "--output", sheet, "--size", "200x200")
    except subprocess.CalledProcessError as error:
        skip(f"no picture can be drawn here: {error.stderr}")
    expected = json.loads(report.read_text())["methods"]
    members = {name: own for name, own in edit.items() if name not in ("version", "handles", "method")}
    handles = {own["name"]: {k: v for k, v in own.items() if k not in ("name", "transform")} for own in edit["handles"]}
    transforms = {own["name"]: own.get("transform", {}) for own in edit["handles"]}
    found = pliant.compare(pliant.load(CREATURE), transforms, methods=["poisson", "mls"], handles=handles, **members)
    for name, own in found.items():
        assert np.isclose(own["detail_error"], expected[name]["detail_error"])
        assert np.isclose(own["detail_error_ratio"], expected[name]["detail_error_ratio"])
        for figure, value in own["distortion"].items():
            assert np.isclose(value, expected[name]["distortion"][figure])


def test_flow_gives_the_command_line_s_colours(program, tmp_path):
    vertices, faces = bar()
    write_off(tmp_path / "bar.off", vertices, faces)
    members = {
        "dye": [{"select": {"slab": {"axis": "longest", "from": 0.6, "to": 1}}, "color": [0, 0, 1]}],
        "velocity": [{"select": "all", "spin": {"axis": [0, 0, 1], "rate": 2}}],
        "gravity": [0.0, 0.0, -1.0],
        "step": 0.05,
        "seconds": 0.5,
    }
    (tmp_path / "flow.json").write_text(json.dumps({"version": 1, **members}))
    run(program, "flow", tmp_path / "bar.off", "--flow", tmp_path / "flow.json", "--output", tmp_path / "out.glb")
    dyes = pliant.flow(pliant.load(tmp_path / "bar.off"), **members)
    assert dyes.shape == (len(vertices), 4) and dyes.min() >= 0 and dyes.max() <= 1
    red, coverage = dyes[:, 0], dyes[:, 3]
    assert np.all(red == 0) and 0 < coverage.mean() < 1
    assert np.array_equal(pliant.flow((vertices, faces), **members), dyes)
    # Blue over white: red in the file is the clear share.
    glb = (tmp_path / "out.glb").read_bytes()
    length = int.from_bytes(glb[12:16], "little")
    root = json.loads(glb[20 : 20 + length])
    accessor = root["accessors"][root["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"]]
    view = root["bufferViews"][accessor["bufferView"]]
    start = 28 + length + view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
    stored = np.frombuffer(glb, np.uint16, 4 * accessor["count"], start).reshape(-1, 4)
    assert np.array_equal(np.sort(stored[:, 0]), np.sort(np.round(65535 * (1 - coverage)).astype(int)))
    with pytest.raises(ValueError, match="dye"):
        pliant.flow((vertices, faces), dye=[{"select": "none", "color": [1, 1, 1]}])


def test_symmetry_finds_the_plane_of_a_mirrored_shape(mesh):
    vertices, faces = mesh
    # Uneven in y and z, the same on both sides of the plane x = 0.25.
    uneven = np.c_[vertices[:, 0], vertices[:, 1] ** 2, vertices[:, 2] * (1 + vertices[:, 1]) + vertices[:, 1] ** 3]
    found = pliant.symmetry((uneven + [0.25, 0, 0], faces))
    normal, distance = np.array(found["plane"][:3]), found["plane"][3]
    assert np.allclose(np.abs(normal), [1, 0, 0], atol=1e-6) and np.isclose(distance * normal[0], 0.25, atol=1e-6)
    images = found["images"]
    assert np.array_equal(images[images], np.arange(len(vertices)))
    assert np.allclose(uneven[images], uneven * [-1, 1, 1], atol=1e-6)
    assert pliant.symmetry((np.random.default_rng(1).random((90, 3)), np.arange(90).reshape(-1, 3))) is None
    with pytest.raises(ValueError, match="mesh is not a mesh"):
        pliant.symmetry(vertices)


def test_render_gives_the_command_line_s_picture(program, tmp_path):
    bar = ROOT / "assets" / "bar.glb"
    edit = ROOT / "assets" / "bar.edit.json"
    look = {"size": (96, 64), "view": "front", "shading": "regions", "transparent": True}
    try:
        pixels = pliant.render(bar, edit=edit, **look)
    except OSError as error:
        skip(f"pictures ({error})")
    assert pixels.shape == (64, 96, 4) and pixels.dtype == np.uint8
    assert pixels[0, 0, 3] == 0 and pixels[32, 48, 3] == 255
    members = json.loads(edit.read_text())
    assert np.array_equal(pliant.render(bar, edit=members, **look), pixels)
    assert not np.array_equal(pliant.render(bar, **look), pixels)

    own, expected = tmp_path / "own.png", tmp_path / "expected.png"
    assert pliant.render(bar, edit=edit, output=own, **look) is None
    words = ["--size", "96x64", "--view", "front", "--shading", "regions", "--transparent"]
    run(program, "render", bar, "--edit", edit, "--output", expected, *words)
    assert own.read_bytes() == expected.read_bytes()

    around = pliant.render(bar, size="48x32", turntable=2)
    assert around.shape == (2, 32, 48, 4) and not np.array_equal(*around)
    assert pliant.render(bar, size="48x32", turntable=2, output=tmp_path / "turn.png") is None
    assert sorted(path.name for path in tmp_path.glob("turn*")) == ["turn-0001.png", "turn-0002.png"]


def test_render_refuses_what_the_command_line_refuses(tmp_path):
    bar = ROOT / "assets" / "bar.glb"
    for wrong, said in [
        ({"view": "behind"}, "view is \"behind\": give one of front"),
        ({"size": "large"}, "size is large"),
        ({"size": (0, 5)}, "from 1 to 16384"),
        ({"turntable": 1}, "turntable is 1: give a number from 2"),
        ({"output": tmp_path / "bar.jpg"}, "bar.jpg is not a .png"),
        ({"edit": {"version": 1}}, "method"),
        ({"weld": -1.0}, "weld is not a distance"),
    ]:
        with pytest.raises(ValueError, match=said):
            pliant.render(bar, **wrong)
    with pytest.raises(FileNotFoundError):
        pliant.render(tmp_path / "none.glb")
