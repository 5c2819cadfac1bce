"""Discrete shells by direct Gauss-Newton with scipy and libigl, timed: edges' lengths, the angles between triangles and
their areas.

usage: shells.py MESH.off
  MESH.off   with MESH.sel and MESH.def beside it (the survey's), or else the edit that all peers are timed on (arap.py)
needs: pip install libigl numpy scipy

The energy and its stiffnesses are Pliant's defaults (stretching 1, bending 1e-4). Each vertex begins with its harmonic
weight's share of the handle's motion. Each step factors J'J with Eigen's sparse Cholesky (by libigl) and halves its
length until the energy falls enough; it ends where a step promises and gains less than 1e-7 of the energy, or after 40
steps.

One JSON object on standard output: the milliseconds of a step (the median), of all steps and of those to within 1% of
the last energy; the energy is divided by the edges' area.
"""
import json
import pathlib
import sys
import time

import igl
import numpy as np
import scipy.sparse as sp
from scipy.spatial.transform import Rotation

from arap import edit, read_off

NONE = np.zeros(0, dtype=np.int64)
STRETCHING, BENDING, AREA = 1.0, 1e-4, 0.25
TOLERANCE, MOST_STEPS = 1e-7, 40


class Shells:
    """The residuals of a mesh: sqrt(weight) (length - rest), and the same for angles and areas."""

    def __init__(self, vertices, faces, free):
        self.place = np.full(len(vertices), -1)
        self.place[free] = np.arange(len(free))
        self.free = free
        sides = {}
        for number, (a, b, c) in enumerate(faces):
            for one, other, across in ((a, b, c), (b, c, a), (c, a, b)):
                sides.setdefault((min(one, other), max(one, other)), []).append((number, across))
        areas = 0.5 * np.linalg.norm(np.cross(vertices[faces[:, 1]] - vertices[faces[:, 0]],
                                              vertices[faces[:, 2]] - vertices[faces[:, 0]]), axis=1)
        is_free = self.place >= 0
        edges, edge_areas, hinges, hinge_areas = [], [], [], []
        for (a, b), around in sides.items():
            area = sum(areas[number] for number, _ in around) / 3
            if is_free[a] or is_free[b]:
                edges.append((a, b))
                edge_areas.append(area)
            if len(around) == 2:
                corners = (a, b, around[0][1], around[1][1])
                if is_free[list(corners)].any():
                    hinges.append(corners)
                    hinge_areas.append(area)
        self.edges, self.hinges = np.array(edges), np.array(hinges)
        self.area = sum(edge_areas)
        self.lengths = self.length(vertices)
        self.edge_weights = np.sqrt(STRETCHING * np.array(edge_areas)) / self.lengths
        diagonal = np.linalg.norm(np.ptp(vertices, axis=0))
        a, b = self.hinges[:, 0], self.hinges[:, 1]
        squares = ((vertices[b] - vertices[a]) ** 2).sum(1)
        self.hinge_weights = np.sqrt(BENDING * diagonal**2 * squares / np.array(hinge_areas))
        self.angles = self.angle(vertices)
        self.faces = faces[is_free[faces].any(1)]
        self.areas = self.face_area(vertices)
        self.face_weights = np.sqrt(AREA * STRETCHING / self.areas)

    def length(self, x):
        return np.linalg.norm(x[self.edges[:, 1]] - x[self.edges[:, 0]], axis=1)

    def face_normals(self, x):
        a, b, c = (x[self.faces[:, k]] for k in range(3))
        return np.cross(b - a, c - a)

    def face_area(self, x):
        return 0.5 * np.linalg.norm(self.face_normals(x), axis=1)

    def normals(self, x):
        a, b, c, d = (x[self.hinges[:, k]] for k in range(4))
        return b - a, np.cross(b - a, c - a), np.cross(d - a, b - a), c - a, d - a

    def angle(self, x):
        edge, one, other, _, _ = self.normals(x)
        sine = (np.cross(one, other) * edge).sum(1)
        return np.arctan2(sine, (one * other).sum(1) * np.linalg.norm(edge, axis=1))

    def residuals(self, x, near):
        """The residuals with the angles nearest to `near`, which are returned too."""
        angles = self.angle(x)
        angles += 2 * np.pi * np.round((near - angles) / (2 * np.pi))
        stretched = self.edge_weights * (self.length(x) - self.lengths)
        bent = self.hinge_weights * (angles - self.angles)
        grown = self.face_weights * (self.face_area(x) - self.areas)
        return np.concatenate([stretched, bent, grown]), angles

    def jacobian(self, x):
        along = x[self.edges[:, 1]] - x[self.edges[:, 0]]
        along *= (self.edge_weights / np.linalg.norm(along, axis=1))[:, None]
        edge, one, other, ca, da = self.normals(x)
        square = (edge**2).sum(1)
        u = one * (np.sqrt(square) / (one**2).sum(1))[:, None]
        v = other * (np.sqrt(square) / (other**2).sum(1))[:, None]
        s, t = ((ca * edge).sum(1) / square)[:, None], ((da * edge).sum(1) / square)[:, None]
        slopes = np.stack([u * (1 - s) + v * (1 - t), u * s + v * t, -u, -v], axis=1)
        slopes *= self.hinge_weights[:, None, None]
        normals = self.face_normals(x)
        normals *= (0.5 * self.face_weights / np.linalg.norm(normals, axis=1))[:, None]
        at = x[self.faces]
        growing = np.cross(normals[:, None], at[:, [2, 0, 1]] - at[:, [1, 2, 0]])
        hinges = len(self.edges) + len(self.hinges)
        rows, columns, values = [], [], []
        for first, corners, gradients in ((0, self.edges, np.stack([-along, along], axis=1)),
                                          (len(self.edges), self.hinges, slopes),
                                          (hinges, self.faces, growing)):
            for corner in range(corners.shape[1]):
                place = self.place[corners[:, corner]]
                own = np.flatnonzero(place >= 0)
                for axis in range(3):
                    rows.append(first + own)
                    columns.append(3 * place[own] + axis)
                    values.append(gradients[own, corner, axis])
        shape = (hinges + len(self.faces), 3 * len(self.free))
        return sp.csr_matrix((np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))), shape)


