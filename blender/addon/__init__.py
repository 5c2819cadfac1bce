"""Pliant in Blender: the selected mesh is bent by the engine while empties, bones or hooks move, and baked to a shape
key; or it is opened in Pliant's window and comes back by the order of its vertices."""

import bpy

from . import live, operators, panel, preferences, settings

CLASSES = [*settings.CLASSES, *preferences.CLASSES, *operators.CLASSES, *panel.CLASSES]


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.Object.pliant = bpy.props.PointerProperty(type=settings.PliantSettings)
    live.listen()


def unregister():
    live.stop_listening()
    del bpy.types.Object.pliant
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
