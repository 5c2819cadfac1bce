"""Live bending: one session an object, which lasts until it is baked or given up."""

import time

import bpy
import numpy as np
import pliant
from bpy.app.handlers import persistent

from . import targets
from .settings import Refused, method_of, region_of

KEY = "Pliant"

# The modifiers whose targets handles may have.
MOVERS = {"HOOK", "ARMATURE"}

# How long a method that iterates may take before Blender draws again, in seconds.
FRAME = 0.03

# By the objects' session numbers: names change, and pointers move.
sessions = {}


class Session:
    """A bound mesh, and the shape key that it writes to."""

    def __init__(self, obj):
        if obj.type != "MESH" or obj.mode != "OBJECT":
            raise Refused(f"{obj.name} is no mesh in object mode: select one, and press Tab to leave edit mode")
        mesh = obj.data
        self.number, self.name = obj.session_uid, obj.name
        self.rest = np.empty((len(mesh.vertices), 3), np.float32)
        mesh.vertices.foreach_get("co", self.rest.ravel())
        mesh.calc_loop_triangles()
        corners = np.empty((len(mesh.loop_triangles), 3), np.int32)
        mesh.loop_triangles.foreach_get("vertices", corners.ravel())
        self.places = {handle.group: targets.rest(handle) for handle in obj.pliant.handles}
        self.bound = pliant.bind(self.rest, corners, method=method_of(obj.pliant), **region_of(obj))
        self.shape = self.rest.copy()
        self.seen = None
        self.is_settled = True
        self.milliseconds = 0.0
        if mesh.shape_keys is None:
            obj.shape_key_add(name="Basis", from_mix=False)
        key = obj.shape_key_add(name=KEY, from_mix=False)
        key.value = 1.0
        self.key_name = key.name
        # What moved the mesh so far would move it twice.
        self.muted = {own.name: (own.show_viewport, own.show_render) for own in obj.modifiers if own.type in MOVERS}
        self.show(obj, {name: (False, False) for name in self.muted})

    @property
    def object(self):
        """The object, which is another one in memory after each undo."""
        obj = bpy.data.objects.get(self.name)
        if obj is None or obj.session_uid != self.number:
            obj = next((own for own in bpy.data.objects if own.session_uid == self.number), None)
            if obj is None:
                raise Refused(f"{self.name} is gone, so it is bent no longer: bend another mesh")
            self.name = obj.name
        return obj

    @staticmethod
    def show(obj, modifiers):
        """Sets where modifiers are shown, by their names."""
        for name, (in_viewport, in_render) in modifiers.items():
            if name in obj.modifiers:
                obj.modifiers[name].show_viewport, obj.modifiers[name].show_render = in_viewport, in_render

    def transforms(self, depsgraph):
        """How each handle moves, in the object's own coordinates."""
        obj = self.object
        world_from_object = obj.evaluated_get(depsgraph).matrix_world
        return {
            handle.group: targets.motion(self.places[handle.group], targets.place(handle, depsgraph), world_from_object)
            for handle in obj.pliant.handles
            if handle.group in self.places
        }

    def follow(self, depsgraph):
        """Takes the shape a frame further towards where the targets are. Whether it has changed."""
        moved = self.transforms(depsgraph)
        is_new = self.seen is None or any(not np.array_equal(moved[name], self.seen.get(name)) for name in moved)
        if self.is_settled and not is_new:
            return False
        self.seen = moved
        start = time.perf_counter()
        while True:
            self.bound.step(moved, iterations=1, out=self.shape)
            self.is_settled = self.bound.converged
            if self.is_settled or time.perf_counter() - start > FRAME:
                break
        self.milliseconds = (time.perf_counter() - start) * 1e3
        self.write()
        return True

    def settle(self, depsgraph):
        """Takes the shape all the way to where the targets are."""
        self.seen = self.transforms(depsgraph)
        self.bound.step(self.seen, out=self.shape)
        self.is_settled = True
        self.write()

    def write(self):
        """Puts the shape into the shape key."""
        mesh = self.object.data
        mesh.shape_keys.key_blocks[self.key_name].data.foreach_set("co", self.shape.ravel())
        mesh.update_tag()

    def end(self, keep):
        """Leaves the object without the session: with its shape, or as it was."""
        obj = self.object
        key = obj.data.shape_keys and obj.data.shape_keys.key_blocks.get(self.key_name)
        if not keep:
            if key is not None:
                obj.shape_key_remove(key)
            blocks = obj.data.shape_keys and obj.data.shape_keys.key_blocks
            if blocks and len(blocks) == 1:
                obj.shape_key_clear()
            self.show(obj, self.muted)
        obj.data.update()


def session_of(obj):
    """The session of an object, if it has one."""
    return sessions.get(obj.session_uid) if obj is not None else None


def begin(obj):
    """Binds an object and follows its targets from now on."""
    if session_of(obj) is not None:
        raise Refused(f"{obj.name} is bent live already: bake it or give it up first")
    sessions[obj.session_uid] = Session(obj)
    if not bpy.app.timers.is_registered(settle_further):
        bpy.app.timers.register(settle_further, first_interval=FRAME)
    return sessions[obj.session_uid]


def end(obj, keep):
    """Ends the session of an object."""
    sessions.pop(obj.session_uid).end(keep)
    if not sessions:
        stop_settling()


def follow_all(depsgraph):
    """Has every session follow its targets; one whose object or handle is gone ends. Whether a shape has changed."""
    has_changed = False
    for number, session in list(sessions.items()):
        try:
            has_changed |= session.follow(depsgraph)
        except (ReferenceError, KeyError, AttributeError, Refused):
            del sessions[number]
        except ValueError as error:
            # A target that is scaled to nothing, for example: the shape waits for a better one.
            print(f"Pliant: {error}")
    return has_changed


@persistent
def targets_may_have_moved(_scene, depsgraph=None):
    if sessions:
        follow_all(depsgraph or bpy.context.evaluated_depsgraph_get())


@persistent
def another_file_is_loaded(_file):
    sessions.clear()
    # Blender drops its timers with the old file, and crashes at its end if one of them was Python's.
    stop_settling()


def settle_further():
    """Goes on with shapes that have not converged, while nothing moves."""
    if not sessions:
        return None
    if any(not session.is_settled for session in sessions.values()):
        follow_all(bpy.context.evaluated_depsgraph_get())
    return FRAME


def stop_settling():
    """Takes the timer away."""
    if bpy.app.timers.is_registered(settle_further):
        bpy.app.timers.unregister(settle_further)


LISTENERS = [
    (bpy.app.handlers.depsgraph_update_post, targets_may_have_moved),
    (bpy.app.handlers.frame_change_post, targets_may_have_moved),
    (bpy.app.handlers.load_pre, another_file_is_loaded),
]


def listen():
    for handlers, listener in LISTENERS:
        handlers.append(listener)


def stop_listening():
    for session in list(sessions.values()):
        try:
            session.end(keep=True)
        except Refused:
            pass
    sessions.clear()
    for handlers, listener in LISTENERS:
        if listener in handlers:
            handlers.remove(listener)
    stop_settling()
