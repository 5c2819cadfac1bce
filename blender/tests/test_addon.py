"""The add-on in Blender, without its window: `bpy` from PyPI."""

import json
import os
import shutil
import subprocess
import sys

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")
pliant = pytest.importorskip("pliant")
Vector = pytest.importorskip("mathutils").Vector

from scene import SCANS, add, add_mesh, empty, group, hand, handle, load_addon, select, shown, stored  # noqa: E402


@pytest.fixture
def addon():
    """The add-on, registered in an empty file."""
    module = load_addon()
    yield module
    bpy.ops.wm.read_factory_settings(use_empty=True)
    module.unregister()


def tube(around=12, along=30):
    """An open tube of quads along z."""
    angle = np.linspace(0, 2 * np.pi, around, endpoint=False)
    ring = np.c_[0.2 * np.cos(angle), 0.2 * np.sin(angle), np.zeros(around)]
    vertices = np.concatenate([ring + [0, 0, z] for z in np.linspace(0, 2, along)])
    a = np.arange((along - 1) * around)
    b = a // around * around + (a + 1) % around
    return vertices, np.c_[a, b, b + around, a + around]


@pytest.fixture
def bent(addon):
    """A tube with a fixed foot and a top that an empty moves."""
    vertices, faces = tube()
    obj = add_mesh(vertices, faces)
    group(obj, "foot", np.flatnonzero(vertices[:, 2] < 0.2))
    group(obj, "top", np.flatnonzero(vertices[:, 2] > 1.8))
    target = empty((0, 0, 2))
    handle(obj, "top", target)
    obj.pliant.fixed = "foot"
    select(obj)
    return obj, target


def own(obj, **change):
    """What the engine makes of the tube, without Blender."""
    rest = stored(obj.data)
    top, foot = rest[:, 2] > 1.8, rest[:, 2] < 0.2
    obj.data.calc_loop_triangles()
    corners = [list(triangle.vertices) for triangle in obj.data.loop_triangles]
    method = {"name": "arap", "energy": "smooth"}
    arguments = {"handles": {"top": top}, "fixed": foot, "method": method, **change}
    return pliant.bind(rest, corners, **arguments)


def moved(x):
    matrix = np.eye(4)
    matrix[0, 3] = np.float32(x)
    return matrix


def test_an_empty_bends_the_mesh_live_and_the_shape_is_baked(addon, bent, tmp_path):
    obj, target = bent
    rest = stored(obj.data)
    assert bpy.ops.pliant.begin() == {"FINISHED"}
    assert np.array_equal(shown(obj), rest)
    previous = rest
    for x in (0.2, 0.4, 0.6):
        target.location.x = x
        bpy.context.view_layer.update()
        now = shown(obj)
        top = rest[:, 2] > 1.8
        assert np.abs(now[top] - rest[top] - [x, 0, 0]).max() < 1e-5
        assert np.array_equal(now[rest[:, 2] < 0.2], rest[rest[:, 2] < 0.2])
        assert not np.array_equal(now, previous)
        previous = now
    assert bpy.ops.pliant.bake() == {"FINISHED"}
    assert addon.live.sessions == {}
    expected = own(obj)
    expected.step(moved(0), iterations=1)
    settled = shown(obj)
    assert np.abs(settled - expected.step(moved(0.6))).max() < 1e-2
    target.location.x = 5
    assert np.array_equal(shown(obj), settled), "a baked shape stays"
    assert np.array_equal(stored(obj.data), rest), "the mesh itself is as it was"

    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "baked.blend"))
    names = obj.name, target.name
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "baked.blend"))
    again = bpy.data.objects[names[0]]
    assert [key.name for key in again.data.shape_keys.key_blocks] == ["Basis", "Pliant"]
    assert np.array_equal(shown(again), settled)
    assert again.pliant.handles[0].group == "top" and again.pliant.handles[0].target.name == names[1]


def test_a_linear_method_gives_the_engine_s_shape_to_the_bit_in_f32(bent):
    obj, target = bent
    obj.pliant.method = "bilaplacian"
    bpy.ops.pliant.begin()
    target.location.x = 0.5
    bpy.context.view_layer.update()
    assert np.array_equal(shown(obj), own(obj, method="bilaplacian").step(moved(0.5)).astype(np.float32))


