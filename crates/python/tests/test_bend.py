"""The laws of binding and steps, on arrays."""

import multiprocessing
import os
import signal
import subprocess
import sys
import textwrap
import threading
import time

import numpy as np
import pytest

import pliant
from conftest import METHODS, bar, quarter_turn


@pytest.mark.parametrize("method", METHODS)
def test_every_method_moves_the_handle_and_holds_what_is_fixed(mesh, ends, method):
    bound = pliant.bind(*mesh, **ends, method=method)
    matrix = quarter_turn((0.1, 0, 0.05))
    bent = bound.step({"top": matrix})
    top, fixed = ends["handles"]["top"], ends["fixed"]
    goal = mesh[0][top] @ matrix[:3, :3].T + matrix[:3, 3]
    assert bent.shape == mesh[0].shape and bent.dtype == np.float64 and np.isfinite(bent).all()
    assert np.abs(bent[top] - goal).max() <= bound.handle_residual + 1e-9
    assert np.abs(bent[fixed] - mesh[0][fixed]).max() <= max(bound.handle_residual, 1e-12)
    free = np.setdiff1d(np.arange(len(bent)), np.r_[top, fixed])
    assert np.abs(bent[free] - mesh[0][free]).max() > 0.05
    assert bound.method == method and bound.iterations >= 1


@pytest.mark.parametrize("method", METHODS)
def test_rest_gives_the_given_positions_to_the_bit(mesh, ends, method):
    bound = pliant.bind(*mesh, **ends, method=method)
    bound.step(quarter_turn())
    assert np.array_equal(bound.step(np.eye(4)), mesh[0])
    assert np.array_equal(bound.step({}), mesh[0])


def search_path():
    """The search path of a script for this folder's helpers and the tested package."""
    return os.pathsep.join([os.path.dirname(__file__), os.environ.get("PYTHONPATH", "")])


def test_transforms_mean_the_same_in_every_form(mesh, ends):
    bound = pliant.bind(*mesh, **ends, method="bilaplacian")
    matrix = quarter_turn()
    expected = bound.step(matrix[None])
    for form in [
        matrix,
        matrix.tolist(),
        [matrix],
        {"top": matrix},
        matrix[:3],
        {"top": matrix[:3].tolist()},
        (matrix[:3, :3], matrix[:3, 3]),
        (matrix[:3, :3], matrix[:3, 3:]),
        {"top": (matrix[:3, :3], matrix[:3, 3])},
        {"matrix": matrix.T.ravel()},
        {"top": {"matrix": matrix.T.ravel().tolist()}},
    ]:
        assert np.array_equal(bound.step(form), expected), form
    turned = bound.step({"rotation": [0, 0, 1, 1], "pivot": [0, 0, 0], "translation": [0.3, 0.1, 0]})
    assert np.abs(turned - expected).max() < 1e-12
    moved = np.eye(4)
    moved[:3, 3] = [0.1, 0, 0.2]
    for form in [moved[:3, 3], moved[:3, 3:], [0.1, 0, 0.2], {"top": [0.1, 0, 0.2]}, {"translation": [0.1, 0, 0.2]}]:
        assert np.array_equal(bound.step(form), bound.step(moved)), form


def test_selections_mean_the_same_in_every_form(mesh, ends):
    vertices = mesh[0]
    mask = vertices[:, 1] < 0.1
    expected = pliant.bind(*mesh, **ends).step(quarter_turn())
    for fixed in [mask, mask.astype(int), mask.astype(np.uint8).tolist(), list(ends["fixed"]), ends["fixed"].astype(np.uint8), {"slab": {"axis": "y", "from": 0, "to": 0.1}}]:
        bent = pliant.bind(*mesh, handles=ends["handles"], fixed=fixed).step(quarter_turn())
        assert np.array_equal(bent, expected)


