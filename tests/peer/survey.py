"""The survey's four scenes against an independent solution: libigl's operators and scipy's solver.

usage: survey.py PLIANT [SCENES]
  PLIANT  the program, e.g. target/release/pliant
  SCENES  a folder with plane, cylinder, bar and cactus, each as NAME.off and NAME.edit.json
          (by default `survey` in the folder that PLIANT_DATA names)
needs:  pip install libigl numpy scipy

For each scene `pliant apply` writes its OUT. The same edit is then solved here: K = L M^-1 L with libigl's cotangent
Laplacian L and its Voronoi mass matrix M, displacements prescribed at fixed and handle vertices, K_ff d_f = -K_fc d_c
by scipy's sparse LU with one step of refinement. Printed is the largest distance between the two results over the
diagonal of the rest shape's bounding box; the exit status is 1 where one is 1e-3 or more.
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import igl
import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

LIMIT = 1e-3
SCENES = ["plane", "cylinder", "bar", "cactus"]


def read_off(path):
    """Vertices (n x 3) and triangles (m x 3) of a triangle OFF file."""
    words = pathlib.Path(path).read_text().split()
    assert words[0] == "OFF", path
    vertex_count, face_count = int(words[1]), int(words[2])
    split = 4 + 3 * vertex_count
    vertices = np.array(words[4:split], dtype=np.float64).reshape(-1, 3)
    faces = np.array(words[split : split + 4 * face_count], dtype=np.int64).reshape(-1, 4)
    assert (faces[:, 0] == 3).all(), path
    return vertices, np.ascontiguousarray(faces[:, 1:])


def solve(vertices, faces, edit):
    """The edit's result by L M^-1 L, for edits that name vertices and move one handle by a matrix."""
    fixed = np.array(edit["fixed"]["vertices"], dtype=np.int64)
    handle = np.array(edit["handles"][0]["select"]["vertices"], dtype=np.int64)
    matrix = np.array(edit["handles"][0]["transform"]["matrix"]).reshape(4, 4).T
    fixed = np.setdiff1d(fixed, handle)
    target = vertices[handle] @ matrix[:3, :3].T + matrix[:3, 3]

    laplacian = igl.cotmatrix(vertices, faces)
    mass = igl.massmatrix(vertices, faces, igl.MASSMATRIX_TYPE_VORONOI).diagonal()
    stiffness = (laplacian.T @ sp.diags(1.0 / mass) @ laplacian).tocsc()

    displacement = np.zeros_like(vertices)
    displacement[handle] = target - vertices[handle]
    held = np.concatenate([fixed, handle])
    free = np.setdiff1d(np.arange(len(vertices)), held)
    system = stiffness[free][:, free].tocsc()
    right = -(stiffness[free][:, held] @ displacement[held])
    factor = splu(system, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    solution = factor.solve(right)
    solution += factor.solve(right - system @ solution)
    displacement[free] = solution
    return vertices + displacement


def main():
    if len(sys.argv) < 2 or sys.argv[1] in ("-h", "--help"):
        sys.exit(__doc__)
    program = pathlib.Path(sys.argv[1]).resolve()
    beside = pathlib.Path(os.environ.get("PLIANT_DATA", "")) / "survey"
    scenes = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else beside
    worst = 0.0
    for name in SCENES:
        mesh, edit = scenes / f"{name}.off", scenes / f"{name}.edit.json"
        if not mesh.exists() or not edit.exists():
            print(f"skipped: there is no {mesh} with its edit")
            continue
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder) / "out.off"
            arguments = ["apply", mesh, "--edit", edit, "--output", out]
            subprocess.run([program, *arguments], check=True)
            ours, _ = read_off(out)
        vertices, faces = read_off(mesh)
        theirs = solve(vertices, faces, json.loads(edit.read_text()))
        diagonal = np.linalg.norm(vertices.max(0) - vertices.min(0))
        error = np.linalg.norm(ours - theirs, axis=1).max() / diagonal
        print(f"{name:10} {len(vertices):6} vertices, largest distance {error:.2e} of the diagonal")
        worst = max(worst, error)
    if not worst < LIMIT:
        sys.exit(f"survey.py: the largest distance {worst:.2e} is not below {LIMIT}: see the scene above")


if __name__ == "__main__":
    main()
