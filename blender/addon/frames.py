"""Baking a range of frames to shape keys, each active in one frame, or to a point cache."""

import struct
from pathlib import Path

import bpy

from . import live, shape_keys
from .settings import Refused

MODIFIER = "Pliant"


def shapes(obj, first, last):
    """The positions of the vertices in each frame. Blender returns to the present frame at the end."""
    scene, present = bpy.context.scene, bpy.context.scene.frame_current
    try:
        for frame in range(first, last + 1):
            scene.frame_set(frame)
            session = live.session_of(obj)
            if session is None:
                raise Refused(live.notices.get(obj.session_uid) or f"{obj.name} is no longer bent: press Bend Live")
            if obj.session_uid in live.notices:
                raise Refused(f"Frame {frame}: {live.notices[obj.session_uid]}")
            yield frame, session.shape.copy()
    finally:
        scene.frame_set(present)


def to_keys(obj, first, last):
    """Makes a shape key for each frame, which is active only in that frame and fades to its neighbours."""
    session = live.session_of(obj)
    baked = list(shapes(obj, first, last))
    live.end(obj, keep=True)
    shape_keys.remove(obj, session.key_name)
    for frame, shape in baked:
        key = shape_keys.add(obj, f"{live.KEY} {frame}")
        shape_keys.write(obj, key.name, shape, session.others)
        # The first shape holds before its frame, and the last one after it.
        for at, value in ((frame - 1, 0.0), (frame, 1.0), (frame + 1, 0.0)):
            if first <= at <= last:
                key.value = value
                key.keyframe_insert("value", frame=at)
        key.value = float(frame == first)
    for curve in curves(obj.data.shape_keys):
        for point in curve.keyframe_points:
            point.interpolation = "LINEAR"
    bpy.context.scene.frame_set(bpy.context.scene.frame_current)


def curves(keys):
    """The animation curves of shape keys in this version of Blender."""
    action = keys.animation_data.action
    if hasattr(action, "fcurves"):
        return list(action.fcurves)
    return [curve for layer in action.layers for strip in layer.strips for bag in strip.channelbags for curve in bag.fcurves]


def to_cache(obj, first, last, path):
    """Writes a PC2 file, which a Mesh Cache modifier before all others plays."""
    file = Path(bpy.path.abspath(path))
    count = len(obj.data.vertices)
    beside = file.with_name(file.name + ".part")
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        with open(beside, "wb") as out:
            out.write(struct.pack("<12siiffi", b"POINTCACHE2", 1, count, first, 1.0, last - first + 1))
            for _, shape in shapes(obj, first, last):
                out.write(shape.astype("<f4").tobytes())
        beside.replace(file)
    finally:
        beside.unlink(missing_ok=True)
    name = live.session_of(obj).key_name
    live.end(obj, keep=True)
    shape_keys.remove(obj, name)
    modifier = obj.modifiers.get(MODIFIER) or obj.modifiers.new(MODIFIER, "MESH_CACHE")
    modifier.cache_format, modifier.filepath, modifier.frame_start = "PC2", path, first
    obj.modifiers.move(obj.modifiers.find(modifier.name), 0)