def blended(vertices, faces, held, handle, target):
    """Each vertex turned and moved by its harmonic weight's share of the handle's motion."""
    on = np.isin(held, handle).astype(float)[:, None]
    weight = igl.harmonic(vertices, faces, held, on, 1)[:, 0].clip(0, 1)
    centre, to = vertices[handle].mean(0), target.mean(0)
    u, _, vt = np.linalg.svd((vertices[handle] - centre).T @ (target - to))
    flip = np.diag([1.0, 1.0, np.sign(np.linalg.det(vt.T @ u.T))])
    turn = Rotation.from_matrix(vt.T @ flip @ u.T).as_rotvec()
    turned = Rotation.from_rotvec(weight[:, None] * turn).apply(vertices - centre)
    return centre + turned + weight[:, None] * (to - centre)


def main():
    if len(sys.argv) < 2 or sys.argv[1] in ("-h", "--help"):
        sys.exit(__doc__)
    path = pathlib.Path(sys.argv[1])
    vertices, faces = read_off(path)
    fixed, handle, target = edit(path, vertices)
    held = np.concatenate([fixed, handle]).astype(np.int64)
    displaced = np.vstack([np.zeros((len(fixed), 3)), target - vertices[handle]])
    free = np.setdiff1d(np.arange(len(vertices)), held)
    shells = Shells(vertices, faces, free)
    x = blended(vertices, faces, held, handle, target)
    x[held] = vertices[held] + displaced
    r, angles = shells.residuals(x, shells.angles)
    energies, times = [0.5 * r @ r], []
    empty = sp.csc_matrix((0, 3 * len(free)))
    while len(times) < MOST_STEPS:
        start = time.perf_counter()
        j = shells.jacobian(x)
        gradient = j.T @ r
        h = (j.T @ j).tocsc()
        h.setdiag(h.diagonal() * (1 + 1e-12))
        step = -igl.min_quad_with_fixed(h, gradient[:, None], NONE, np.zeros((0, 1)), empty, np.zeros((0, 1)), True)[:, 0]
        promised, length = 0.5 * gradient @ step, 1.0
        while True:
            moved = x.copy()
            moved[free] -= length * step.reshape(-1, 3)
            own, turned = shells.residuals(moved, angles)
            if 0.5 * own @ own < energies[-1] - 2e-4 * length * promised or length < 1e-6:
                break
            length *= 0.5
        times.append(time.perf_counter() - start)
        if 0.5 * own @ own >= energies[-1]:
            break
        x, r, angles = moved, own, turned
        energies.append(0.5 * r @ r)
        if max(promised, energies[-2] - energies[-1]) < TOLERANCE * energies[-1]:
            break
    near = next(n for n, energy in enumerate(energies) if energy <= 1.01 * energies[-1])
    ms = {"step": float(np.median(times)) * 1e3, "solve": sum(times) * 1e3, "to_1%": sum(times[:near]) * 1e3}
    numbers = {name: round(value, 1) for name, value in ms.items()}
    print(json.dumps({"mesh": path.stem, "free": len(free), **numbers, "steps": len(times),
                      "energy": float("%.6e" % (energies[-1] / shells.area))}))


if __name__ == "__main__":
    main()
