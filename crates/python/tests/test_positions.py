"""Positions as targets, like those of igl, Open3D and pmp."""

import time

import numpy as np
import pytest

import pliant
from conftest import METHODS, ROOT, bar, needed, quarter_turn

TAKERS = ["bilaplacian", "arap", "shells", "wrinkles", "poisson", "frames"]


def moved(vertices, matrix):
    return vertices @ matrix[:3, :3].T + matrix[:3, 3]


def waved(vertices):
    """Moves each vertex its own way."""
    return moved(vertices, quarter_turn((0.1, 0, 0.05))) + 0.01 * np.sin(30 * vertices[:, ::-1])


@pytest.mark.parametrize("method", TAKERS)
def test_each_vertex_goes_exactly_to_its_row(mesh, ends, method):
    vertices, top = mesh[0], ends["handles"]["top"]
    bound = pliant.bind(*mesh, **ends, method=method)
    rows = waved(vertices[top])
    for transforms in ({"top": rows}, rows, [rows], {"top": rows.tolist()}):
        bent = bound.step(transforms)
        assert np.array_equal(bent[top], rows)
        assert np.array_equal(bent[ends["fixed"]], vertices[ends["fixed"]])
    free = np.setdiff1d(np.arange(len(vertices)), np.r_[top, ends["fixed"]])
    assert np.abs(bent[free] - vertices[free]).max() > 0.05
    assert np.array_equal(bound.step({"top": vertices[top]}), vertices)


@pytest.mark.parametrize("method", TAKERS)
def test_positions_of_a_rigid_motion_are_its_transform(mesh, ends, method):
    top, matrix = ends["handles"]["top"], quarter_turn((0.1, 0, 0.05))
    bound = pliant.bind(*mesh, **ends, method=method)
    by_rows = bound.step({"top": moved(mesh[0][top], matrix)})
    by_matrix = pliant.bind(*mesh, **ends, method=method).step({"top": matrix})
    assert np.abs(by_rows - by_matrix).max() < 1e-4


@pytest.mark.parametrize("method", sorted(set(METHODS) - set(TAKERS)))
def test_methods_of_one_map_a_handle_refuse_positions_and_name_others(mesh, ends, method):
    bound = pliant.bind(*mesh, **ends, method=method)
    expected = bound.step(quarter_turn())
    with pytest.raises(ValueError, match=f"{method} .*takes no positions.*transform, or take .*arap"):
        bound.step({"top": mesh[0][ends["handles"]["top"]]})
    assert np.array_equal(bound.step(quarter_turn()), expected)


def test_rows_are_in_the_order_of_the_numbers_and_ascend_for_masks_and_selectors(mesh, ends):
    vertices, top = mesh[0], ends["handles"]["top"]
    shuffled = np.random.default_rng(0).permutation(top)
    slab = {"slab": {"axis": "y", "from": 0.9, "to": 1}}
    mask = np.isin(np.arange(len(vertices)), top)
    expected = pliant.bind(*mesh, **ends).step(waved(vertices[top]))
    for handle, rows in [(shuffled, shuffled), (mask, top), (mask.astype(int), top), (slab, top), ({"select": slab}, top)]:
        bound = pliant.bind(*mesh, fixed=ends["fixed"], handles={"top": handle})
        assert np.array_equal(bound.step({"top": waved(vertices[rows])}), expected)


def test_positions_and_transforms_stand_beside_each_other(mesh, ends):
    vertices, top = mesh[0], ends["handles"]["top"]
    handles = {"left": top[::2], "right": top[1::2], "ring": np.flatnonzero(np.abs(vertices[:, 1] - 0.5) < 0.02)}
    bound = pliant.bind(*mesh, fixed=ends["fixed"], handles=handles)
    rows, matrix = waved(vertices[top]), quarter_turn((0.1, 0, 0))
    bent = bound.step({"left": rows[::2], "right": rows[1::2], "ring": matrix})
    assert np.array_equal(bent[top], rows)
    assert np.abs(bent[handles["ring"]] - moved(vertices[handles["ring"]], matrix)).max() < 1e-12
    assert np.array_equal(bound.step([rows[::2], rows[1::2], matrix])[top], rows)


def test_positions_hold_a_component_that_nothing_else_holds(mesh, ends):
    vertices = mesh[0]
    held = np.r_[ends["fixed"], ends["handles"]["top"]]
    bound = pliant.bind(*mesh, handles={"all": held})
    assert bound.warnings == []
    rows = vertices[held] + np.where(vertices[held, 1:2] > 0.5, [0.2, 0, 0], 0)
    bent = bound.step({"all": rows})
    assert np.array_equal(bent[held], rows)
    assert not any("as a whole" in said for said in bound.warnings)
    bound.step({"all": np.eye(4)})
    assert any("as a whole" in said for said in bound.warnings)
    one = pliant.bind(*mesh, handles={"tip": [470]})
    one.step({"tip": vertices[[470]] + [0.1, 0, 0]})
    assert any("as a whole" in said for said in one.warnings), "a single point holds nothing"


def test_a_soft_handle_pulls_towards_its_rows(mesh, ends):
    vertices, top = mesh[0], ends["handles"]["top"]
    rows = waved(vertices[top])
    apart = []
    for soft in (1e-2, 1e4):
        for method in TAKERS:
            bound = pliant.bind(*mesh, fixed=ends["fixed"], handles={"top": {"select": top, "soft": soft}}, method=method)
            apart.append(np.abs(bound.step({"top": rows})[top] - rows).max())
    assert min(apart[: len(TAKERS)]) > 5 * max(apart[len(TAKERS) :])


