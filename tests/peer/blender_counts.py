"""Checks that Blender finds as much in each OUT as in its IN.

    pip install bpy==4.5.*
    python blender_counts.py IN OUT [IN OUT ..]

Prints meshes, vertices, polygons, materials, images, armatures, actions and shape keys, and ends with status 1 if a
pair differs or a file can't be opened.
"""

import contextlib
import io
import sys

import bpy


def counts(path):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    with contextlib.redirect_stdout(io.StringIO()):
        bpy.ops.import_scene.gltf(filepath=path, merge_vertices=False)
    data = bpy.data
    return {
        "meshes": len([o for o in data.objects if o.type == "MESH"]),
        "vertices": sum(len(o.data.vertices) for o in data.objects if o.type == "MESH"),
        "polygons": sum(len(o.data.polygons) for o in data.objects if o.type == "MESH"),
        "materials": len(data.materials),
        "images": len([i for i in data.images if i.name != "Render Result"]),
        "armatures": len(data.armatures),
        "actions": len(data.actions),
        "shape_keys": sum(len(k.key_blocks) for k in data.shape_keys),
    }


def main(paths):
    status = 0
    for before, after in zip(paths[::2], paths[1::2]):
        try:
            a, b = counts(before), counts(after)
        except RuntimeError as error:
            print("FAILED", after, str(error).strip().splitlines()[-1])
            status = 1
            continue
        print("same" if a == b else "DIFFERENT", before, a, "" if a == b else b)
        status |= a != b
    return status


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