def test_the_object_s_own_place_and_the_target_s_turn_are_taken_into_account(bent):
    obj, target = bent
    obj.pliant.method = "bilaplacian"
    obj.location, obj.rotation_euler, obj.scale = (3, 1, 2), (0.3, 0.2, 0.1), (2, 2, 2)
    target.location = (3, 1, 6)
    bpy.context.view_layer.update()
    rest = stored(obj.data)
    world_from_object = np.array(obj.matrix_world)
    before = np.array(target.matrix_world)
    bpy.ops.pliant.begin()
    target.location, target.rotation_euler = (3.5, 1, 5.5), (0, 0.8, 0)
    bpy.context.view_layer.update()
    world_move = np.array(target.matrix_world) @ np.linalg.inv(before)
    now, top = shown(obj), rest[:, 2] > 1.8
    homogeneous = lambda points: np.c_[points, np.ones(len(points))]
    expected = homogeneous(rest[top]) @ (world_move @ world_from_object).T
    assert np.abs(homogeneous(now[top]) @ world_from_object.T - expected).max() < 1e-4


def test_giving_up_leaves_the_mesh_as_it_was(bent):
    obj, target = bent
    rest = stored(obj.data)
    bpy.ops.pliant.begin()
    target.location.x = 0.5
    bpy.context.view_layer.update()
    assert bpy.ops.pliant.discard() == {"FINISHED"}
    assert obj.data.shape_keys is None and np.array_equal(shown(obj), rest)


def test_stiffness_options_and_soft_handles_change_the_shape(bent):
    obj, target = bent
    vertices = stored(obj.data)
    group(obj, "hard", np.flatnonzero(vertices[:, 2] > 1.0))

    def shape():
        target.location.x = 0
        bpy.context.view_layer.update()
        bpy.ops.pliant.begin()
        target.location.x = 0.8
        bpy.context.view_layer.update()
        bpy.ops.pliant.bake()
        out = shown(obj)
        obj.shape_key_clear()
        return out

    smooth = shape()
    obj.pliant.options_arap.energy = "spokes-and-rims"
    plain = shape()
    obj.pliant.stiffness, obj.pliant.stiffest = "hard", 100
    stiff = shape()
    obj.pliant.stiffness = ""
    obj.pliant.handles[0].is_soft, obj.pliant.handles[0].weight = True, 0.01
    soft = shape()
    for other in (smooth, stiff, soft):
        assert np.abs(other - plain).max() > 1e-3


def armature():
    data = bpy.data.armatures.new("Armature")
    obj = select(add(bpy.data.objects.new("Armature", data)))
    bpy.ops.object.mode_set(mode="EDIT")
    for name, low, high in (("foot", 0, 0.3), ("top", 1.7, 2)):
        bone = data.edit_bones.new(name)
        bone.head, bone.tail = (0, 0, low), (0, 0, high)
    bpy.ops.object.mode_set(mode="OBJECT")
    return obj


def test_bones_move_handles_in_place_of_their_modifier(addon, bent):
    obj, _ = bent
    rest = stored(obj.data)
    rig = armature()
    modifier = obj.modifiers.new("rig", "ARMATURE")
    modifier.object = rig
    select(obj)
    assert bpy.ops.pliant.find_handles(source="ARMATURE") == {"FINISHED"}
    assert {(own.group, own.bone) for own in obj.pliant.handles} == {("foot", "foot"), ("top", "top")}
    obj.pliant.fixed = ""
    bpy.ops.pliant.begin()
    assert not modifier.show_viewport
    rig.pose.bones["top"].location = (0, 0, 0.5)  # along the bone's own axes
    bpy.context.view_layer.update()
    now = shown(obj)
    way = np.array(rig.pose.bones["top"].matrix.translation) - [0, 0, 1.7]
    assert np.linalg.norm(way) > 0.4
    top = rest[:, 2] > 1.8
    assert np.abs(now[top] - rest[top] - way).max() < 1e-4
    assert np.abs(now[rest[:, 2] < 0.2] - rest[rest[:, 2] < 0.2]).max() < 1e-5
    bpy.ops.pliant.discard()
    assert modifier.show_viewport and modifier.show_render


