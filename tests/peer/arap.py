"""libigl's as-rigid-as-possible deformation over spokes and rims, timed.

usage: arap.py MESH.off [RESULT.off]
  MESH.off   with MESH.sel and MESH.def beside it (the survey's), or else the edit that all peers are timed on: the
             lowest 5% along the longest axis fixed, the highest 5% turned by 60 degrees and moved
  RESULT.off where the shape after 400 iterations goes
needs: pip install libigl numpy

One JSON object on standard output: the milliseconds of its precomputation, of an iteration (the median of 400, each a
local and a global step) and of all 400.
"""
import json
import pathlib
import sys
import time

import igl
import numpy as np

ITERATIONS = 400


def read_off(path):
    """Vertices (n x 3) and triangles (m x 3) of a triangle OFF file."""
    words = pathlib.Path(path).read_text().split()
    vertex_count, face_count = int(words[1]), int(words[2])
    split = 4 + 3 * vertex_count
    vertices = np.array(words[4:split], dtype=np.float64).reshape(-1, 3)
    faces = np.array(words[split : split + 4 * face_count], dtype=np.int64).reshape(-1, 4)
    return vertices, np.ascontiguousarray(faces[:, 1:])


def edit(path, vertices):
    """Fixed and handle vertices, and where the handle's go."""
    numbers = lambda suffix: np.loadtxt(path.with_suffix(suffix), comments="#")
    if path.with_suffix(".sel").exists():
        roles, matrix = numbers(".sel").ravel(), numbers(".def")
        fixed, handle = np.where(roles == 0)[0], np.where(roles == 2)[0]
        return fixed, handle, vertices[handle] @ matrix[:3, :3].T + matrix[:3, 3]
    extent = np.ptp(vertices, axis=0)
    axis = int(np.argmax(extent))
    place = (vertices[:, axis] - vertices[:, axis].min()) / extent[axis]
    fixed, handle = np.where(place < 0.05)[0], np.where(place > 0.95)[0]
    about = (axis + 1) % 3
    i, j = (about + 1) % 3, (about + 2) % 3
    rotation = np.eye(3)
    rotation[i, i] = rotation[j, j] = 0.5
    rotation[j, i] = np.sqrt(0.75)
    rotation[i, j] = -np.sqrt(0.75)
    centre, shift = vertices[handle].mean(0), np.zeros(3)
    shift[about] = 0.2 * np.linalg.norm(extent)
    return fixed, handle, (vertices[handle] - centre) @ rotation.T + centre + shift


def main():
    if len(sys.argv) < 2 or sys.argv[1] in ("-h", "--help"):
        sys.exit(__doc__)
    path = pathlib.Path(sys.argv[1])
    vertices, faces = read_off(path)
    fixed, handle, target = edit(path, vertices)
    held = np.concatenate([fixed, handle]).astype(np.int64)
    places = np.vstack([vertices[fixed], target])
    data = igl.ARAPData()
    data.energy = igl.ARAPEnergyType.ARAP_ENERGY_TYPE_SPOKES_AND_RIMS
    data.max_iter = 1
    start = time.perf_counter()
    igl.arap_precomputation(vertices, faces, 3, held, data)
    bind = time.perf_counter() - start
    shape = vertices.copy()
    shape[held] = places
    times = []
    for _ in range(ITERATIONS):
        start = time.perf_counter()
        result = igl.arap_solve(places, data, shape)
        shape = shape if result is None else result
        times.append(time.perf_counter() - start)
    if len(sys.argv) > 2:
        lines = ["OFF", f"{len(shape)} {len(faces)} 0"]
        lines += ["%.17g %.17g %.17g" % tuple(p) for p in shape]
        lines += ["3 %d %d %d" % tuple(f) for f in faces]
        pathlib.Path(sys.argv[2]).write_text("\n".join(lines) + "\n")
    ms = {"bind": bind * 1e3, "iteration": float(np.median(times)) * 1e3, "all": sum(times) * 1e3}
    print(json.dumps({"mesh": path.stem, **{name: round(value, 3) for name, value in ms.items()}}))


if __name__ == "__main__":
    main()
