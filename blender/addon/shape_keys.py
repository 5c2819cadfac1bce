"""The visible shape of a mesh with shape keys, and one key that changes it, whatever the others do."""

import numpy as np

from .settings import Refused, group_of


def coordinates(points):
    """The positions of the vertices of a mesh, or of the points of a shape key."""
    out = np.empty((len(points), 3), np.float32)
    points.foreach_get("co", out.ravel())
    return out


def seen(obj, without=None):
    """The vertices' positions before the modifiers, by all active shape keys except the one named `without`."""
    keys = obj.data.shape_keys
    if keys is None:
        return coordinates(obj.data.vertices)
    if not keys.use_relative:
        raise Refused(f"{obj.name} has absolute shape keys: turn on Relative in the list of shape keys")
    if obj.show_only_shape_key:
        raise Refused(f"{obj.name} shows only one shape key: turn off the pin beside the list of shape keys")
    basis = keys.reference_key
    out = coordinates(basis.data).astype(np.float64)
    for key in keys.key_blocks:
        if key == basis or key.mute or key.value == 0 or key.name == without:
            continue
        change = coordinates(key.data).astype(np.float64) - coordinates(key.relative_key.data)
        if key.vertex_group:
            change *= group_of(obj, key.vertex_group, f'limit of the shape key "{key.name}"')[:, None]
        out += key.value * change
    return out.astype(np.float32)


def add(obj, name):
    """A new key of this name at the basis, switched on; the mesh gets a basis if it has none."""
    if obj.data.shape_keys is None:
        obj.shape_key_add(name="Basis", from_mix=False)
    key = obj.shape_key_add(name=name, from_mix=False)
    key.value = 1.0
    return key


def write(obj, name, shape, others):
    """Makes an active key move the vertices to `shape` from `others`, their positions by the other active keys."""
    keys = obj.data.shape_keys
    basis = coordinates(keys.reference_key.data).astype(np.float64)
    keys.key_blocks[name].data.foreach_set("co", (basis + (shape - others.astype(np.float64))).astype(np.float32).ravel())
    obj.data.update_tag()


def remove(obj, name):
    """Removes a key, and the basis if no other key is left."""
    keys = obj.data.shape_keys
    if keys is not None and name in keys.key_blocks:
        obj.shape_key_remove(keys.key_blocks[name])
        if len(keys.key_blocks) == 1:
            obj.shape_key_clear()
