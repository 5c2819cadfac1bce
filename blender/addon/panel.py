"""The panel in the sidebar of the 3D view."""

import textwrap

import bpy

from . import live
from .settings import DECLARED, member


class PLIANT_UL_handles(bpy.types.UIList):
    def draw_item(self, _context, layout, _data, handle, _icon, _active_data, _active_property):
        layout.label(text=handle.group or "(no group)", icon="GROUP_VERTEX")
        moved_by = handle.target.name if handle.target else "(no target)"
        layout.label(text=f"{moved_by} / {handle.bone}" if handle.bone else moved_by)


class PLIANT_PT_bend(bpy.types.Panel):
    bl_idname = "PLIANT_PT_bend"
    bl_label = "Pliant"
    bl_category = "Pliant"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"

    @classmethod
    def poll(cls, context):
        return context.object is not None and context.object.type == "MESH"

    def draw(self, context):
        obj, layout = context.object, self.layout
        settings = obj.pliant
        session = live.session_of(obj)
        notice = live.notices.get(obj.session_uid)
        if notice:
            box = layout.column()
            box.alert = True
            for line in textwrap.wrap(notice, 40):
                box.label(text=line)
        layout.use_property_split = True
        what = layout.column()
        what.enabled = session is None
        what.prop(settings, "method")
        options = getattr(settings, member(settings.method), None)
        if options is not None:
            column = what.column(align=True)
            for option in DECLARED[settings.method]["options"]:
                column.prop(options, option)
        row = what.row()
        row.template_list("PLIANT_UL_handles", "", settings, "handles", settings, "active_handle", rows=3)
        buttons = row.column(align=True)
        buttons.operator("pliant.add_handle", text="", icon="ADD")
        buttons.operator("pliant.remove_handle", text="", icon="REMOVE")
        if settings.handles:
            handle = settings.handles[min(settings.active_handle, len(settings.handles) - 1)]
            what.prop_search(handle, "group", obj, "vertex_groups")
            what.prop(handle, "target")
            if handle.target and handle.target.type == "ARMATURE":
                what.prop_search(handle, "bone", handle.target.data, "bones")
            what.prop(handle, "is_soft")
            weight = what.column()
            weight.enabled = handle.is_soft
            weight.prop(handle, "weight")
        row = what.row(align=True)
        row.operator("pliant.find_handles", text="From Hooks").source = "HOOK"
        row.operator("pliant.find_handles", text="From Bones").source = "ARMATURE"
        what.prop_search(settings, "fixed", obj, "vertex_groups")
        what.prop_search(settings, "stiffness", obj, "vertex_groups")
        if settings.stiffness:
            what.prop(settings, "stiffest")
        if session is None:
            layout.operator("pliant.begin", icon="PLAY")
        else:
            state = "settled" if session.is_settled else "settling"
            layout.label(text=f"{session.milliseconds:.0f} ms a frame, {state}")
            row = layout.row(align=True)
            row.operator("pliant.bake", icon="CHECKMARK")
            row.operator("pliant.discard", icon="X")
            layout.operator("pliant.bake_frames", icon="RENDER_ANIMATION")
        row = layout.row(align=True)
        row.operator("pliant.open_window", icon="WINDOW")
        row.operator("pliant.import_shape", icon="IMPORT")


CLASSES = [PLIANT_UL_handles, PLIANT_PT_bend]