def test_hooks_become_handles(bent):
    obj, target = bent
    hook = obj.modifiers.new("hook", "HOOK")
    hook.object, hook.vertex_group = target, "top"
    obj.pliant.handles.clear()
    assert bpy.ops.pliant.find_handles(source="HOOK") == {"FINISHED"}
    assert [(own.group, own.target) for own in obj.pliant.handles] == [("top", target)]
    rest = stored(obj.data)
    bpy.ops.pliant.begin()
    target.location.y = 0.4
    bpy.context.view_layer.update()
    top = rest[:, 2] > 1.8
    assert np.abs(shown(obj)[top] - rest[top] - [0, 0.4, 0]).max() < 1e-5


def test_an_animated_target_is_followed(bent):
    obj, target = bent
    obj.pliant.method = "bilaplacian"
    target.keyframe_insert("location", frame=1)
    target.location.x = 1
    target.keyframe_insert("location", frame=11)
    bpy.context.scene.frame_set(1)
    bpy.ops.pliant.begin()
    rest = stored(obj.data)
    top = rest[:, 2] > 1.8
    bpy.context.scene.frame_set(11)
    assert np.abs(shown(obj)[top] - rest[top] - [1, 0, 0]).max() < 1e-5


def bow(obj, target):
    """Has the target go a long way and turn a lot in ten frames, as methods that iterate are slow to follow."""
    target.keyframe_insert("location", frame=1)
    target.keyframe_insert("rotation_euler", frame=1)
    target.location, target.rotation_euler = (1.2, 0, 1.4), (0, 1.8, 0)
    target.keyframe_insert("location", frame=11)
    target.keyframe_insert("rotation_euler", frame=11)
    bpy.context.scene.frame_set(1)


def settled_at(obj, target, frame, before):
    """What the engine makes of a frame, without Blender."""
    bpy.context.scene.frame_set(frame)
    return own(obj).step(np.array(target.matrix_world @ before.inverted(), dtype=float))


def test_each_frame_is_settled_whatever_was_played_before_it(addon, bent):
    obj, target = bent
    bow(obj, target)
    before = target.matrix_world.copy()
    bpy.ops.pliant.begin()
    played = {}
    for frame in range(1, 12):
        bpy.context.scene.frame_set(frame)
        played[frame] = shown(obj)
    for frame in (11, 4, 7, 1):
        bpy.context.scene.frame_set(frame)
        assert np.array_equal(shown(obj), played[frame]), frame
        assert np.abs(played[frame] - settled_at(obj, target, frame, before)).max() < 1e-5, frame
    assert addon.live.session_of(obj).is_settled


def test_on_the_screen_frames_are_followed_and_settle_when_they_stop(addon, bent, monkeypatch):
    obj, target = bent
    bow(obj, target)
    bpy.ops.pliant.begin()
    bpy.context.scene.frame_set(11)
    settled = shown(obj)
    bpy.context.scene.frame_set(1)
    monkeypatch.setattr(addon.live, "is_playing", lambda: True)
    monkeypatch.setattr(addon.live, "FRAME", 0.0)
    bpy.context.scene.frame_set(11)
    assert np.abs(shown(obj) - settled).max() > 1e-3, "one iteration a frame"
    monkeypatch.setattr(addon.live, "is_playing", lambda: False)
    addon.live.settle_further()
    assert np.array_equal(shown(obj), settled)


@pytest.mark.parametrize("into", ["KEYS", "CACHE"])
def test_a_range_of_frames_is_baked(addon, bent, tmp_path, into):
    obj, target = bent
    bow(obj, target)
    # Another shape key that is on stays in the result.
    lifted = stored(obj.data) + np.float32([0, 0, 0.1])
    addon.shape_keys.add(obj, "Lifted").data.foreach_set("co", lifted.ravel())
    bpy.ops.pliant.begin()
    live = {}
    for frame in range(3, 9):
        bpy.context.scene.frame_set(frame)
        live[frame] = shown(obj)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "live.blend"))
    bpy.context.scene.frame_set(2)
    assert bpy.ops.pliant.bake_frames(first=3, last=8, into=into, filepath="//shape.pc2") == {"FINISHED"}
    assert bpy.context.scene.frame_current == 2
    assert addon.live.sessions == {} and "Pliant" not in obj.data.shape_keys.key_blocks
    target.animation_data_clear()
    for frame in (8, 3, 5):
        bpy.context.scene.frame_set(frame)
        assert np.abs(shown(obj) - live[frame]).max() < 1e-6, frame
    bpy.context.scene.frame_set(30)
    assert np.abs(shown(obj) - live[8]).max() < 1e-6, "the last one holds"


