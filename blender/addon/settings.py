"""The data kept with each object: the method, the handles and the edit's other members."""

import bpy
import numpy as np
import pliant
from bpy.props import (
    BoolProperty,
    CollectionProperty,
    EnumProperty,
    FloatProperty,
    FloatVectorProperty,
    IntProperty,
    PointerProperty,
    StringProperty,
)

DECLARED = pliant.methods()

# Blender needs the strings of an enumeration to live as long as it.
METHODS = [(name, own["title"], own["when_to_use"]) for name, own in DECLARED.items()]


def property_of(name, option):
    """A Blender property for an option that the engine declares. Its initial value is that of Pliant's window."""
    words = {"name": name.replace("_", " ").title(), "description": sentence(option)}
    first = option["first_choice"]
    if "choices" in option:
        items = [(str(own), str(own).replace("-", " ").title(), "") for own in option["choices"]]
        return EnumProperty(items=items, default=str(first), **words)
    if isinstance(first, bool):
        return BoolProperty(default=first, **words)
    low, high = option["range"]
    if isinstance(first, int):
        return IntProperty(default=first, min=int(low), max=int(high), **words)
    return FloatProperty(default=first, min=low, max=high, precision=4, **words)


def sentence(option):
    """An option's effect and values, in the form of Blender's tooltips: a capital first, no full stop."""
    help = option["help"][:1].upper() + option["help"][1:]
    return f"{help}. It is {option['allowed']} {option['unit']}".rstrip()


def member(method):
    """The name of the settings' member with the options of a method."""
    return "options_" + method.replace("-", "_")


# The options of each method that has some, as a group of properties.
OPTIONS = {
    method: type(
        "PliantOptions_" + method.replace("-", "_"),
        (bpy.types.PropertyGroup,),
        {"__annotations__": {name: property_of(name, option) for name, option in own["options"].items()}},
    )
    for method, own in DECLARED.items()
    if own["options"]
}


class PliantHandle(bpy.types.PropertyGroup):
    """A vertex group and its target."""

    group: StringProperty(name="Vertex Group", description="The vertices that the target moves")
    target: PointerProperty(
        type=bpy.types.Object, name="Target", description="The empty, armature or other object that moves them"
    )
    bone: StringProperty(name="Bone", description="The bone of the armature that moves them")
    is_soft: BoolProperty(name="Soft", description="The handle only pulls at its vertices")
    weight: FloatProperty(
        name="Weight", description="A larger weight pulls harder", default=1.0, min=1e-6, max=1e6, soft_max=100.0
    )
    # The target's world matrix at the beginning of live bending, row by row.
    rest_place: FloatVectorProperty(size=16, options={"HIDDEN"})


class PliantSettings(bpy.types.PropertyGroup):
    """The settings by which an object is bent."""

    method: EnumProperty(name="Method", description="The method that bends the surface", items=METHODS, default="arap")
    handles: CollectionProperty(type=PliantHandle)
    active_handle: IntProperty()
    fixed: StringProperty(name="Fixed", description="The vertex group of the fixed vertices")
    stiffness: StringProperty(name="Stiffness", description="The vertex group whose weights stiffen the surface")
    stiffest: FloatProperty(
        name="Maximum",
        description="The stiffness at the weight 1; it is 1 at the weight 0",
        default=10.0,
        min=0.001,
        max=1000.0,
    )
    # The shape key that the mesh is bent by live, and the modifiers that are hidden meanwhile, as JSON: kept with the
    # file, which may be saved in between.
    live_key: StringProperty(options={"HIDDEN"})
    hidden: StringProperty(options={"HIDDEN"})


for method, options in OPTIONS.items():
    PliantSettings.__annotations__[member(method)] = PointerProperty(type=options)

CLASSES = [*OPTIONS.values(), PliantHandle, PliantSettings]


class Refused(Exception):
    """One sentence that names the culprit and the remedy."""


def method_of(settings):
    """The method and its options, as `pliant.bind` takes them."""
    method = {"name": settings.method}
    for name, option in DECLARED[settings.method]["options"].items():
        value, default = getattr(getattr(settings, member(settings.method)), name), option["default"]
        if "choices" in option:
            value = type(default)(value)
        # Blender's numbers are single, so a default would not come back to the last digit.
        if value != (np.float32(default) if isinstance(default, float) else default):
            method[name] = value
    return method


def index_of(obj, name, what):
    """The index of a vertex group."""
    group = obj.vertex_groups.get(name)
    if group is None:
        raise Refused(f"{obj.name} has no vertex group \"{name}\", its {what}: choose another one")
    return group.index


def group_of(obj, name, what):
    """The weight of each vertex in a vertex group, 0 outside of it."""
    index = index_of(obj, name, what)
    return weights(obj.data, {index})[index]


def weights(mesh, wanted):
    """The weights of all vertices in each of the given vertex groups, 0 outside of it, read in one pass."""
    found = {index: np.zeros(len(mesh.vertices)) for index in wanted}
    for vertex, of_vertex in enumerate(mesh.vertices):
        for own in of_vertex.groups:
            if own.group in found:
                found[own.group][vertex] = own.weight
    return found


def region_of(obj):
    """The arguments of `pliant.bind` beside the mesh and the method: handles, fixed vertices and stiffness."""
    if not obj.pliant.handles:
        raise Refused(f"{obj.name} has no handle: add one, and choose its vertex group and its target")
    return parts_of(obj)


def parts_of(obj):
    """The same for an object that may have no handle yet."""
    settings = obj.pliant
    named = [(handle.group, "handle") for handle in settings.handles]
    named += [(name, what) for name, what in ((settings.fixed, "fixed part"), (settings.stiffness, "stiffness")) if name]
    indices = {name: index_of(obj, name, what) for name, what in named}
    found = weights(obj.data, set(indices.values()))
    of_group = {name: found[index] for name, index in indices.items()}
    handles = {}
    for handle in settings.handles:
        select = of_group[handle.group] >= 0.5
        if not select.any():
            raise Refused(f"No vertex weighs 0.5 or more in the vertex group \"{handle.group}\": assign some")
        if handle.group in handles:
            raise Refused(f"Two handles have the vertex group \"{handle.group}\": remove one of them")
        handles[handle.group] = {"select": select, **({"soft": handle.weight} if handle.is_soft else {})}
    arguments = {"handles": handles}
    if settings.fixed:
        arguments["fixed"] = of_group[settings.fixed] >= 0.5
    if settings.stiffness:
        arguments["stiffness"] = settings.stiffest ** of_group[settings.stiffness]
    return arguments
