"""How many frames a second an empty bends a scan's hand at, with Pliant and with Blender's Laplacian Deform in the same
run: measure.py [BENT.obj], which keeps the baked shape."""

import os
import statistics
import sys
import time

import bpy
import numpy as np
import pliant

from scene import SCANS, group, hand, load_addon, select, shown, stored

FRAMES = 30


def main():
    load_addon()
    scan = pliant.load(SCANS / "armadillo.obj")
    obj, target = hand(scan)
    rest, place = stored(obj.data), np.array(target.location)
    size = float(np.linalg.norm(np.ptp(rest, axis=0)))

    def put(t):
        target.location = place + size * 0.12 * t * np.array([0.2, 1, 0.3])
        target.rotation_euler = (0, 0, 0.9 * t)

    def drag():
        """The times of frames: from the move of the empty to the mesh that Blender draws."""
        times = []
        for frame in range(1, FRAMES + 1):
            start = time.perf_counter()
            put(frame / FRAMES)
            bpy.context.view_layer.update()
            shape = shown(obj)
            times.append((time.perf_counter() - start) * 1e3)
        assert np.abs(shape - rest).max() > size * 0.1
        return times

    def tell(name, bind_ms, times):
        median = statistics.median(times)
        print(
            f"{name:34} bind {bind_ms:6.0f} ms, frame {median:6.1f} ms (at most {max(times):.1f}): {1e3 / median:.1f} a second",
            flush=True,
        )

    print(f"{len(rest)} vertices, {os.cpu_count()} processors, Blender {bpy.app.version_string}")
    for method, options in (("bilaplacian", {}), ("arap", {"energy": "spokes-and-rims"}), ("arap", {"energy": "smooth"})):
        put(0)
        bpy.context.view_layer.update()
        obj.pliant.method = method
        for name, value in options.items():
            setattr(obj.pliant.options_arap, name, value)
        start = time.perf_counter()
        bpy.ops.pliant.begin()
        bind_ms = (time.perf_counter() - start) * 1e3
        tell(f"Pliant, {method} {' '.join(options.values())}", bind_ms, drag())
        bpy.ops.pliant.bake()
        if len(sys.argv) > 1:
            pliant.save(sys.argv[1], scan, shown(obj))
        obj.shape_key_clear()

    # Blender's own modifier, moved by a hook on the same empty.
    put(0)
    bpy.context.view_layer.update()
    select(obj)
    held = {group.index for group in obj.vertex_groups}
    anchors = [vertex.index for vertex in obj.data.vertices if any(own.group in held for own in vertex.groups)]
    group(obj, "anchors", anchors)
    hook = obj.modifiers.new("hook", "HOOK")
    hook.object, hook.vertex_group = target, "hand"
    hook.matrix_inverse = target.matrix_world.inverted() @ obj.matrix_world
    own = obj.modifiers.new("laplacian", "LAPLACIANDEFORM")
    own.vertex_group, own.iterations = "anchors", 1
    start = time.perf_counter()
    bpy.ops.object.laplaciandeform_bind(modifier="laplacian")
    bind_ms = (time.perf_counter() - start) * 1e3
    assert own.is_bind
    tell("Blender, Laplacian Deform", bind_ms, drag())


main()