def test_what_is_bent_baked_and_bent_again_goes_where_its_targets_go(addon, bent):
    obj, target = bent
    rest = stored(obj.data)
    top = rest[:, 2] > 1.8
    for round in range(3):
        before, start = target.matrix_world.copy(), shown(obj)
        assert bpy.ops.pliant.begin() == {"FINISHED"}
        assert np.abs(shown(obj) - start).max() < 1e-6, "nothing jumps"
        target.location.x += 0.4
        target.rotation_euler.y += 0.5
        bpy.context.view_layer.update()
        bpy.ops.pliant.bake()
        way = np.array(target.matrix_world @ before.inverted())
        wanted = np.c_[start[top], np.ones(top.sum())] @ way.T
        assert np.abs(shown(obj)[top] - wanted[:, :3]).max() < 1e-5, round
    assert [key.name for key in obj.data.shape_keys.key_blocks] == ["Basis", "Pliant", "Pliant.001", "Pliant.002"]
    # Each of them can be taken away for itself.
    third = shown(obj)
    bpy.ops.pliant.begin()
    target.location.x += 1
    bpy.context.view_layer.update()
    bpy.ops.pliant.discard()
    assert np.array_equal(shown(obj), third) and np.array_equal(stored(obj.data), rest)


def test_a_mesh_that_is_edited_ends_its_session_with_a_sentence(addon, bent):
    obj, target = bent
    bpy.ops.pliant.begin()
    target.location.x = 0.5
    bpy.context.view_layer.update()
    now = shown(obj)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.subdivide()
    bpy.ops.object.mode_set(mode="OBJECT")
    target.location.x = 0.9
    bpy.context.view_layer.update()
    assert addon.live.sessions == {}
    assert "was edited, which ended its live bending" in addon.live.notices[obj.session_uid]
    assert np.abs(shown(obj)[: len(now)] - now).max() < 1e-5
    assert len(shown(obj)) > len(now)
    # And it can be bent on.
    assert bpy.ops.pliant.begin() == {"FINISHED"}
    assert obj.session_uid not in addon.live.notices


def rendered_frames(addon, obj, tmp_path):
    """The shapes of a live object in ten frames, 2 to 11, each as it was rendered."""
    scene = bpy.context.scene
    scene.render.engine, scene.cycles.samples, scene.render.resolution_x, scene.render.resolution_y = "CYCLES", 1, 8, 8
    scene.frame_start, scene.frame_end, scene.render.filepath = 2, 11, str(tmp_path / "frame")
    scene.camera = add(bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera")))
    rendered = {}
    note = lambda scene, _=None: rendered.setdefault(scene.frame_current, addon.live.session_of(obj).shape.copy())
    bpy.app.handlers.render_post.append(note)
    try:
        bpy.ops.render.render(animation=True)
    finally:
        bpy.app.handlers.render_post.remove(note)
    assert sorted(rendered) == list(range(2, 12))
    return rendered


def test_a_file_that_is_saved_while_bent_live_goes_on_when_it_is_opened(addon, bent, tmp_path):
    obj, target = bent
    rest = stored(obj.data)
    hook = obj.modifiers.new("hook", "HOOK")
    hook.object, hook.vertex_group, hook.show_render = target, "top", False
    bow(obj, target)
    before = target.matrix_world.copy()
    bpy.ops.pliant.begin()
    bpy.context.scene.frame_set(6)
    now, names = shown(obj), (obj.name, target.name)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "live.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "live.blend"))
    obj, target = (bpy.data.objects[name] for name in names)
    assert np.array_equal(shown(obj), now) and not obj.modifiers["hook"].show_viewport
    rendered = rendered_frames(addon, obj, tmp_path)
    for frame, shape in rendered.items():
        assert np.abs(shape - settled_at(obj, target, frame, before)).max() < 1e-5, frame
    select(obj)
    bpy.ops.pliant.discard()
    assert obj.data.shape_keys is None and np.array_equal(stored(obj.data), rest)
    assert obj.modifiers["hook"].show_viewport and not obj.modifiers["hook"].show_render


def test_frames_of_a_second_bend_that_was_saved_and_reopened_are_the_command_line_s(addon, bent, tmp_path):
    program = os.environ.get("PLIANT") or shutil.which("pliant")
    if not program:
        pytest.skip("there is no command line: PLIANT names no program")
    obj, target = bent
    bpy.ops.pliant.begin()
    target.location.x, target.rotation_euler.y = 0.4, 0.5
    bpy.context.view_layer.update()
    bpy.ops.pliant.bake()
    start, before = shown(obj), target.matrix_world.copy()
    top, foot = stored(obj.data)[:, 2] > 1.8, stored(obj.data)[:, 2] < 0.2
    bpy.ops.pliant.begin()
    bow(obj, target)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "second.blend"))
    names = obj.name, target.name
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "second.blend"))
    obj, target = (bpy.data.objects[name] for name in names)
    rendered = rendered_frames(addon, obj, tmp_path)

    obj.data.calc_loop_triangles()
    lines = [f"OFF\n{len(start)} {len(obj.data.loop_triangles)} 0"]
    lines += ["{!r} {!r} {!r}".format(*map(float, point)) for point in start]
    lines += ["3 {} {} {}".format(*triangle.vertices) for triangle in obj.data.loop_triangles]
    (tmp_path / "start.off").write_text("\n".join(lines) + "\n")
    for frame, shape in rendered.items():
        bpy.context.scene.frame_set(frame)
        way = np.array(target.matrix_world @ before.inverted(), dtype=float)
        handle = {"name": "top", "select": {"vertices": np.flatnonzero(top).tolist()}}
        edit = {
            "version": 1,
            "method": {"name": "arap", "energy": "smooth"},
            "fixed": {"vertices": np.flatnonzero(foot).tolist()},
            "handles": [{**handle, "transform": {"matrix": way.T.ravel().tolist()}}],
        }
        (tmp_path / "edit.json").write_text(json.dumps(edit))
        arguments = [tmp_path / "start.off", "--edit", tmp_path / "edit.json", "--output", tmp_path / f"{frame}.off"]
        subprocess.run([program, "apply", *map(str, arguments)], check=True, capture_output=True)
        wanted = pliant.load(tmp_path / f"{frame}.off").vertices
        assert np.abs(shape - wanted).max() < 1e-5, frame


