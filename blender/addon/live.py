"""Live bending: one session an object, which lasts until it is baked or discarded. What a session needs beside the mesh
is kept with the object, so that one goes on when its file is opened again."""

import json
import time

import bpy
import numpy as np
import pliant
from bpy.app.handlers import persistent
from mathutils import Matrix

from . import shape_keys, targets
from .settings import Refused, method_of, region_of

KEY = "Pliant"

# The modifiers whose targets handles may have.
MOVERS = {"HOOK", "ARMATURE"}

# The most seconds that an iterative method may take before Blender draws again.
FRAME = 0.03

# By the objects' session numbers: names change, and pointers move.
sessions = {}

# The panel's message about an object, by the same numbers: the reason why a session has ended or waits.
notices = {}


class Session:
    """A bound mesh, and the shape key that it writes to."""

    def __init__(self, obj):
        """Begins to bend an object from its visible shape."""
        check(obj)
        others = shape_keys.seen(obj)
        for handle in obj.pliant.handles:
            handle.rest_place = [number for row in targets.rest(handle) for number in row]
        self.bind(obj, others)
        self.key_name = shape_keys.add(obj, KEY).name
        # The modifiers that moved the mesh so far would move it twice.
        hidden = {own.name: (own.show_viewport, own.show_render) for own in obj.modifiers if own.type in MOVERS}
        obj.pliant.live_key, obj.pliant.hidden = self.key_name, json.dumps(hidden)
        show(obj, {name: (False, False) for name in hidden})
        self.write()

    @classmethod
    def resumed(cls, obj):
        """Goes on with the session that an object had when its file was saved."""
        check(obj)
        session = cls.__new__(cls)
        keys = obj.data.shape_keys
        if keys is None or obj.pliant.live_key not in keys.key_blocks:
            raise Refused(f"{obj.name} has no shape key \"{obj.pliant.live_key}\", which bending needs: press Bend Live")
        session.bind(obj, shape_keys.seen(obj, without=obj.pliant.live_key))
        session.key_name = obj.pliant.live_key
        return session

    def bind(self, obj, others):
        """Binds the mesh in the shape of the other shape keys."""
        mesh = obj.data
        self.number, self.name, self.others = obj.session_uid, obj.name, others
        mesh.calc_loop_triangles()
        corners = np.empty((len(mesh.loop_triangles), 3), np.int32)
        mesh.loop_triangles.foreach_get("vertices", corners.ravel())
        self.places = {handle.group: place_of(handle) for handle in obj.pliant.handles}
        self.bound = pliant.bind(others, corners, method=method_of(obj.pliant), **region_of(obj))
        # A step with transforms (here those of rest) warns about parts without a fixed vertex: positions could
        # hold them.
        self.bound.step({}, iterations=1)
        self.shape = others.copy()
        self.counts = counts(mesh)
        self.seen = None
        self.is_settled = True
        # Whether the shape depends on the frames that were played before.
        self.is_played = False
        self.milliseconds = 0.0

    @property
    def object(self):
        """The object, whose place in memory changes with each undo."""
        obj = bpy.data.objects.get(self.name)
        if obj is None or obj.session_uid != self.number:
            obj = next((own for own in bpy.data.objects if own.session_uid == self.number), None)
            if obj is None:
                raise Refused(f"{self.name} no longer exists: bend another mesh")
            self.name = obj.name
        return obj

    def check(self):
        """Refuses to go on with a mesh that is or was edited."""
        obj = self.object
        if obj.mode == "EDIT" or counts(obj.data) != self.counts:
            raise Refused(f"{obj.name} was edited, which ended its live bending and kept the shape: "
                          "press Bend Live to go on")

    def transforms(self, depsgraph):
        """The motion of each handle in the object's own coordinates."""
        obj = self.object
        world_from_object = obj.evaluated_get(depsgraph).matrix_world
        return {
            handle.group: targets.motion(self.places[handle.group], targets.place(handle, depsgraph), world_from_object)
            for handle in obj.pliant.handles
            if handle.group in self.places
        }

    def follow(self, depsgraph):
        """Takes one step of the shape towards the targets. Returns true if it changed."""
        self.check()
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
        """Settles the shape at the targets, from its present state."""
        self.check()
        self.seen = self.transforms(depsgraph)
        self.bound.step(self.seen, out=self.shape)
        self.is_settled = True
        self.write()

    def settle_from_rest(self, depsgraph):
        """The same from rest, so that a frame's shape does not depend on the frames before it."""
        self.check()
        # Handles that are not named are at rest.
        self.bound.step({}, iterations=1)
        self.settle(depsgraph)
        self.is_played = False

    def write(self):
        """Puts the shape into the shape key."""
        shape_keys.write(self.object, self.key_name, self.shape, self.others)


def check(obj):
    """Refuses objects that can't be bent."""
    if obj.type != "MESH" or obj.mode != "OBJECT":
        raise Refused(f"{obj.name} is not a mesh in object mode: select a mesh, and press Tab to leave edit mode")
    if obj.data.users > 1:
        raise Refused(f"{obj.name} shares its mesh with other objects: choose Object, Relations, Make Single User, "
                      "Object & Data first")


def counts(mesh):
    """The data that an edit of a mesh changes."""
    return len(mesh.vertices), len(mesh.edges), len(mesh.loops), len(mesh.polygons)


def place_of(handle):
    """The world matrix of a handle's target at the beginning of bending."""
    numbers = list(handle.rest_place)
    return Matrix([numbers[4 * row : 4 * row + 4] for row in range(4)])