def test_arrays_of_other_types_and_orders_are_taken(mesh, ends):
    vertices, faces = mesh
    vertices = vertices.astype(np.float32)
    expected = pliant.bind(vertices.astype(np.float64), faces, **ends).step(quarter_turn())
    for other, corners in [
        (vertices, faces.astype(np.int32)),
        (np.asfortranarray(vertices.astype(np.float64)), faces.astype(np.uint64)),
        (vertices.tolist(), faces.tolist()),
        (np.repeat(vertices, 2, axis=0)[::2], faces[:, ::-1][:, ::-1]),
    ]:
        assert np.array_equal(pliant.bind(other, corners, **ends).step(quarter_turn()), expected)


def test_out_is_filled_and_returned(mesh, ends):
    bound = pliant.bind(*mesh, **ends)
    expected = bound.step(quarter_turn())
    for kind in (np.float64, np.float32):
        out = np.empty(mesh[0].shape, kind)
        assert bound.step(quarter_turn(), out=out) is out
        assert np.array_equal(out, expected.astype(kind))
    for wrong in [np.empty((3, 3)), np.empty(mesh[0].shape, np.int64), [[0.0]]]:
        with pytest.raises(ValueError, match=r"out must be a writable array .* \[480, 3\]"):
            bound.step(quarter_turn(), out=wrong)
    readonly = np.empty(mesh[0].shape)
    readonly.flags.writeable = False
    with pytest.raises(ValueError, match="writable"):
        bound.step(quarter_turn(), out=readonly)


def test_the_result_is_the_caller_s_own(mesh, ends):
    bound = pliant.bind(*mesh, **ends)
    first = bound.step(quarter_turn())
    kept = first.copy()
    bound.step(np.eye(4))
    assert np.array_equal(first, kept) and first.flags.owndata is not None and first.flags.writeable


def test_iterations_go_on_to_where_one_long_step_ends(mesh, ends):
    options = {"name": "arap", "tolerance": 1e-9, "max_iterations": 4000}
    whole = pliant.bind(*mesh, **ends, method=options)
    expected = whole.step(quarter_turn())
    assert whole.converged and whole.iterations > 3
    small = pliant.bind(*mesh, **ends, method=options)
    small.step(quarter_turn(), iterations=2)
    assert small.iterations == 2 and not small.converged
    while not small.converged:
        bent = small.step(quarter_turn(), iterations=5)
    assert small.iterations == whole.iterations
    assert np.array_equal(bent, expected)


@pytest.mark.parametrize("method", METHODS)
def test_infinite_stiffness_moves_as_one_body(mesh, ends, method):
    vertices = mesh[0]
    middle = np.abs(vertices[:, 1] - 0.5) < 0.15
    stiffness = np.where(middle, np.inf, 1.0)
    bent = pliant.bind(*mesh, **ends, stiffness=stiffness, method=method).step(quarter_turn())
    before, after = (np.linalg.norm(p[middle][:, None] - p[middle][None], axis=-1) for p in (vertices, bent))
    assert np.abs(after - before).max() < 1e-9
    assert np.abs(bent[middle] - vertices[middle]).max() > 1e-2


def test_stiffness_soft_handles_continuity_and_loose_parts_change_the_shape(mesh, ends):
    vertices, faces = mesh
    plain = pliant.bind(*mesh, **ends, method="bilaplacian").step(quarter_turn())
    stiffness = np.where(vertices[:, 1] > 0.5, 50.0, 1.0)
    top = ends["handles"]["top"]
    for change in [
        {"stiffness": stiffness},
        {"stiffness": [{"select": {"slab": {"axis": "y", "from": 0.5, "to": 1}}, "value": 50}]},
        {"continuity": 0},
        {"handles": {"top": {"select": top, "soft": 0.01}}},
        {"handles": [{"select": top, "continuity": 0}]},
        {"region": vertices[:, 1] > 0.4},
    ]:
        bent = pliant.bind(*mesh, **{**ends, **change}, method="bilaplacian").step([quarter_turn()])
        assert np.abs(bent - plain).max() > 1e-3, change
    both = np.concatenate([vertices, vertices + [0.5, 0, 0]])
    twice = np.concatenate([faces, faces + len(vertices)])
    rests = pliant.bind(both, twice, **ends, loose="rest").step(quarter_turn())
    assert np.array_equal(rests[len(vertices):], both[len(vertices):])
    follows = pliant.bind(both, twice, **ends).step(quarter_turn())
    assert np.abs(follows[len(vertices):] - both[len(vertices):]).max() > 0.1