def test_a_live_file_that_can_t_go_on_is_put_back_with_a_sentence(addon, bent, tmp_path):
    obj, _ = bent
    rest = stored(obj.data)
    hook = obj.modifiers.new("hook", "HOOK").name
    bpy.ops.pliant.begin()
    name = obj.name
    obj.vertex_groups.remove(obj.vertex_groups["top"])
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "live.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "live.blend"))
    obj = bpy.data.objects[name]
    assert 'no vertex group "top"' in addon.live.notices[obj.session_uid]
    assert obj.data.shape_keys is None and obj.modifiers[hook].show_viewport
    assert np.array_equal(shown(obj), rest) and not obj.pliant.live_key


def test_options_are_fields_of_the_engine_s_own_declaration(addon, bent):
    obj, _ = bent
    for method, declared in pliant.methods().items():
        obj.pliant.method = method
        fields = getattr(obj.pliant, addon.settings.member(method), None)
        chosen = addon.settings.method_of(obj.pliant)
        assert chosen.pop("name") == method
        for name, option in declared["options"].items():
            shown_as = fields.bl_rna.properties[name]
            assert shown_as.description.lower().startswith(option["help"].lower())
            assert chosen.pop(name, option["default"]) == option["first_choice"]
            if "range" in option:
                assert [shown_as.hard_min, shown_as.hard_max] == pytest.approx(option["range"], rel=1e-6)
        assert not chosen
    obj.pliant.method = "bilaplacian"
    obj.pliant.options_bilaplacian.order, obj.pliant.options_bilaplacian.stretching = "3", 2.5
    assert addon.settings.method_of(obj.pliant) == {"name": "bilaplacian", "order": 3, "stretching": 2.5}


def test_a_target_that_is_scaled_to_nothing_is_told_and_waited_for(addon, bent):
    obj, target = bent
    bpy.ops.pliant.begin()
    target.scale = (0, 0, 0)
    bpy.context.view_layer.update()
    assert "flattens" in addon.live.notices[obj.session_uid]
    target.scale = (1, 1, 1)
    target.location.x = 0.3
    bpy.context.view_layer.update()
    assert obj.session_uid not in addon.live.notices
    assert np.abs(shown(obj)[-1] - stored(obj.data)[-1] - [0.3, 0, 0]).max() < 1e-5