def show(obj, modifiers):
    """Sets the visibility of modifiers by their names."""
    for name, (in_viewport, in_render) in modifiers.items():
        if name in obj.modifiers:
            obj.modifiers[name].show_viewport, obj.modifiers[name].show_render = in_viewport, in_render


def session_of(obj):
    """The session of an object, if it has one."""
    return sessions.get(obj.session_uid) if obj is not None else None


def begin(obj):
    """Binds an object and follows its targets from now on."""
    if session_of(obj) is not None:
        raise Refused(f"{obj.name} is already bent live: bake or discard the shape first")
    return take(obj, Session(obj))


def take(obj, session):
    """Gives a session to its object."""
    sessions[obj.session_uid] = session
    notices.pop(obj.session_uid, None)
    if not bpy.app.timers.is_registered(settle_further):
        bpy.app.timers.register(settle_further, first_interval=FRAME)
    return session


def end(obj, keep):
    """Ends the session of an object, which keeps its shape or returns to the earlier one."""
    sessions.pop(obj.session_uid, None)
    notices.pop(obj.session_uid, None)
    settings = obj.pliant
    if not keep:
        shape_keys.remove(obj, settings.live_key)
        show(obj, json.loads(settings.hidden or "{}"))
    settings.live_key = settings.hidden = ""
    obj.data.update()
    if not sessions:
        stop_settling()


def each(act):
    """Calls an action on every session and ends those that can't go on. Returns true if a shape changed."""
    has_changed = False
    for number, session in list(sessions.items()):
        try:
            if session.object.pliant.live_key != session.key_name:
                # Its beginning was undone.
                del sessions[number]
                continue
            has_changed |= bool(act(session))
            notices.pop(number, None)
        except Refused as refusal:
            stop(number, session, str(refusal))
        except (ReferenceError, KeyError, AttributeError):
            stop(number, session, f"{session.name} lost its shape key or a handle: press Bend Live")
        except ValueError as error:
            # A target that is scaled to nothing, for example: the shape waits for a better one.
            notices[number] = str(error)
    return has_changed


def stop(number, session, why):
    """Ends a session that can't go on, with the reason."""
    sessions.pop(number, None)
    try:
        end(session.object, keep=True)
    except (Refused, ReferenceError):
        pass
    notices[number] = why


def resume():
    """Goes on with the objects that were bent live when their file was saved; one where that can't be is as it was
    before."""
    for obj in bpy.data.objects:
        if obj.library is not None or not obj.pliant.live_key or session_of(obj) is not None:
            continue
        try:
            take(obj, Session.resumed(obj))
        except (Refused, ValueError) as refusal:
            end(obj, keep=False)
            notices[obj.session_uid] = f"Bending could not go on in the opened file and was discarded: {refusal}"


def is_playing():
    """True while frames follow each other on the screen, where a late frame is worse than an unsettled one."""
    screen = getattr(bpy.context, "screen", None)
    return screen is not None and screen.is_animation_playing and not bpy.app.is_job_running("RENDER")


@persistent
def targets_may_have_moved(_scene, depsgraph=None):
    if sessions:
        depsgraph = depsgraph or bpy.context.evaluated_depsgraph_get()
        each(lambda session: session.follow(depsgraph))


@persistent
def frame_has_changed(_scene, depsgraph=None):
    if not sessions:
        return
    depsgraph = depsgraph or bpy.context.evaluated_depsgraph_get()

    def play(session):
        session.is_played = True
        return session.follow(depsgraph)

    each(play if is_playing() else lambda session: session.settle_from_rest(depsgraph))


@persistent
def file_is_to_be_saved(_file):
    if any(not session.is_settled for session in sessions.values()):
        depsgraph = bpy.context.evaluated_depsgraph_get()
        each(lambda session: session.settle(depsgraph))


@persistent
def another_file_is_to_be_loaded(_file):
    sessions.clear()
    notices.clear()
    # Blender drops its timers with the old file, and crashes at its end if one of them was Python's.
    stop_settling()


@persistent
def another_file_is_loaded(_file):
    resume()


def settle_further():
    """Continues shapes that have not converged, while nothing moves."""
    if not sessions:
        return None
    if not is_playing():
        depsgraph = bpy.context.evaluated_depsgraph_get()
        if any(session.is_played for session in sessions.values()):
            each(lambda session: session.is_played and session.settle_from_rest(depsgraph))
        elif any(not session.is_settled for session in sessions.values()):
            each(lambda session: session.follow(depsgraph))
    return FRAME


def stop_settling():
    """Removes the timer."""
    if bpy.app.timers.is_registered(settle_further):
        bpy.app.timers.unregister(settle_further)


LISTENERS = [
    (bpy.app.handlers.depsgraph_update_post, targets_may_have_moved),
    (bpy.app.handlers.frame_change_post, frame_has_changed),
    (bpy.app.handlers.save_pre, file_is_to_be_saved),
    (bpy.app.handlers.load_pre, another_file_is_to_be_loaded),
    (bpy.app.handlers.load_post, another_file_is_loaded),
]


def listen():
    for handlers, listener in LISTENERS:
        handlers.append(listener)


def stop_listening():
    for session in list(sessions.values()):
        try:
            end(session.object, keep=True)
        except Refused:
            pass
    sessions.clear()
    notices.clear()
    for handlers, listener in LISTENERS:
        if listener in handlers:
            handlers.remove(listener)
    stop_settling()