def test_vertices_in_the_same_place_go_together(mesh, ends):
    vertices, faces = mesh
    top = ends["handles"]["top"]
    # A seam: a copy of the last vertex, with one triangle.
    twice = np.concatenate([vertices, vertices[-1:]])
    faces = np.where(np.arange(len(faces))[:, None] == len(faces) - 1, np.where(faces == 479, 480, faces), faces)
    bound = pliant.bind(twice, faces, fixed=ends["fixed"], handles={"top": top})
    bent = bound.step({"top": waved(vertices[top])})
    assert np.array_equal(bent[480], bent[479]) and np.array_equal(bent[479], waved(vertices[479:]) [0])
    both = pliant.bind(twice, faces, fixed=ends["fixed"], handles={"top": [*top, 480]})
    rows = waved(twice[[*top, 480]])
    assert np.array_equal(both.step({"top": rows}), bent)
    rows[-1] += 0.1
    with pytest.raises(ValueError, match=r"vertices 479 and 480 apart \(rows 47 and 48\)"):
        both.step({"top": rows})


def test_rows_of_welded_vertices_move_together(mesh, ends):
    vertices, faces = mesh[0].copy(), mesh[1].copy()
    top = ends["handles"]["top"]
    twin = vertices[top[0]] + [0, 0, 1e-4]
    # One of the triangles at the first vertex of the handle ends at its twin.
    row, corner = np.argwhere(faces == top[0])[0]
    faces[row, corner] = len(vertices)
    vertices = np.vstack([vertices, twin])
    both = np.r_[top, len(vertices) - 1]
    bound = pliant.bind(vertices, faces, handles={"top": both}, fixed=ends["fixed"], weld=1e-3)
    rows = vertices[both] + [0, 0.1, 0]
    assert np.array_equal(bound.step({"top": rows})[both], rows)
    rows[-1] += [0.1, 0, 0]
    with pytest.raises(ValueError, match="the welded vertices .* apart .*: move both equally"):
        bound.step({"top": rows})


def test_rows_that_do_not_fit_are_refused(mesh, ends):
    vertices, top = mesh[0], ends["handles"]["top"]
    bound = pliant.bind(*mesh, **ends)
    before = bound.step({"top": waved(vertices[top])})
    with pytest.raises(ValueError, match="has 47 positions, but the handle has 48 vertices"):
        bound.step({"top": vertices[top][1:]})
    one = pliant.bind(*mesh, fixed=ends["fixed"], handles={"tip": [470]})
    with pytest.raises(ValueError, match="one row of three numbers.*position.*translation"):
        one.step([[0.1, 0, 0]])
    assert np.array_equal(one.step(vertices[[470]] + 0.1)[470], vertices[470] + 0.1)
    rigid = np.where(vertices[:, 1] > 0.8, np.inf, 1)
    with pytest.raises(ValueError, match="takes no positions, because it also moves vertex .* rigid"):
        pliant.bind(*mesh, **ends, stiffness=rigid).step({"top": vertices[top]})
    assert np.array_equal(bound.step({"top": waved(vertices[top])}), before) or bound.converged


def test_a_file_s_vertices_take_positions_too():
    mesh = pliant.load(ROOT / "assets/creature.glb")
    vertices = mesh.vertices
    order = np.argsort(vertices[:, 0])
    bound = mesh.bind(handles={"tip": order[-40:]}, fixed=order[:40], method="bilaplacian")
    rows = vertices[order[-40:]] + [0.1, 0.05, 0]
    assert np.array_equal(bound.step({"tip": rows})[order[-40:]], rows)


def test_painted_stiffness_follows_positions(mesh, ends):
    vertices, top = mesh[0], ends["handles"]["top"]
    stiffness = np.where(np.abs(vertices[:, 1] - 0.5) < 0.15, 100.0, 1.0)
    matrix = quarter_turn((0.1, 0, 0.05))
    by_matrix = pliant.bind(*mesh, **ends, stiffness=stiffness, method="bilaplacian").step(matrix)
    by_rows = pliant.bind(*mesh, **ends, stiffness=stiffness, method="bilaplacian").step(moved(vertices[top], matrix))
    assert np.abs(by_rows - by_matrix).max() < 2e-2


def test_a_handle_of_a_thousand_points_binds_as_one_point_does():
    vertices, faces = bar(100, 120)
    handle = np.argsort(-vertices[:, 1], kind="stable")[:1000]
    fixed = vertices[:, 1] < 0.05

    def taken(numbers):
        times = []
        for _ in range(3):
            begun = time.perf_counter()
            pliant.bind(vertices, faces, fixed=fixed, handles={"tip": numbers}, method="bilaplacian")
            times.append(time.perf_counter() - begun)
        return min(times)

    assert taken(handle) < 2 * taken(handle[:1]) + 0.05


def test_libigl_s_constraints_give_libigl_s_shape(mesh, ends):
    igl = needed("igl")
    vertices, faces = mesh
    b = np.r_[ends["fixed"], ends["handles"]["top"]]
    bc = np.where(vertices[b, 1:2] > 0.5, moved(vertices[b], quarter_turn((0.2, 0.3, 0))), vertices[b])
    arap = igl.ARAPData()
    arap.energy = igl.ARAPEnergyType.ARAP_ENERGY_TYPE_SPOKES
    arap.max_iter = 3000
    igl.arap_precomputation(vertices, faces.astype(np.int64), 3, b, arap)
    # It starts from our result, because there are several minima.
    method = {"name": "arap", "energy": "spokes", "tolerance": 1e-9, "max_iterations": 4000}
    bound = pliant.bind(vertices, faces, handles={"b": b}, method=method)
    bent = bound.step({"b": bc})
    assert bound.converged and np.array_equal(bent[b], bc)
    assert np.abs(igl.arap_solve(bc, arap, bent) - bent).max() < 1e-4
