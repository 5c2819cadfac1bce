"""Edited saves of every format and kind, read back by readers other than Pliant's.

usage: readers.py PLIANT
  PLIANT  the program, e.g. target/release/pliant
needs:  pip install DracoPy meshoptimizer numpy numpy-stl plyfile scipy trimesh

A tube is written in each kind by an independent writer: OFF, OBJ, PLY and STL, as text and as bytes of either order,
of triangles and of quads, and GLB in floats, quantised, and compressed by meshopt and by Draco. `pliant apply` bends
each by the same edit. Its output is read by plyfile, numpy-stl, trimesh, DracoPy and meshoptimizer, and by a few lines
of this script for OFF, OBJ and GLB. Every kind must show the same vertices as the tube in OFF, to its own rounding,
keep its faces, and keep everything except positions. The exit status is 1 if one does not.
"""
import json
import pathlib
import struct
import subprocess
import sys
import tempfile

import DracoPy
import meshoptimizer
import numpy as np
import plyfile
import stl
import trimesh
from scipy.spatial import cKDTree

AROUND, ALONG, LENGTH = 24, 16, 4.0
EDIT = {
    "version": 1,
    "method": {"name": "bilaplacian"},
    "fixed": {"slab": {"axis": "z", "from": 0, "to": 0.15}},
    "handles": [
        {
            "name": "end",
            "select": {"slab": {"axis": "z", "from": 0.85, "to": 1}},
            "transform": {"translation": [0.5, 0.25, 0], "rotation": [0, 0.25881904, 0, 0.96592583]},
        }
    ],
}
FLOATS, DOUBLES = 2e-6, 1e-12
# Two steps of the grid of rounded positions.
STEPS_16, STEPS_14 = 2 * LENGTH / 65535, 2 * LENGTH / 16383


def tube():
    """Vertices (n x 3), quads (m x 4), and a colour (0 to 255) for each vertex."""
    turn = 2 * np.pi * np.arange(AROUND) / AROUND
    ring = np.stack([0.5 * np.cos(turn), 0.5 * np.sin(turn)], axis=1)
    height = LENGTH * np.arange(ALONG) / (ALONG - 1)
    vertices = np.concatenate([np.column_stack([ring, np.full(AROUND, z)]) for z in height])
    first = np.arange(AROUND)
    second = (first + 1) % AROUND
    quads = [np.stack([first, second, second + AROUND, first + AROUND], axis=1) + AROUND * row for row in range(ALONG - 1)]
    colours = (np.arange(3 * len(vertices)) * 37 % 256).reshape(-1, 3).astype(np.uint8)
    return vertices, np.concatenate(quads), colours


def triangles(quads):
    return np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


# Writers: the bytes of a file of the kind.


def off(vertices, faces):
    lines = ["OFF", f"{len(vertices)} {len(faces)} 0"]
    lines += [" ".join(repr(float(x)) for x in v) for v in vertices]
    lines += [f"{len(f)} " + " ".join(map(str, f)) for f in faces]
    return ("\n".join(lines) + "\n").encode()


def obj(vertices, faces):
    lines = ["# a comment that stays", "o tube"]
    lines += ["v " + " ".join(repr(float(x)) for x in v) for v in vertices]
    lines += [f"vt {v[0]:.3f} {v[2]:.3f}" for v in vertices]
    lines += ["usemtl none", "g sides"]
    lines += ["f " + " ".join(f"{i + 1}/{i + 1}" for i in f) for f in faces]
    return ("\n".join(lines) + "\n").encode()


def ply(vertices, faces, colours, form, number):
    """A PLY in `form` ("ascii", "<" or ">") with positions of type `number`, more properties and one more element."""
    types = [(axis, number) for axis in "xyz"] + [(c, "u1") for c in ("red", "green", "blue")] + [("quality", "f4")]
    table = np.empty(len(vertices), dtype=types)
    for axis, name in enumerate("xyz"):
        table[name] = vertices[:, axis]
    for channel, name in enumerate(("red", "green", "blue")):
        table[name] = colours[:, channel]
    table["quality"] = np.arange(len(vertices)) / 7
    corners = np.empty(len(faces), dtype=[("vertex_indices", "i4", (faces.shape[1],)), ("flags", "u1")])
    corners["vertex_indices"], corners["flags"] = faces, np.arange(len(faces)) % 5
    more = np.array([(1.5, 7)], dtype=[("focus", "f4"), ("frame", "i4")])
    elements = [
        plyfile.PlyElement.describe(table, "vertex"),
        plyfile.PlyElement.describe(corners, "face"),
        plyfile.PlyElement.describe(more, "camera"),
    ]
    order = "=" if form == "ascii" else form
    return plyfile.PlyData(elements, text=form == "ascii", byte_order=order, comments=["a comment that stays"])


