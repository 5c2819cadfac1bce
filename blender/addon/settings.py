"""What is kept with each object: the method, the handles and what else an edit has."""

import json

import bpy
import numpy as np
import pliant
from bpy.props import (
    BoolProperty,
    CollectionProperty,
    EnumProperty,
    FloatProperty,
    IntProperty,
    PointerProperty,
    StringProperty,
)

# Blender needs the strings of an enumeration to live as long as it.
METHODS = [(name, own["title"], own["when_to_use"]) for name, own in pliant.methods().items()]


class PliantHandle(bpy.types.PropertyGroup):
    """A vertex group, and what moves it."""

    group: StringProperty(name="Vertex Group", description="The vertices that the target moves")
    target: PointerProperty(
        type=bpy.types.Object, name="Target", description="The empty, the armature or any object that moves them"
    )
    bone: StringProperty(name="Bone", description="The bone of the armature that moves them")
    is_soft: BoolProperty(name="Soft", description="The handle only pulls at its vertices")
    weight: FloatProperty(
        name="Weight", description="How firmly a soft handle pulls", default=1.0, min=1e-6, max=1e6, soft_max=100.0
    )


class PliantSettings(bpy.types.PropertyGroup):
    """How an object is bent."""

    method: EnumProperty(name="Method", description="How the surface follows its handles", items=METHODS, default="arap")
    options: StringProperty(
        name="Options",
        description='The method\'s options as in the edit format, e.g. "energy": "smooth", "smoothness": 0.1',
        default="",
    )
    handles: CollectionProperty(type=PliantHandle)
    active_handle: IntProperty()
    fixed: StringProperty(name="Fixed", description="The vertex group that is held still")
    stiffness: StringProperty(name="Stiffness", description="The vertex group whose weights stiffen the surface")
    stiffest: FloatProperty(
        name="Stiffest", description="The stiffness at the weight 1; it is 1 at the weight 0", default=10.0, min=0.001, max=1000.0
    )


CLASSES = [PliantHandle, PliantSettings]


class Refused(Exception):
    """One sentence that names the culprit and the remedy."""


def method_of(settings):
    """The method and its options, as `pliant.bind` takes them."""
    try:
        options = json.loads("{" + settings.options + "}")
    except ValueError as error:
        raise Refused(f"The options can't be read ({error}): write them as \"energy\": \"smooth\"") from error
    return {"name": settings.method, **options}


def group_of(obj, name, what):
    """The weight of each vertex in a vertex group."""
    group = obj.vertex_groups.get(name)
    if group is None:
        raise Refused(f"{obj.name} has no vertex group \"{name}\", which is its {what}: choose another one")
    return weights(obj.data, group.index)


def weights(mesh, index):
    """The weight of each vertex in the vertex group of this index, 0 outside of it."""
    found = np.zeros(len(mesh.vertices))
    for vertex in mesh.vertices:
        for own in vertex.groups:
            if own.group == index:
                found[vertex.index] = own.weight
    return found


def region_of(obj):
    """The arguments of `pliant.bind` beside the mesh and the method: handles, fixed vertices and stiffness."""
    if not obj.pliant.handles:
        raise Refused(f"{obj.name} has no handle: add one, and choose its vertex group and its target")
    return parts_of(obj)


def parts_of(obj):
    """The same, of an object that may have no handle yet."""
    settings = obj.pliant
    handles = {}
    for handle in settings.handles:
        select = group_of(obj, handle.group, "handle") >= 0.5
        if not select.any():
            raise Refused(f"No vertex weighs 0.5 or more in the vertex group \"{handle.group}\": assign some")
        if handle.group in handles:
            raise Refused(f"Two handles have the vertex group \"{handle.group}\": remove one of them")
        handles[handle.group] = {"select": select, **({"soft": handle.weight} if handle.is_soft else {})}
    arguments = {"handles": handles}
    if settings.fixed:
        arguments["fixed"] = group_of(obj, settings.fixed, "fixed part") >= 0.5
    if settings.stiffness:
        weight = group_of(obj, settings.stiffness, "stiffness")
        arguments["stiffness"] = settings.stiffest ** weight
    return arguments
