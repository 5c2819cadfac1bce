"""To Pliant's window and back: the mesh as a file, whose vertices keep their order, and what is chosen for it in the
panel as an edit beside it."""

import json
import os
import shutil
import subprocess
import tempfile
from pathlib import Path

import bpy
import numpy as np
import pliant

from . import live, shape_keys
from .preferences import program
from .settings import Refused, method_of, parts_of

KEY = "Pliant (window)"

# The files that are open in the window, by the objects' session numbers, and the programs.
opened = {}


def write(obj, path):
    """The mesh as a PLY file: its vertices in their order, where they rest if it is bent live and else where they are
    seen, and its polygons."""
    mesh, session = obj.data, live.session_of(obj)
    vertices = session.others if session else shape_keys.seen(obj)
    header = (
        "ply\nformat binary_little_endian 1.0\ncomment written by Pliant's add-on for Blender\n"
        f"element vertex {len(vertices)}\nproperty float x\nproperty float y\nproperty float z\n"
        f"element face {len(mesh.polygons)}\nproperty list uint int vertex_indices\nend_header\n"
    )
    corners = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    sizes = np.empty(len(mesh.polygons), np.int32)
    mesh.polygons.foreach_get("loop_total", sizes)
    # Blender keeps the corners of its polygons in a row.
    faces = np.insert(corners, np.r_[0, np.cumsum(sizes)[:-1]] if len(sizes) else [], sizes)
    path.write_bytes(header.encode() + vertices.astype("<f4").tobytes() + faces.astype("<i4").tobytes())


def edit_of(obj, transforms):
    """The choices of the panel in the edit format: method, handles with their targets, fixed vertices, stiffness."""
    parts = parts_of(obj)
    numbers = lambda mask: {"vertices": np.flatnonzero(mask).tolist()}
    handles = []
    for name, handle in parts["handles"].items():
        entry = {**handle, "name": name, "select": numbers(handle["select"])}
        if name in transforms:
            # Column by column.
            entry["transform"] = {"matrix": transforms[name].T.ravel().tolist()}
        handles.append(entry)
    edit = {"version": 1, "method": method_of(obj.pliant), "handles": handles}
    if "fixed" in parts:
        edit["fixed"] = numbers(parts["fixed"])
    if "stiffness" in parts:
        edit["stiffness"] = [{"per_vertex": parts["stiffness"].tolist()}]
    return edit


def open_window(obj, depsgraph):
    """Opens the mesh in Pliant's window; if it is bent live, with its handles at their targets."""
    path = program()
    if shutil.which(path) is None:
        raise Refused(f"The program {path} does not exist: give its path in the add-on's preferences")
    session = live.session_of(obj)
    edit = edit_of(obj, session.transforms(depsgraph) if session else {})
    folder = Path(tempfile.mkdtemp(prefix="pliant-"))
    file = folder / (bpy.path.clean_name(obj.name) + ".ply")
    write(obj, file)
    beside = file.with_suffix(".edit.json")
    beside.write_text(json.dumps(edit))
    window = subprocess.Popen([path, os.fspath(file), "--edit", os.fspath(beside)], stdin=subprocess.DEVNULL)
    opened[obj.session_uid] = (file, file.stat().st_mtime_ns, window)
    return file


def import_shape(obj):
    """Puts the saved shape into a shape key, and returns its name."""
    if obj.session_uid not in opened:
        raise Refused(f"{obj.name} is not open in Pliant's window: open it first")
    if live.session_of(obj) is not None:
        raise Refused(f"{obj.name} is bent live: bake or discard the shape first")
    file, written, _ = opened[obj.session_uid]
    if not file.is_file() or file.stat().st_mtime_ns == written:
        raise Refused("Pliant's window has saved nothing yet: save there with Ctrl-S, then import the shape")
    shape = pliant.load(file).vertices.astype(np.float32)
    if len(shape) != len(obj.data.vertices):
        raise Refused(
            f"{obj.name} has {len(obj.data.vertices)} vertices and the saved file {len(shape)}: "
            "undo the changes of the mesh since it was opened"
        )
    others = shape_keys.seen(obj, without=KEY)
    keys = obj.data.shape_keys
    key = (keys and keys.key_blocks.get(KEY)) or shape_keys.add(obj, KEY)
    key.value, key.mute = 1.0, False
    shape_keys.write(obj, key.name, shape, others)
    obj.data.update()
    return key.name
