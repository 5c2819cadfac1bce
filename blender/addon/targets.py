"""The transforms of the handles' targets: empties and other objects, bones of armatures, and hooks."""

import numpy as np

from .settings import Refused


def place(handle, depsgraph=None):
    """The world matrix of a handle's target."""
    target = handle.target
    if target is None:
        raise Refused(f"The handle \"{handle.group}\" has no target: choose the object that moves it")
    if depsgraph is not None:
        target = target.evaluated_get(depsgraph)
    if not handle.bone:
        return target.matrix_world.copy()
    bone = target.pose.bones.get(handle.bone) if target.pose else None
    if bone is None:
        raise Refused(f"{target.name} has no bone \"{handle.bone}\", which moves \"{handle.group}\": choose another one")
    return target.matrix_world @ bone.matrix


def motion(world_rest, world_now, world_from_object):
    """The motion of the object's own coordinates, as a numpy matrix, when a target moves from one place to another."""
    object_from_world = world_from_object.inverted_safe()
    moved = object_from_world @ world_now @ world_rest.inverted_safe() @ world_from_object
    matrix = np.array(moved, dtype=np.float64)
    matrix[3] = 0, 0, 0, 1
    return matrix


def rest(handle):
    """The place of a target that moves nothing: a bone's rest position in its armature, another object's present place."""
    now = place(handle)
    if not handle.bone:
        return now
    return handle.target.matrix_world @ handle.target.data.bones[handle.bone].matrix_local