def test_without_a_method_it_is_the_window_s_first_choice(mesh, ends):
    first_choice = {name: own["first_choice"] for name, own in pliant.methods()["arap"]["options"].items()}
    bound = pliant.bind(*mesh, **ends)
    assert bound.method == "arap" and first_choice["energy"] == "smooth"
    expected = pliant.bind(*mesh, **ends, method={"name": "arap", **first_choice}).step(quarter_turn())
    assert np.array_equal(bound.step(quarter_turn()), expected)


def test_rigid_is_a_stiffness(mesh, ends):
    middle = np.abs(mesh[0][:, 1] - 0.5) < 0.15
    expected = pliant.bind(*mesh, **ends, stiffness=np.where(middle, np.inf, 1.0)).step(quarter_turn())
    for stiffness in (["rigid" if is_in else 1 for is_in in middle], [{"select": {"vertices": np.flatnonzero(middle)}, "value": "rigid"}]):
        assert np.array_equal(pliant.bind(*mesh, **ends, stiffness=stiffness).step(quarter_turn()), expected)
    everything = pliant.bind(*mesh, handles=ends["handles"], stiffness="rigid").step(quarter_turn())
    assert np.abs(everything - (mesh[0] @ quarter_turn()[:3, :3].T + quarter_turn()[:3, 3])).max() < 1e-12


def test_a_mask_of_whole_numbers_is_one_only_where_it_can_be_no_list(mesh, ends):
    triangle = np.eye(3)
    moved = pliant.bind(triangle, [], handles=[[0, 1]], method="mls").step([[1.0, 0, 0]])
    assert np.allclose(moved, triangle + [1, 0, 0])
    by_mask = pliant.bind(triangle, [], handles=[[1, 1, 0]], method="mls")
    assert np.array_equal(by_mask.step([[1.0, 0, 0]]), moved)
    two = pliant.bind(triangle[:2], [], handles=[[0, 1]], method="mls").step([[1.0, 0, 0]])
    assert np.allclose(two, triangle[:2] + [1, 0, 0])


def test_positions_that_are_not_finite_are_told_by_array_and_row(mesh, ends):
    vertices, faces = mesh
    points = np.concatenate([vertices, np.full((2, 3), [0, np.nan, 1])])
    with pytest.warns(UserWarning, match=r"vertices\[480\] is not finite \(0, NaN, 1\), the first of 2 such rows: they stay"):
        bound = pliant.bind(points, faces, **ends)
    assert np.isfinite(bound.step(quarter_turn())[:480]).all()
    targets = vertices[ends["handles"]["top"]].copy()
    targets[7, 1] = np.nan
    with pytest.raises(ValueError, match=r'transforms\["top"\] is not finite at row 7'):
        bound.step({"top": targets})
    stiffness = np.ones(len(vertices))
    stiffness[5] = np.nan
    with pytest.raises(ValueError, match=r"stiffness\[5\] is NaN"):
        pliant.bind(vertices, faces, **ends, stiffness=stiffness)


def test_points_without_faces_are_bent_by_methods_of_space(mesh, ends):
    bent = pliant.bind(mesh[0], [], **ends, method="rbf").step(quarter_turn())
    assert np.abs(bent - mesh[0]).max() > 0.1
    with pytest.raises(ValueError, match="rbf"):
        pliant.bind(mesh[0], [], **ends, method="arap")


