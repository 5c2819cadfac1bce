"""What a person can do: each is one operator, whose refusals are shown where Blender shows them."""

import bpy
from bpy.props import EnumProperty

from . import exchange, live
from .settings import Refused


class PliantOperator:
    """On the active mesh; a refusal is reported as an error."""

    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return context.object is not None and context.object.type == "MESH"

    def execute(self, context):
        try:
            self.act(context, context.object)
        except (Refused, ValueError, OSError) as refusal:
            self.report({"ERROR"}, str(refusal))
            return {"CANCELLED"}
        return {"FINISHED"}


class PLIANT_OT_add_handle(PliantOperator, bpy.types.Operator):
    """Adds a handle: the active vertex group, moved by the other selected object"""

    bl_idname = "pliant.add_handle"
    bl_label = "Add Handle"

    def act(self, context, obj):
        handle = obj.pliant.handles.add()
        if obj.vertex_groups.active:
            handle.group = obj.vertex_groups.active.name
        others = [other for other in context.selected_objects if other is not obj]
        if others:
            handle.target = others[0]
            if others[0].type == "ARMATURE" and others[0].data.bones.active:
                handle.bone = others[0].data.bones.active.name
        obj.pliant.active_handle = len(obj.pliant.handles) - 1


class PLIANT_OT_remove_handle(PliantOperator, bpy.types.Operator):
    """Removes the chosen handle"""

    bl_idname = "pliant.remove_handle"
    bl_label = "Remove Handle"

    def act(self, _context, obj):
        obj.pliant.handles.remove(obj.pliant.active_handle)
        obj.pliant.active_handle = max(0, min(obj.pliant.active_handle, len(obj.pliant.handles) - 1))


class PLIANT_OT_find_handles(PliantOperator, bpy.types.Operator):
    """Makes handles of the mesh's hooks or of the bones that its armature has vertex groups for"""

    bl_idname = "pliant.find_handles"
    bl_label = "Handles from Modifiers"

    source: EnumProperty(
        name="From",
        items=[
            ("HOOK", "Hooks", "The vertex group and the object of each Hook modifier"),
            ("ARMATURE", "Bones", "The bones of the Armature modifier that have vertex groups"),
        ],
    )

    def act(self, _context, obj):
        found = []
        for modifier in obj.modifiers:
            if modifier.type == self.source == "HOOK" and modifier.object:
                found.append((modifier.vertex_group, modifier.object, modifier.subtarget))
            elif modifier.type == self.source == "ARMATURE" and modifier.object:
                bones = modifier.object.data.bones
                found += [(bone.name, modifier.object, bone.name) for bone in bones if bone.name in obj.vertex_groups]
        found = [own for own in found if own[0]]
        if not found:
            what = "hook with a vertex group" if self.source == "HOOK" else "bone with a vertex group"
            raise Refused(f"{obj.name} has no {what}: add the modifier and the vertex group first")
        obj.pliant.handles.clear()
        for group, target, bone in found:
            handle = obj.pliant.handles.add()
            handle.group, handle.target, handle.bone = group, target, bone


class PLIANT_OT_begin(PliantOperator, bpy.types.Operator):
    """Bends the mesh live while the targets of its handles move"""

    bl_idname = "pliant.begin"
    bl_label = "Bend Live"

    def act(self, _context, obj):
        session = live.begin(obj)
        for warning in session.bound.warnings:
            self.report({"WARNING"}, warning)


class PLIANT_OT_bake(PliantOperator, bpy.types.Operator):
    """Keeps the shape, settled, as a shape key, and ends bending"""

    bl_idname = "pliant.bake"
    bl_label = "Bake to Shape Key"

    @classmethod
    def poll(cls, context):
        return live.session_of(context.object) is not None

    def act(self, context, obj):
        live.session_of(obj).settle(context.evaluated_depsgraph_get())
        live.end(obj, keep=True)


class PLIANT_OT_cancel(PliantOperator, bpy.types.Operator):
    """Ends bending and leaves the mesh as it was"""

    bl_idname = "pliant.cancel"
    bl_label = "Give Up"

    @classmethod
    def poll(cls, context):
        return live.session_of(context.object) is not None

    def act(self, _context, obj):
        live.end(obj, keep=False)


class PLIANT_OT_open_window(PliantOperator, bpy.types.Operator):
    """Opens the mesh with its handles in Pliant's window. Save it there, then take the shape back"""

    bl_idname = "pliant.open_window"
    bl_label = "Open in Pliant"
    bl_options = {"REGISTER"}

    def act(self, context, obj):
        file = exchange.open_window(obj, context.evaluated_depsgraph_get())
        self.report({"INFO"}, f"Opened {file.name}: save it in Pliant, then take the shape back")


class PLIANT_OT_take_back(PliantOperator, bpy.types.Operator):
    """Takes what was saved in Pliant's window as a shape key, vertex by vertex"""

    bl_idname = "pliant.take_back"
    bl_label = "Take Shape Back"

    def act(self, _context, obj):
        exchange.take_back(obj)


CLASSES = [
    PLIANT_OT_add_handle,
    PLIANT_OT_remove_handle,
    PLIANT_OT_find_handles,
    PLIANT_OT_begin,
    PLIANT_OT_bake,
    PLIANT_OT_cancel,
    PLIANT_OT_open_window,
    PLIANT_OT_take_back,
]