def stl_mesh(vertices, faces):
    solid = stl.mesh.Mesh(np.zeros(len(faces), dtype=stl.mesh.Mesh.dtype))
    solid.vectors[:] = vertices[faces]
    solid.attr[:] = (np.arange(len(faces)) % 900).reshape(-1, 1)
    return solid


def glb(vertices, faces, colours, kind):
    """A GLB whose geometry is stored in floats, quantised to 16 bits, or compressed by meshopt or Draco."""
    views, chunks, used = [], [], []

    def view(data, **more):
        offset = sum(len(chunk) for chunk in chunks)
        views.append({"buffer": 0, "byteOffset": offset, "byteLength": len(data), **more})
        chunks.append(data + bytes(-len(data) % 4))
        return len(views) - 1

    index = faces.astype("<u4").reshape(-1)
    rgba = np.column_stack([colours, np.full(len(colours), 255)]).astype(np.uint8)
    node = {"mesh": 0}
    if kind == "quantised":
        used = ["KHR_mesh_quantization"]
        steps = np.round(vertices / LENGTH * 65535 / 2 + 16384).astype("<u2")
        positions = np.column_stack([steps, np.zeros(len(steps))]).astype("<u2")
        scale = 2 * LENGTH / 65535
        node |= {"scale": [scale] * 3, "translation": [-16384 * scale] * 3}
        low, high, component, stride = steps.min(0), steps.max(0), 5123, 8
    else:
        positions = vertices.astype("<f4")
        low, high, component, stride = positions.min(0), positions.max(0), 5126, 12
    accessors = [
        {"componentType": component, "count": len(vertices), "type": "VEC3", "min": low.tolist(), "max": high.tolist()},
        {"componentType": 5121, "normalized": True, "count": len(vertices), "type": "VEC4"},
        {"componentType": 5125, "count": len(index), "type": "SCALAR"},
    ]
    primitive = {"attributes": {"POSITION": 0, "COLOR_0": 1}, "indices": 2}
    buffers = []
    if kind == "draco":
        used = ["KHR_draco_mesh_compression"]
        data = DracoPy.encode(vertices, faces, quantization_bits=14, colors=rgba, preserve_order=True)
        stored = {0: "POSITION", 2: "COLOR_0"}
        ids = {stored[a["attribute_type"]]: a["unique_id"] for a in DracoPy.decode(data).attributes}
        primitive["extensions"] = {used[0]: {"bufferView": view(data), "attributes": ids}}
    elif kind == "meshopt":
        used = ["EXT_meshopt_compression"]
        streams = [
            (meshoptimizer.encode_vertex_buffer(positions, len(positions), 12), 12, len(positions), "ATTRIBUTES"),
            (meshoptimizer.encode_vertex_buffer(rgba, len(rgba), 4), 4, len(rgba), "ATTRIBUTES"),
            (meshoptimizer.encode_index_buffer(index, len(index), len(vertices)), 4, len(index), "TRIANGLES"),
        ]
        fallback = 0
        for accessor, (data, size, count, mode) in zip(accessors, streams):
            accessor["bufferView"] = view(bytes(data))
            stored = views[accessor["bufferView"]]
            compressed = {**stored, "byteStride": size, "count": count, "mode": mode}
            stored |= {"buffer": 1, "byteOffset": fallback, "byteLength": size * count, "extensions": {used[0]: compressed}}
            if mode == "ATTRIBUTES":
                stored["byteStride"] = size
            fallback += size * count
        buffers = [{"byteLength": fallback, "extensions": {used[0]: {"fallback": True}}}]
    else:
        accessors[0]["bufferView"] = view(positions.tobytes(), byteStride=stride)
        accessors[1]["bufferView"] = view(rgba.tobytes(), byteStride=4)
        accessors[2]["bufferView"] = view(index.tobytes())
    binary = b"".join(chunks)
    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [node],
        "meshes": [{"primitives": [primitive], "extras": {"ours": [1, 2, 3]}}],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": len(binary)}, *buffers],
    }
    if used:
        document |= {"extensionsUsed": used, "extensionsRequired": used}
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    whole = 12 + 8 + len(text) + 8 + len(binary)
    head = struct.pack("<4sIIII", b"glTF", 2, whole, len(text), 0x4E4F534A)
    return head + text + struct.pack("<II", len(binary), 0x004E4942) + binary