def test_a_cage_comes_as_numbers(mesh, ends):
    corners = [[x, y, z] for z in (-0.5, 0.5) for y in (-0.5, 1.5) for x in (-0.5, 0.5)]
    triangles = [[0, 2, 1], [1, 2, 3], [4, 5, 6], [5, 7, 6], [0, 1, 4], [1, 5, 4],
                 [2, 6, 3], [3, 6, 7], [0, 4, 2], [2, 4, 6], [1, 3, 5], [3, 7, 5]]
    moved = np.array(corners) + [0.25, 0, 0]
    cage = {"vertices": np.array(corners), "triangles": triangles, "moved": moved}
    bent = pliant.bind(*mesh, method={"name": "cage", "cage": cage}).step([])
    assert np.abs(bent - mesh[0] - [0.25, 0, 0]).max() < 1e-6
    with pytest.raises(ValueError, match="method.cage names a file"):
        pliant.bind(*mesh, **ends, method={"name": "cage", "cage": {"file": "cage.obj"}})
    with pytest.raises(ValueError, match="method.examples names a file"):
        pliant.bind(*mesh, **ends, method={"name": "shells", "examples": [{"file": "pose.obj"}]})


NAN = float("nan")


@pytest.mark.parametrize(
    "change, said",
    [
        ({"method": "arab"}, "did you mean `arap`"),
        ({"method": {"name": "arap", "energie": "smooth"}}, "did you mean `energy`"),
        ({"method": {"name": "arap", "tolerance": 7}}, "method.tolerance is 7"),
        ({"method": 3}, "method"),
        ({"handles": {"top": [9999]}}, "names vertex 9999, but there are 480 vertices"),
        ({"handles": {"top": [-1]}}, "handles.*-1"),
        ({"handles": {"top": [0.5]}}, "float64.*give numbers of vertices"),
        ({"handles": {"top": np.ones(7, bool)}}, "a mask of 7 values, but there are 480"),
        ({"handles": {"top": []}}, "handle `top` .* selects no vertex"),
        ({"handles": {"a": [470], "b": [470]}}, "`a` and `b` share 1"),
        ({"handles": {1: [2]}}, "a handle's name is a string"),
        ({"handles": 5}, "handles is of type int"),
        ({"handles": {"top": {"select": [470], "transform": {}}}}, "give it to `step`"),
        ({"handles": {"top": {"select": [470], "soft": -1}}}, "soft is -1"),
        ({"fixed": {"slap": {}}}, "slap"),
        ({"fixed": object()}, "fixed is an array"),
        ({"stiffness": np.ones(7)}, "7 values, but there are 480 vertices"),
        ({"stiffness": np.zeros(480)}, "stiffness"),
        ({"stiffness": np.full(480, NAN)}, r"stiffness\[0\] is NaN"),
        ({"stiffness": "hard"}, "stiffness is of the type"),
        ({"loose": "fly"}, "loose"),
    ],
)
def test_what_is_refused_is_named_with_its_remedy(mesh, ends, change, said):
    with pytest.raises(ValueError, match=said) as refusal:
        pliant.bind(*mesh, **{**ends, **change})
    assert "\n" not in str(refusal.value)


@pytest.mark.parametrize(
    "vertices, faces, said",
    [
        (np.zeros((4, 2)), [[0, 1, 2]], r"vertices is an array of the shape \[4, 2\]"),
        (np.zeros((4, 3), complex), [[0, 1, 2]], "complex128"),
        ([["a", "b", "c"]], [[0, 1, 2]], "vertices is an array"),
        (np.eye(4)[:, :3], [[0, 1, 4]], r"faces\[0\] names vertex 4, but there are 4"),
        (np.eye(4)[:, :3], [[0, 1, -1]], "names vertex -1"),
        (np.eye(4)[:, :3], [[0, 1, 2, 3]], r"faces is an array of the shape \[1, 4\]"),
        (np.eye(4)[:, :3], [[0.0, 1.0, 2.0]], "give whole numbers"),
        (np.zeros((0, 3)), [], "vertices has no rows, so there is nothing to bend"),
    ],
)
def test_meshes_that_are_none_are_refused(vertices, faces, said):
    with pytest.raises(ValueError, match=said):
        pliant.bind(vertices, faces, handles={"a": [0]} if len(vertices) else None)


