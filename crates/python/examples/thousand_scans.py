"""Bends every scan of a folder by one edit, on the processes of a Dask cluster.

    python thousand_scans.py SCANS EDIT.json OUT              # on this machine
    python thousand_scans.py SCANS EDIT.json OUT tcp://HOST:8786   # on the cluster of this scheduler

OUT gets a folder for each scan, with the bent file and its report, and `reports.json` with all reports. A run that was
interrupted goes on where it ended: scans with a report are not bent again.
"""

import json
import sys
import warnings
from pathlib import Path

from dask.distributed import Client, LocalCluster, as_completed

import pliant

FORMATS = {".glb", ".gltf", ".obj", ".ply", ".stl", ".off"}


def bend(scan, edit, output):
    """Bends one scan, on a worker; returns its report, or the refusal as a dict of one member.

    `apply` replaces files whole, the report last. So a scan that has a report is complete, even if a worker was killed
    before, and a scan without one is bent again.
    """
    scan, output = Path(scan), Path(output)
    folder = output / scan.name
    report = folder / "report.json"
    if report.is_file():
        return json.loads(report.read_text())
    folder.mkdir(parents=True, exist_ok=True)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # The report has them.
        try:
            return pliant.apply(scan, edit=edit, output=folder / scan.name, report=report)
        except ValueError as refused:  # The scan does not suit the edit; the next run would refuse it again.
            return {"refused": str(refused)}


def bend_all(client, scans, edit, output):
    """Bends scans by one edit, a dict; yields each scan and its report in the order in which they end.

    A task whose worker dies goes to another worker. A scan that kills its workers, for example because it needs more
    memory than they have, is given up after so many tries as Dask's setting `distributed.scheduler.allowed-failures`.
    """
    keep_edit(edit, output)
    futures = {client.submit(bend, str(scan), edit, str(output), pure=False): scan for scan in scans}
    for done in as_completed(futures):
        error = done.exception()
        yield futures.pop(done), {"refused": str(error)} if error else done.result()


def keep_edit(edit, output):
    """Writes the edit into the folder of results. Results of two edits must not be mixed."""
    output.mkdir(parents=True, exist_ok=True)
    kept = output / "edit.json"
    if kept.is_file() and json.loads(kept.read_text()) != edit:
        sys.exit(f"{output} has results of another edit: give another folder")
    kept.write_text(json.dumps(edit, indent=2))


def main(folder, edit, output, scheduler=None):
    scans = sorted(path for path in Path(folder).iterdir() if path.suffix.lower() in FORMATS)
    edit, output = json.loads(Path(edit).read_text()), Path(output)
    # One process for each processor, each with one thread: scans are the parallel work, not the loops in them.
    cluster = scheduler or LocalCluster(processes=True, threads_per_worker=1, env={"RAYON_NUM_THREADS": "1"})
    reports = {}
    with Client(cluster) as client:
        for scan, report in bend_all(client, scans, edit, output):
            reports[scan.name] = report
            print(f"{len(reports)} of {len(scans)}  {scan.name}  {report.get('refused', 'done')}")
    (output / "reports.json").write_text(json.dumps(dict(sorted(reports.items())), indent=2))


if __name__ == "__main__":
    main(*sys.argv[1:])
