"""The animation of an edit, played by Blender: a glTF with morph targets, and point caches.

usage: animation.py PLIANT FILE EDIT
  PLIANT  the program, e.g. target/release/pliant
  FILE    a GLB with one mesh
  EDIT    an edit with keys
needs:  pip install bpy numpy

`pliant animate` writes GLB, PC2 and MDD. At ten frames Blender's shape of the imported glTF, and that of a mesh with the
modifier Mesh Cache on either cache, must have the positions of the PC2 as this script reads it. The exit status is 1 if
one is farther away than 1e-5 of the diagonal.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

import bpy
import numpy as np

FPS = 24


def read_pc2(path):
    data = path.read_bytes()
    count, frames = np.frombuffer(data, "<i4", 1, 16)[0], np.frombuffer(data, "<i4", 1, 28)[0]
    return np.frombuffer(data, "<f4", count * frames * 3, 32).reshape(frames, count, 3)


def rest_of(path):
    """The positions of the file's one mesh, in the order of its vertices."""
    data = path.read_bytes()
    length = int.from_bytes(data[12:16], "little")
    gltf, binary = json.loads(data[20 : 20 + length]), data[28 + length :]
    parts = []
    for primitive in gltf["meshes"][0]["primitives"]:
        accessor = gltf["accessors"][primitive["attributes"]["POSITION"]]
        view = gltf["bufferViews"][accessor["bufferView"]]
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        parts.append(np.frombuffer(binary, "<f4", 3 * accessor["count"], start).reshape(-1, 3))
    return np.concatenate(parts)


def shape_at(thing, frame):
    bpy.context.scene.frame_set(frame)
    evaluated = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = evaluated.to_mesh()
    places = np.empty(3 * len(mesh.vertices), "f4")
    mesh.vertices.foreach_get("co", places)
    evaluated.to_mesh_clear()
    return places.reshape(-1, 3)


def compare(name, thing, wanted, turn=lambda places: places):
    frames = [round(k * (len(wanted) - 1) / 9) for k in range(10)]
    size = np.linalg.norm(np.ptp(wanted.reshape(-1, 3), axis=0))
    apart = max(np.abs(turn(shape_at(thing, frame)) - wanted[frame]).max() for frame in frames)
    print(f"{name}: {apart / size:.1e} of the diagonal at ten of {len(wanted)} frames")
    return apart <= 1e-5 * size


def main():
    program, file, edit = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        outputs = {kind: pathlib.Path(folder) / f"animation.{kind}" for kind in ("glb", "pc2", "mdd")}
        for path in outputs.values():
            command = [program, "animate", file, "--edit", edit, "--output", path, "--fps", str(FPS)]
            subprocess.run(command, check=True, stderr=subprocess.DEVNULL)
        wanted = read_pc2(outputs["pc2"])

        bpy.ops.wm.read_factory_settings(use_empty=True)
        bpy.context.scene.render.fps = FPS
        bpy.ops.import_scene.gltf(filepath=str(outputs["glb"]))
        shown = next(thing for thing in bpy.context.scene.objects if thing.type == "MESH")
        # Blender's y is glTF's -z, and its import orders vertices anew: they are found by their place at rest.
        to_gltf = lambda places: places[:, [0, 2, 1]] * np.array([1, 1, -1], "f4")
        own = np.empty(3 * len(shown.data.vertices), "f4")
        shown.data.vertices.foreach_get("co", own)
        place_of = {place.tobytes(): number for number, place in enumerate(rest_of(outputs["glb"]) + 0.0)}
        order = [place_of[place.tobytes()] for place in to_gltf(own.reshape(-1, 3)) + 0.0]
        good = compare("glTF", shown, wanted[:, order], to_gltf)

        for kind in ("pc2", "mdd"):
            mesh = bpy.data.meshes.new(kind)
            mesh.from_pydata(wanted[0], [], [])
            thing = bpy.data.objects.new(kind, mesh)
            bpy.context.collection.objects.link(thing)
            modifier = thing.modifiers.new("cache", "MESH_CACHE")
            modifier.cache_format, modifier.filepath = kind.upper(), str(outputs[kind])
            modifier.frame_start = 0
            good &= compare(kind.upper(), thing, wanted)
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
