"""Blender's modifiers that bend space, timed: Lattice, Mesh Deform, Surface Deform.

usage: blender_space.py VERTICES
needs: pip install bpy numpy (bpy 4.2 runs on Python 3.11)

The shape is the bumpy ball of the example `space`. The lattice has 8 x 8 x 8 points with B-splines between them. The
cage of the other two is a ball of 320 triangles around the shape. One JSON object a line: the milliseconds of the
binding (0 if there is none) and the median milliseconds of a frame, in which the controls have moved. Blender uses
all cores.
"""
import json
import statistics
import sys
import time

import bpy
import numpy as np

FRAMES = 10
LATTICE_POINTS = 8


def ball(vertex_count):
    """Vertices (n x 3) and quadrilaterals of a bumpy ball, without its poles."""
    rings = int((vertex_count / 2) ** 0.5)
    around = 2 * rings
    polar, azimuth = np.meshgrid(
        np.linspace(0, np.pi, rings + 2)[1:-1], np.arange(around) * 2 * np.pi / around, indexing="ij"
    )
    p = np.stack([np.sin(polar) * np.cos(azimuth), np.sin(polar) * np.sin(azimuth), np.cos(polar)], -1).reshape(-1, 3)
    p *= 1 + 0.05 * (np.sin(9 * p[:, 0]) * np.sin(7 * p[:, 1]) * np.sin(8 * p[:, 2]))[:, None]
    ring, place = np.meshgrid(np.arange(rings - 1), np.arange(around), indexing="ij")
    beside = (place + 1) % around
    corners = [ring * around + place, (ring + 1) * around + place, (ring + 1) * around + beside, ring * around + beside]
    return p, np.stack(corners, -1).reshape(-1, 4)


def mesh_object(name, vertices, faces):
    mesh = bpy.data.meshes.new(name)
    mesh.vertices.add(len(vertices))
    mesh.vertices.foreach_set("co", vertices.astype(np.float32).ravel())
    mesh.loops.add(faces.size)
    mesh.loops.foreach_set("vertex_index", faces.astype(np.int32).ravel())
    mesh.polygons.add(len(faces))
    mesh.polygons.foreach_set("loop_start", np.arange(0, faces.size, faces.shape[1], dtype=np.int32))
    mesh.update(calc_edges=True)
    made = bpy.data.objects.new(name, mesh)
    bpy.context.collection.objects.link(made)
    return made


def frames(shape, move):
    """Median milliseconds from a moved control to new positions."""
    graph = bpy.context.evaluated_depsgraph_get()
    rest = np.empty(3 * len(shape.data.vertices), np.float32)
    shape.data.vertices.foreach_get("co", rest)
    moved, times = np.empty_like(rest), []
    for frame in range(1, FRAMES + 1):
        move(frame / FRAMES)
        begun = time.perf_counter()
        graph.update()
        evaluated = shape.evaluated_get(graph).data
        times.append(1e3 * (time.perf_counter() - begun))
        evaluated.vertices.foreach_get("co", moved)
    # The first frame also allocates.
    return statistics.median(times[1:]), float(np.abs(moved - rest).max())


def say(method, shape, bind_ms, frame):
    frame_ms, moved = frame
    row = {
        "program": f"Blender {bpy.app.version_string}", "method": method, "vertices": len(shape.data.vertices),
        "bind": round(bind_ms, 1), "frame": round(frame_ms, 2), "moved": "yes" if moved > 1e-3 else "no",
    }
    print(json.dumps(row), flush=True)


def cage_move(cage):
    rest = np.empty(3 * len(cage.data.vertices), np.float32)
    cage.data.vertices.foreach_get("co", rest)

    def move(share):
        moved = rest.reshape(-1, 3).copy()
        above = moved[:, 2] > 0.8
        moved[above] += np.array([0.3, 0.1, 0.4], np.float32) * share
        cage.data.vertices.foreach_set("co", moved.ravel())
        cage.data.update()

    return move


def main():
    vertices, faces = ball(int(sys.argv[1]))
    bpy.ops.wm.read_factory_settings(use_empty=True)
    shape = mesh_object("shape", vertices, faces)

    lattice = bpy.data.lattices.new("lattice")
    lattice.points_u = lattice.points_v = lattice.points_w = LATTICE_POINTS
    for axis in "uvw":
        setattr(lattice, f"interpolation_type_{axis}", "KEY_BSPLINE")
    box = bpy.data.objects.new("lattice", lattice)
    box.scale = (2.4, 2.4, 2.4)
    bpy.context.collection.objects.link(box)
    modifier = shape.modifiers.new("lattice", "LATTICE")
    modifier.object = box
    rest = np.empty(3 * len(lattice.points), np.float32)
    lattice.points.foreach_get("co_deform", rest)

    def move_lattice(share):
        moved = rest.reshape(-1, 3).copy()
        moved[moved[:, 2] > 0.3] += np.array([0.1, 0.03, 0.15], np.float32) * share
        lattice.points.foreach_set("co_deform", moved.ravel())
        lattice.update_tag()

    say("lattice", shape, 0.0, frames(shape, move_lattice))
    shape.modifiers.remove(modifier)

    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3, radius=1.25)
    cage = bpy.context.active_object
    bpy.context.view_layer.objects.active = shape
    for kind, name, bind in [
        ("MESH_DEFORM", "mesh-deform", bpy.ops.object.meshdeform_bind),
        ("SURFACE_DEFORM", "surface-deform", bpy.ops.object.surfacedeform_bind),
    ]:
        modifier = shape.modifiers.new(name, kind)
        if kind == "MESH_DEFORM":
            modifier.object = cage
        else:
            modifier.target = cage
        move = cage_move(cage)
        begun = time.perf_counter()
        bind(modifier=name)
        bind_ms = 1e3 * (time.perf_counter() - begun)
        if not modifier.is_bound:
            print(json.dumps({"program": "Blender", "method": name, "says": "not bound"}), flush=True)
        else:
            say(name, shape, bind_ms, frames(shape, move))
        shape.modifiers.remove(modifier)
        move(0.0)


main()