# Readers: vertices and faces, and everything that must stay unchanged.


def read_off(path):
    words = path.read_text().split()
    assert words[0] == "OFF", path
    count, faces, at = int(words[1]), int(words[2]), 4
    vertices = np.array(words[at : at + 3 * count], dtype=float).reshape(-1, 3)
    at, found = at + 3 * count, []
    for _ in range(faces):
        size = int(words[at])
        found.append([int(i) for i in words[at + 1 : at + 1 + size]])
        at += 1 + size
    return vertices, np.array(found), None


def read_obj(path):
    lines = path.read_text().splitlines()
    vertices = np.array([line.split()[1:4] for line in lines if line.startswith("v ")], dtype=float)
    faces = [[int(word.split("/")[0]) - 1 for word in line.split()[1:]] for line in lines if line.startswith("f ")]
    return vertices, np.array(faces), [line for line in lines if not line.startswith("v ")]


def read_ply(path):
    data = plyfile.PlyData.read(path)
    vertex, face = data["vertex"].data, data["face"].data
    vertices = np.column_stack([vertex[axis].astype(float) for axis in "xyz"])
    others = [vertex[name].tolist() for name in vertex.dtype.names if name not in "xyz"]
    types = [[str(p) for p in element.properties] for element in data.elements]
    rest = [data.text, data.byte_order, data.comments, types, others, face["flags"].tolist(), data["camera"].data.tolist()]
    return vertices, np.stack(face["vertex_indices"]), rest


def read_stl(path):
    """Vertices and faces of a soup; its header and attributes if it has them."""
    solid = stl.mesh.Mesh.from_file(str(path), calculate_normals=False)
    faces = np.arange(3 * len(solid.vectors)).reshape(-1, 3)
    data = path.read_bytes()
    is_text = b"facet normal" in data[:300]
    rest = data[:10] if is_text else [data[:80], solid.attr.ravel().tolist()]
    return solid.vectors.reshape(-1, 3).astype(float), faces, rest


def read_glb(path):
    data = path.read_bytes()
    size = struct.unpack_from("<I", data, 12)[0]
    document, binary = json.loads(data[20 : 20 + size]), data[28 + size :]
    types = {5121: "u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}

    def accessor(number):
        """An accessor's rows, decompressed and with sparse values in place."""
        entry = document["accessors"][number]
        width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}[entry["type"]]
        number_type = np.dtype(types[entry["componentType"]])
        stored = document["bufferViews"][entry["bufferView"]]
        packed = stored.get("extensions", {}).get("EXT_meshopt_compression")
        start, stride = entry.get("byteOffset", 0), stored.get("byteStride", width * number_type.itemsize)
        if packed:
            stream = binary[packed.get("byteOffset", 0) :][: packed["byteLength"]]
            shape = (packed["count"], packed["byteStride"])
            if packed["mode"] == "TRIANGLES":
                raw = meshoptimizer.decode_index_buffer(shape[0], shape[1], stream).astype("<u4").tobytes()
            else:
                raw = meshoptimizer.decode_vertex_buffer(shape[0], shape[1], stream).tobytes()
        else:
            raw = binary[stored.get("byteOffset", 0) :][: stored["byteLength"]]
        rows = [raw[start + i * stride :][: width * number_type.itemsize] for i in range(entry["count"])]
        return np.frombuffer(b"".join(rows), dtype=number_type).reshape(-1, width)

    primitive = document["meshes"][0]["primitives"][0]
    node = document["nodes"][document["scenes"][0]["nodes"][0]]
    draco = primitive.get("extensions", {}).get("KHR_draco_mesh_compression")
    if draco:
        stored = document["bufferViews"][draco["bufferView"]]
        decoded = DracoPy.decode(binary[stored.get("byteOffset", 0) :][: stored["byteLength"]])
        vertices, faces, colours = np.asarray(decoded.points, dtype=float), decoded.faces, decoded.colors
    else:
        vertices = accessor(primitive["attributes"]["POSITION"]).astype(float)
        faces, colours = accessor(primitive["indices"]), accessor(primitive["attributes"]["COLOR_0"])
    vertices = vertices * node.get("scale", [1] * 3) + node.get("translation", [0] * 3)
    extras = document["meshes"][0]["extras"]
    # Draco sorts vertices; their data are compared as a set.
    kept = sorted(np.asarray(colours)[:, :3].tolist())
    return vertices, np.asarray(faces).reshape(-1, 3), [extras, kept]


