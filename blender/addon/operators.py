"""The operators of the add-on. Blender reports their refusals."""

import bpy
from bpy.props import EnumProperty, IntProperty, StringProperty

from . import exchange, frames, live
from .settings import Refused


# Since 4.5 Blender asks which paths may begin at its own file.
BESIDE_THE_FILE = {"PATH_SUPPORTS_BLEND_RELATIVE"} if bpy.app.version >= (4, 5) else set()


class PliantOperator:
    """An operator on the active mesh, which reports a refusal as an error."""

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
    """Makes handles of the mesh's hooks, or of its armature's bones with vertex groups"""

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
    """Keeps the settled shape as a shape key and ends bending"""

    bl_idname = "pliant.bake"
    bl_label = "Bake to Shape Key"

    @classmethod
    def poll(cls, context):
        return live.session_of(context.object) is not None

    def act(self, context, obj):
        live.session_of(obj).settle(context.evaluated_depsgraph_get())
        live.end(obj, keep=True)


class PLIANT_OT_bake_frames(PliantOperator, bpy.types.Operator):
    """Keeps the settled shape of each frame of a range and ends bending"""

    bl_idname = "pliant.bake_frames"
    bl_label = "Bake Frames"

    first: IntProperty(name="Start", description="The first frame", default=1)
    last: IntProperty(name="End", description="The last frame", default=250)
    into: EnumProperty(
        name="To",
        items=[
            ("KEYS", "Shape Keys", "One shape key for each frame, with its value animated"),
            ("CACHE", "Point Cache", "A PC2 file, which a Mesh Cache modifier plays"),
        ],
    )
    filepath: StringProperty(
        name="File", description="The PC2 file", subtype="FILE_PATH", default="//pliant.pc2", options=BESIDE_THE_FILE
    )

    @classmethod
    def poll(cls, context):
        return live.session_of(context.object) is not None

    def invoke(self, context, _event):
        self.first, self.last = context.scene.frame_start, context.scene.frame_end
        self.filepath = f"//{bpy.path.clean_name(context.object.name)}.pc2"
        return context.window_manager.invoke_props_dialog(self)

    def act(self, _context, obj):
        if self.last < self.first:
            raise Refused(f"The range ends at frame {self.last}, before frame {self.first}: choose a later end")
        if self.into == "KEYS":
            frames.to_keys(obj, self.first, self.last)
            return
        if self.filepath.startswith("//") and not bpy.data.filepath:
            raise Refused("The PC2 file belongs beside the .blend file, which is not saved yet: save it first")
        frames.to_cache(obj, self.first, self.last, self.filepath)


class PLIANT_OT_discard(PliantOperator, bpy.types.Operator):
    """Ends bending and restores the mesh"""

    bl_idname = "pliant.discard"
    bl_label = "Discard"

    @classmethod
    def poll(cls, context):
        return live.session_of(context.object) is not None

    def act(self, _context, obj):
        live.end(obj, keep=False)


class PLIANT_OT_open_window(PliantOperator, bpy.types.Operator):
    """Opens the mesh with its handles in Pliant's window. Save it there, then import the shape"""

    bl_idname = "pliant.open_window"
    bl_label = "Open in Pliant"
    bl_options = {"REGISTER"}

    def act(self, context, obj):
        file = exchange.open_window(obj, context.evaluated_depsgraph_get())
        self.report({"INFO"}, f"Opened {file.name}: save it in Pliant, then import the shape")


class PLIANT_OT_import_shape(PliantOperator, bpy.types.Operator):
    """Imports the shape saved in Pliant's window as a shape key, vertex by vertex"""

    bl_idname = "pliant.import_shape"
    bl_label = "Import Shape"

    def act(self, _context, obj):
        exchange.import_shape(obj)


CLASSES = [
    PLIANT_OT_add_handle,
    PLIANT_OT_remove_handle,
    PLIANT_OT_find_handles,
    PLIANT_OT_begin,
    PLIANT_OT_bake,
    PLIANT_OT_bake_frames,
    PLIANT_OT_discard,
    PLIANT_OT_open_window,
    PLIANT_OT_import_shape,
]
