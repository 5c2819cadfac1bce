"""Objects in Blender, for the tests and the measurement."""

import importlib.util
import os
import sys
from pathlib import Path

import bpy
import numpy as np

ROOT = Path(__file__).parents[2]
SCANS = Path(os.environ.get("PLIANT_DATA", "")) / "scans"


def load_addon():
    """The add-on, registered in an empty file."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    module = sys.modules.get("pliant_addon")
    if module is None:
        folder = ROOT / "blender/addon"
        spec = importlib.util.spec_from_file_location(
            "pliant_addon", folder / "__init__.py", submodule_search_locations=[str(folder)]
        )
        module = importlib.util.module_from_spec(spec)
        sys.modules["pliant_addon"] = module
        spec.loader.exec_module(module)
    module.register()
    return module


def add_mesh(vertices, faces, name="Mesh"):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(np.asarray(vertices).tolist(), [], np.asarray(faces).tolist())
    return select(add(bpy.data.objects.new(name, mesh)))


def add(obj):
    bpy.context.collection.objects.link(obj)
    return obj


def select(obj):
    bpy.context.view_layer.objects.active = obj
    obj.select_set(True)
    return obj


def group(obj, name, vertices, weight=1.0):
    (obj.vertex_groups.get(name) or obj.vertex_groups.new(name=name)).add([int(v) for v in vertices], weight, "REPLACE")


def empty(location, name="Empty"):
    obj = add(bpy.data.objects.new(name, None))
    obj.location = location
    bpy.context.view_layer.update()
    return obj


def handle(obj, name, target, bone=""):
    own = obj.pliant.handles.add()
    own.group, own.target, own.bone = name, target, bone
    return own


def shown(obj):
    """The vertices as Blender evaluates them."""
    bpy.context.view_layer.update()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    mesh = obj.evaluated_get(depsgraph).to_mesh()
    out = np.empty((len(mesh.vertices), 3), np.float32)
    mesh.vertices.foreach_get("co", out.ravel())
    return out


def stored(mesh):
    out = np.empty((len(mesh.vertices), 3), np.float32)
    mesh.vertices.foreach_get("co", out.ravel())
    return out


def hand(scan):
    """The armadillo with an empty at its hand, which is the handle; most of the rest is held."""
    obj = add_mesh(scan.vertices, scan.faces, "Armadillo")
    along = (scan.vertices - scan.vertices.min(0)) / np.ptp(scan.vertices, axis=0)
    in_hand = (along[:, 0] > 0.93) & (along[:, 1] > 0.5)  # not the toe below it
    held = ((along[:, 0] < 0.6) | (along[:, 1] < 0.4)) & ~in_hand
    group(obj, "hand", np.flatnonzero(in_hand))
    group(obj, "body", np.flatnonzero(held))
    target = empty(scan.vertices[in_hand].mean(0), "Hand")
    handle(obj, "hand", target)
    obj.pliant.fixed = "body"
    select(obj)
    return obj, target