@pytest.mark.parametrize(
    "transforms, said",
    [
        ({"bottom": np.eye(4)}, 'unknown handle "bottom": known are "top"'),
        ({"top": np.eye(3)}, r'transforms\["top"\] has 3 positions, but the handle has 48 vertices'),
        ({"top": np.eye(2)}, r'transforms\["top"\] is not a transform .*\[2, 2\].*a 3×4 or 4×4 matrix'),
        ([np.eye(4), np.eye(4)], "2 entries, but there are 1 handles"),
        ([], "0 entries"),
        ({"top": np.zeros((4, 4))}, "last row"),
        ({"top": np.diag([1.0, 1, 0, 1])}, "flattens"),
        ({"top": np.full((4, 4), NAN)}, "last row"),
        ({"top": (np.full((3, 3), NAN), [0, 0, 0])}, "not finite"),
        ({"top": {"rotation": [0, 0, 0, 0]}}, r'transforms\["top"\].rotation'),
        ({"top": {"turn": 1}}, "turn"),
        (5, "must be an array"),
    ],
)
def test_transforms_that_are_none_are_refused(mesh, ends, transforms, said):
    bound = pliant.bind(*mesh, **ends)
    before = bound.step(quarter_turn())
    with pytest.raises(ValueError, match=said):
        bound.step(transforms)
    assert np.array_equal(bound.step(quarter_turn()), before)


def test_results_do_not_depend_on_the_number_of_threads(tmp_path):
    script = """
        import sys, numpy as np, pliant
        from conftest import bar, quarter_turn
        vertices, faces = bar(60, 200)
        ends = {"fixed": vertices[:, 1] < 0.1, "handles": [vertices[:, 1] > 0.9]}
        for method in ("bilaplacian", "arap"):
            sys.stdout.buffer.write(pliant.bind(vertices, faces, **ends, method=method).step(quarter_turn()).tobytes())
    """
    outputs = set()
    for threads in ("1", "2", "5"):
        environment = {**os.environ, "RAYON_NUM_THREADS": threads, "PYTHONPATH": search_path()}
        run = subprocess.run([sys.executable, "-c", textwrap.dedent(script)], env=environment, capture_output=True)
        assert run.returncode == 0, run.stderr.decode()
        outputs.add(run.stdout)
    assert len(outputs) == 1


def large():
    vertices, faces = bar(200, 1000)
    return vertices, faces, {"fixed": vertices[:, 1] < 0.1, "handles": [vertices[:, 1] > 0.9]}


def test_other_threads_run_while_a_mesh_is_bound():
    vertices, faces, ends = large()
    done, counted = threading.Event(), []

    def count():
        number = 0
        while not done.is_set():
            number += 1
            time.sleep(0.001)
        counted.append(number)

    other = threading.Thread(target=count)
    other.start()
    pliant.bind(vertices, faces, **ends)
    done.set()
    other.join()
    assert counted[0] > 10


