"""The example of the manual's page "A thousand scans", on a Dask cluster of processes."""

import importlib.util
import json
import os
import signal

import numpy as np
import pytest

from conftest import ROOT, bar, needed, write_off

EXAMPLE = ROOT / "crates" / "python" / "examples" / "thousand_scans.py"
COUNT = 12
EDIT = {
    "version": 1,
    "method": {"name": "arap", "energy": "smooth"},
    "fixed": {"slab": {"axis": "longest", "from": 0, "to": 0.1}},
    "handles": [
        {
            "name": "top",
            "select": {"slab": {"axis": "longest", "from": 0.9, "to": 1}},
            "transform": {"translation": [0.3, -0.3, 0], "rotation": [0, 0, -0.7, 0.7]},
        }
    ],
}


@pytest.fixture(scope="module")
def example():
    needed("dask.distributed")
    found = importlib.util.spec_from_file_location("thousand_scans", EXAMPLE)
    module = importlib.util.module_from_spec(found)
    found.loader.exec_module(module)
    return module


@pytest.fixture
def scans(tmp_path):
    """Bars of different widths, and a file that is no mesh."""
    folder = tmp_path / "scans"
    folder.mkdir()
    vertices, faces = bar(60, 150)
    for number in range(COUNT):
        write_off(folder / f"scan-{number:04}.off", vertices * [1 + number / COUNT, 1, 1], faces)
    (folder / "broken.off").write_text("OFF\n3 1 0\n0 0 0\n")
    return sorted(folder.iterdir())


def test_a_killed_worker_loses_nothing_and_leaves_nothing_half_written(example, scans, tmp_path, monkeypatch):
    # The workers load the example's functions by its name.
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([str(EXAMPLE.parent), os.environ.get("PYTHONPATH", "")]))
    monkeypatch.syspath_prepend(EXAMPLE.parent)
    import thousand_scans
    from dask.distributed import Client, LocalCluster

    output, reports, killed = tmp_path / "bent", {}, None
    environment = {"RAYON_NUM_THREADS": "1", "PYTHONPATH": os.environ["PYTHONPATH"]}
    cluster = LocalCluster(n_workers=2, processes=True, threads_per_worker=1, env=environment, dashboard_address=None)
    with cluster, Client(cluster) as client:
        pids = client.run(os.getpid)
        for scan, report in thousand_scans.bend_all(client, scans, EDIT, output):
            reports[scan.name] = report
            working = [worker for worker, tasks in client.processing().items() if tasks and worker in pids]
            if killed is None and working:
                killed = pids[working[0]]
                os.kill(killed, getattr(signal, "SIGKILL", signal.SIGTERM))
        assert killed not in client.run(os.getpid).values()
    assert killed is not None
    assert sorted(reports) == [scan.name for scan in scans]
    assert "refused" in reports.pop("broken.off")

    # The files are those of one process, and there are no others.
    for name, report in reports.items():
        own = tmp_path / "own" / name
        alone = example.bend(tmp_path / "scans" / name, EDIT, tmp_path / "own")
        for member in ("distortion", "energy", "iterations", "warnings"):
            assert alone[member] == report[member]
        folder = output / name
        assert (folder / name).read_bytes() == (own / name).read_bytes()
        assert json.loads((folder / "report.json").read_text()) == report
        assert {path.name for path in folder.iterdir()} == {name, "report.json"}
    stretches = [reports[name]["distortion"]["edge_stretch_mean"] for name in sorted(reports)]
    assert len(np.unique(stretches)) == COUNT


def test_a_second_run_bends_only_what_is_missing(example, scans, tmp_path):
    first = example.bend(scans[1], EDIT, tmp_path / "bent")
    folder = tmp_path / "bent" / scans[1].name
    stamps = {path.name: path.stat().st_mtime_ns for path in folder.iterdir()}
    assert example.bend(scans[1], EDIT, tmp_path / "bent") == first
    assert {path.name: path.stat().st_mtime_ns for path in folder.iterdir()} == stamps
    # A shape without a report is not complete: it is made again.
    (folder / "report.json").unlink()
    (folder / scans[1].name).write_text("half")
    again = example.bend(scans[1], EDIT, tmp_path / "bent")
    assert again["distortion"] == first["distortion"]
    assert (folder / scans[1].name).read_bytes() != b"half"


def test_results_of_two_edits_are_not_mixed(example, tmp_path):
    example.keep_edit(EDIT, tmp_path)
    example.keep_edit(EDIT, tmp_path)
    with pytest.raises(SystemExit, match="has results of another edit"):
        example.keep_edit({**EDIT, "region": "all"}, tmp_path)