def pin(obj):
    obj.shape_key_add(name="Basis")
    obj.show_only_shape_key = True


@pytest.mark.parametrize(
    "change, said",
    [
        (lambda obj: obj.pliant.handles.clear(), "has no handle"),
        (lambda obj: setattr(obj.pliant.handles[0], "group", "nose"), 'no vertex group "nose"'),
        (lambda obj: setattr(obj.pliant.handles[0], "target", None), "has no target"),
        (lambda obj: setattr(obj.pliant.handles[0], "bone", "arm"), 'no bone "arm"'),
        (lambda obj: add(bpy.data.objects.new("Twin", obj.data)), "shares its mesh"),
        (lambda obj: pin(obj), "turn off the pin"),
        (lambda obj: setattr(obj.pliant, "fixed", "nose"), "fixed part"),
        (lambda obj: obj.vertex_groups["top"].remove(range(len(obj.data.vertices))), "weighs 0.5 or more"),
    ],
)
def test_what_is_refused_is_named_with_its_remedy_and_nothing_is_changed(addon, bent, change, said):
    obj, _ = bent
    change(obj)
    with pytest.raises(RuntimeError, match=said):
        bpy.ops.pliant.begin()
    assert obj.data.shape_keys is None or "Pliant" not in obj.data.shape_keys.key_blocks
    assert addon.live.sessions == {} and not obj.pliant.live_key


def test_a_deleted_object_ends_its_session(addon, bent):
    obj, target = bent
    bpy.ops.pliant.begin()
    bpy.data.objects.remove(obj)
    target.location.x = 1
    bpy.context.view_layer.update()
    assert addon.live.sessions == {}


def test_an_undo_of_the_target_s_move_is_followed(addon, bent):
    obj, target = bent
    names = obj.name, target.name
    bpy.ops.pliant.begin()
    bpy.ops.ed.undo_push(message="begin")
    for x in (0.5, 0.9):
        target.location.x = x
        bpy.context.view_layer.update()
        bpy.ops.ed.undo_push(message="move")
    assert bpy.ops.ed.undo() == {"FINISHED"}
    # The object from before the undo has another place in memory.
    obj, target = (bpy.data.objects[name] for name in names)
    bpy.context.view_layer.update()
    for x in (0.5, 0.2):
        target.location.x = x
        bpy.context.view_layer.update()
        assert np.abs(shown(obj)[-1] - stored(obj.data)[-1] - [x, 0, 0]).max() < 1e-5
    select(obj)
    assert bpy.ops.pliant.bake() == {"FINISHED"} and addon.live.sessions == {}


# Replaces the person at the window: applies the edit, bends the result further and saves it.
WINDOW = """#!{python}
import json, sys, pliant
file, option, edit = sys.argv[1:]
assert option == "--edit"
edit = json.load(open(edit))
handles = {{own.pop("name"): own for own in edit["handles"]}}
transforms = {{name: own.pop("transform", {{}}) for name, own in handles.items()}}
members = {{name: edit[name] for name in ("method", "fixed", "stiffness") if name in edit}}
mesh = pliant.load(file)
shape = mesh.bind(handles=handles, **members).step(transforms)
shape[:, 0] += {shear} * mesh.vertices[:, 2]
pliant.save(file, mesh, shape)
"""


@pytest.fixture
def window(addon, tmp_path, monkeypatch):
    """Opens the active object in a window whose person shears it, saves it and leaves. The files that were handed over."""
    program = tmp_path / "window.py"
    monkeypatch.setattr(addon.exchange, "program", lambda: str(program))

    def opened(obj, shear=0.0):
        program.write_text(WINDOW.format(python=sys.executable, shear=shear))
        program.chmod(0o755)
        assert bpy.ops.pliant.open_window() == {"FINISHED"}
        file, _, process = addon.exchange.opened[obj.session_uid]
        assert process.wait(60) == 0
        return file, json.loads(file.with_suffix(".edit.json").read_text())

    return opened