def trimesh_shows(path, vertices):
    """The distance of trimesh's vertices from these, for the kinds that it can read."""
    scene = trimesh.load(path, process=False)
    shown = scene.to_geometry() if isinstance(scene, trimesh.Scene) else scene
    return apart(np.asarray(shown.vertices), vertices)


def apart(a, b):
    """The largest distance from a vertex of one to the nearest of the other."""
    return max(cKDTree(a).query(b)[0].max(), cKDTree(b).query(a)[0].max())


def kinds():
    """Name, file name, writer, reader, rounding, and kind of faces."""
    vertices, quads, colours = tube()
    corners = triangles(quads)

    def bytes_of(data):
        return lambda path: path.write_bytes(data)

    def ply_of(faces, form, number):
        return lambda path: ply(vertices, faces, colours, form, number).write(str(path))

    def stl_of(mode, name="made elsewhere"):
        def write(path):
            stl_mesh(vertices, corners).save(str(path), mode=mode)
            if mode == stl.Mode.BINARY:
                data = path.read_bytes()
                path.write_bytes(name.encode().ljust(80)[:80] + data[80:])

        return write

    yield "OFF triangles", "a.off", bytes_of(off(vertices, corners)), read_off, DOUBLES, corners
    yield "OFF quads", "b.off", bytes_of(off(vertices, quads)), read_off, DOUBLES, quads
    yield "OBJ triangles", "c.obj", bytes_of(obj(vertices, corners)), read_obj, DOUBLES, corners
    yield "OBJ quads", "d.obj", bytes_of(obj(vertices, quads)), read_obj, DOUBLES, quads
    for form, word in (("ascii", "text"), ("<", "little-endian"), (">", "big-endian")):
        for faces, what in ((corners, "triangles"), (quads, "quads")):
            for number, rounding in (("f4", FLOATS), ("f8", DOUBLES)):
                name = f"PLY {word} {what} {number}"
                yield name, f"{len(name)}{word}{what}{number}.ply", ply_of(faces, form, number), read_ply, rounding, faces
    yield "STL text", "e.stl", stl_of(stl.Mode.ASCII), read_stl, FLOATS, corners
    yield "STL binary", "f.stl", stl_of(stl.Mode.BINARY), read_stl, FLOATS, corners
    yield 'STL binary "solid"', "g.stl", stl_of(stl.Mode.BINARY, "solid of a program"), read_stl, FLOATS, corners
    for kind, rounding in (("floats", FLOATS), ("quantised", STEPS_16), ("meshopt", FLOATS), ("draco", STEPS_14)):
        data = glb(vertices, corners, colours, kind)
        yield f"GLB {kind}", f"{kind}.glb", bytes_of(data), read_glb, rounding, corners


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    folder = pathlib.Path(tempfile.mkdtemp(prefix="pliant-readers-"))
    edit = folder / "edit.json"
    edit.write_text(json.dumps(EDIT))
    wanted, broken = {}, 0
    for name, file, write, read, rounding, faces in kinds():
        source, out = folder / file, folder / f"out-{file}"
        write(source)
        command = [program, "apply", source, "--edit", edit, "--output", out]
        ended = subprocess.run(command, capture_output=True, text=True)
        if ended.returncode:
            print(f"FAIL {name:<32} {ended.stderr.strip()}")
            broken += 1
            continue
        (old, old_faces, old_rest), (new, new_faces, new_rest) = read(source), read(out)
        # The first of each kind of faces is the OFF, whose numbers are doubles.
        bent = wanted.setdefault(faces.shape[1], new)
        off_by = apart(new, bent)
        said = [f"{off_by:.1e} from the OFF"]
        is_right = off_by <= rounding * LENGTH if rounding < STEPS_16 else off_by <= rounding
        moved = apart(new, old)
        if moved < 0.2:
            said.append("nothing was bent")
            is_right = False
        if not np.array_equal(old_faces, new_faces):
            said.append("the faces are others")
            is_right = False
        if old_rest != new_rest:
            said.append("something that is no position is another")
            is_right = False
        if file.endswith((".obj", ".ply", ".stl")) or file in ("floats.glb", "quantised.glb"):
            of_trimesh = trimesh_shows(out, new)
            said.append(f"trimesh {of_trimesh:.1e}")
            is_right &= of_trimesh <= FLOATS * LENGTH
        print(f"{'ok  ' if is_right else 'FAIL'} {name:<32} {', '.join(said)}")
        broken += not is_right
    print(f"{broken} kinds are not as they should be")
    sys.exit(broken > 0)


if __name__ == "__main__":
    main()