def test_threads_may_share_a_bound_mesh(mesh, ends):
    bound = pliant.bind(*mesh, **ends, method="arap")
    expected = {way: pliant.bind(*mesh, **ends, method="bilaplacian").step(quarter_turn((way, 0, 0))) for way in (0.1, 0.2)}
    linear = pliant.bind(*mesh, **ends, method="bilaplacian")
    wrong = []

    def work(way):
        for _ in range(50):
            bound.step(quarter_turn((way, 0, 0)), iterations=1)
            if not np.array_equal(linear.step(quarter_turn((way, 0, 0))), expected[way]):
                wrong.append(way)

    threads = [threading.Thread(target=work, args=(way,)) for way in (0.1, 0.2, 0.1, 0.2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not wrong


@pytest.mark.skipif(sys.platform == "win32", reason="signals are sent otherwise there")
@pytest.mark.parametrize("work", ["bind", "step"])
def test_ctrl_c_stops_a_long_call(work):
    script = f"""
        import sys, numpy as np, pliant
        from conftest import bar, quarter_turn
        vertices, faces = bar(1000, 1500) if {work == "bind"} else bar(200, 500)
        ends = {{"fixed": vertices[:, 1] < 0.1, "handles": [vertices[:, 1] > 0.9]}}
        method = {{"name": "arap", "tolerance": 1e-12, "max_iterations": 100000}}
        if {work == "step"}:
            bound = pliant.bind(vertices, faces, **ends, method=method)
        print("begun", flush=True)
        try:
            if {work == "step"}:
                bound.step(quarter_turn())
            else:
                pliant.bind(vertices, faces, **ends, method="bilaplacian")
            print("ended")
        except KeyboardInterrupt:
            print("interrupted")
    """
    environment = {**os.environ, "PYTHONPATH": search_path()}
    run = subprocess.Popen(
        [sys.executable, "-c", textwrap.dedent(script)], env=environment, stdout=subprocess.PIPE, text=True
    )
    assert run.stdout.readline() == "begun\n"
    time.sleep(0.3)
    run.send_signal(signal.SIGINT)
    assert run.communicate(timeout=60)[0] == "interrupted\n"


def _child(queue):
    vertices, faces = bar()
    ends = {"fixed": vertices[:, 1] < 0.1, "handles": [vertices[:, 1] > 0.9]}
    queue.put(pliant.bind(vertices, faces, **ends, method="arap").step(quarter_turn()))


@pytest.mark.skipif(not hasattr(os, "fork"), reason="processes are not forked here")
@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
def test_a_forked_process_has_threads_of_its_own(mesh, ends):
    expected = pliant.bind(*mesh, **ends, method="arap").step(quarter_turn())
    context = multiprocessing.get_context("fork")
    queue = context.Queue()
    child = context.Process(target=_child, args=(queue,))
    child.start()
    try:
        assert np.array_equal(queue.get(timeout=60), expected)
    finally:
        child.kill()
        child.join()


def test_vertices_within_the_weld_distance_are_one():
    # Two halves of a bar, a hundredth apart.
    first, faces = bar()
    length = first[:, 1].max() + 0.01
    vertices = np.concatenate([first, first + [0, length, 0]])
    both = np.concatenate([faces, faces + len(first)])
    handles = {"end": vertices[:, 1] > vertices[:, 1].max() - 1e-9}
    fixed = vertices[:, 1] < 1e-9
    seam = np.abs(vertices[:, 1] - length) < 0.015

    def gap(**change):
        bent = pliant.bind(vertices, both, handles=handles, fixed=fixed, **change).step({"end": quarter_turn()})
        left, right = (bent[seam & side] for side in (vertices[:, 1] < length - 0.005, vertices[:, 1] > length - 0.005))
        return max(np.linalg.norm(right - point, axis=1).min() for point in left)

    assert gap() > 0.1, "they are apart by themselves"
    assert gap(weld=0.015) < 0.03
    with pytest.raises(ValueError, match="weld is not a distance"):
        gap(weld=-1)


@pytest.mark.parametrize("method", METHODS)
def test_a_handle_follows_its_curve_and_then_its_transform(method):
    vertices, faces = bar()
    curve = {"points": [[0, 0, 0], [0, 0.5, 0], [0, 1, 0]], "twist": [0, 90, 180]}
    bound = pliant.bind(vertices, faces, handles={"spine": {"select": "all", "curve": curve}}, method=method)
    turn = np.pi * vertices[:, 1]
    goal = vertices.copy()
    goal[:, 0] = np.cos(turn) * vertices[:, 0] + np.sin(turn) * vertices[:, 2]
    goal[:, 2] = np.cos(turn) * vertices[:, 2] - np.sin(turn) * vertices[:, 0]
    assert np.abs(bound.step({}) - goal).max() <= bound.handle_residual + 1e-9
    assert np.abs(bound.step({"spine": [0, 0, 2]}) - goal - [0, 0, 2]).max() <= bound.handle_residual + 1e-9