def test_the_window_gets_the_mesh_and_its_shape_comes_back_by_vertex_order(bent, window):
    obj, _ = bent
    rest = stored(obj.data)
    with pytest.raises(RuntimeError, match="open it first"):
        bpy.ops.pliant.import_shape()
    file, _ = window(obj, shear=1.0)
    assert bpy.ops.pliant.import_shape() == {"FINISHED"}
    assert np.array_equal(shown(obj), rest + rest[:, [2]] * np.float32([1, 0, 0]))
    bound = pliant.load(file)
    assert len(bound.faces) == 2 * len(obj.data.polygons)
    obj.shape_key_clear()
    obj.data.clear_geometry()
    with pytest.raises(RuntimeError, match="0 vertices and the saved file 360"):
        bpy.ops.pliant.import_shape()


def test_the_window_gets_method_handles_and_what_is_held_and_stiff(bent, window):
    obj, _ = bent
    rest = stored(obj.data)
    group(obj, "hard", np.flatnonzero(rest[:, 2] > 1.0))
    obj.pliant.stiffness, obj.pliant.stiffest = "hard", 100
    obj.pliant.handles[0].is_soft, obj.pliant.handles[0].weight = True, 0.5
    _, edit = window(obj)
    assert edit["method"] == {"name": "arap", "energy": "smooth"}
    top, foot = np.flatnonzero(rest[:, 2] > 1.8), np.flatnonzero(rest[:, 2] < 0.2)
    assert edit["handles"] == [{"name": "top", "select": {"vertices": top.tolist()}, "soft": 0.5}]
    assert edit["fixed"] == {"vertices": foot.tolist()}
    assert edit["stiffness"] == [{"per_vertex": [100.0 if z > 1.0 else 1.0 for z in rest[:, 2]]}]


def test_the_window_goes_on_from_where_the_targets_are(bent, window):
    obj, target = bent
    obj.pliant.method = "bilaplacian"
    bpy.ops.pliant.begin()
    target.location.x, target.rotation_euler = 0.5, (0, 0.4, 0)
    bpy.context.view_layer.update()
    live = shown(obj)
    window(obj)
    bpy.ops.pliant.discard()
    assert bpy.ops.pliant.import_shape() == {"FINISHED"}
    assert np.abs(live - stored(obj.data)).max() > 0.4
    assert np.array_equal(shown(obj), live)


def test_a_mesh_without_handles_is_opened_as_it_is(bent, window):
    obj, _ = bent
    obj.pliant.handles.clear()
    obj.pliant.fixed = ""
    _, edit = window(obj)
    assert edit == {"version": 1, "method": {"name": "arap", "energy": "smooth"}, "handles": []}


def test_blender_installs_the_packed_add_on(tmp_path):
    archive = os.environ.get("PLIANT_EXTENSION")
    if not archive:
        pytest.skip("no archive: cargo xtask python")
    script = f"""
import bpy
bpy.ops.extensions.package_install_files(filepath={str(archive)!r}, repo="user_default", enable_on_install=True)
assert any(name.endswith(".pliant") for name in bpy.context.preferences.addons.keys()), list(bpy.context.preferences.addons.keys())
import pliant
print("engine", pliant.__file__)
assert bpy.types.Object.bl_rna.properties["pliant"]
bpy.ops.mesh.primitive_uv_sphere_add()
assert "FINISHED" in bpy.ops.pliant.add_handle()
"""
    environment = {**os.environ, "BLENDER_USER_RESOURCES": str(tmp_path)}
    run = subprocess.run([sys.executable, "-c", script], env=environment, capture_output=True, text=True, cwd=tmp_path)
    assert run.returncode == 0, run.stdout + run.stderr


def test_the_hand_of_a_scan_follows_an_empty_and_is_baked_saved_and_reopened(addon, tmp_path):
    if not (SCANS / "armadillo.obj").is_file():
        pytest.skip("there are no scans in PLIANT_DATA")
    scan = pliant.load(SCANS / "armadillo.obj")
    obj, target = hand(scan)
    rest = stored(obj.data)
    assert obj.pliant.method == "arap" and obj.pliant.options_arap.energy == "smooth"
    bpy.ops.pliant.begin()
    for way in (0.5, 1.0):
        target.location += way * Vector((0.2, 1, 0.3)) * 10
        target.rotation_euler.z = 0.9 * way
        bpy.context.view_layer.update()
    bpy.ops.pliant.bake()
    baked = shown(obj)
    assert np.abs(baked - rest).max() > 10
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "hand.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "hand.blend"))
    obj = bpy.data.objects["Armadillo"]
    assert np.array_equal(shown(obj), baked)
    assert np.array_equal(stored(obj.data), rest)
