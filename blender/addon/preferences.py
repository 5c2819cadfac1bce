"""The add-on's preferences: the path of Pliant's program."""

import shutil

import bpy
from bpy.props import StringProperty


class PliantPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    program: StringProperty(
        name="Pliant",
        description="The program that opens meshes in its window; if empty, the one in PATH",
        subtype="FILE_PATH",
    )

    def draw(self, _context):
        self.layout.prop(self, "program")


def program():
    """The program's path."""
    addon = bpy.context.preferences.addons.get(__package__)
    chosen = addon.preferences.program if addon and addon.preferences else ""
    return bpy.path.abspath(chosen) or shutil.which("pliant") or "pliant"


CLASSES = [PliantPreferences]
