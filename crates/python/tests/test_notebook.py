"""The notebook runs, and its figures are correct."""

import os
import re
from pathlib import Path

from conftest import needed

NOTEBOOK = Path(__file__).parents[1] / "notebooks" / "arap.ipynb"


def test_the_tutorial_notebook_runs_with_libigl_and_pliant():
    nbformat = needed("nbformat")
    nbclient = needed("nbclient")
    for package in ("igl", "matplotlib", "scipy", "ipykernel"):
        needed(package)
    notebook = nbformat.read(NOTEBOOK, as_version=4)
    assert all(not cell.get("outputs") for cell in notebook.cells), "it is kept without outputs"
    nbclient.NotebookClient(notebook, timeout=600, resources={"metadata": {"path": str(NOTEBOOK.parent)}}).execute()
    kept = os.environ.get("PLIANT_NOTEBOOK")
    if kept:
        nbformat.write(notebook, kept)
    outputs = [output for cell in notebook.cells for output in cell.get("outputs", [])]
    text = "".join(output.get("text", "") for output in outputs)
    print(text)
    pictures = [output for output in outputs if "image/png" in output.get("data", {})]
    assert len(pictures) == 2
    # The shapes are equal, up to the limit of libigl's iterations.
    shapes = re.findall(r"libigl energy (\S+) .*pliant (\S+) .*converged: (\w+)\), largest distance (\S+) of", text)
    assert len(shapes) == 3
    for libigl, own, converged, distance in shapes:
        assert converged == "True"
        assert float(own) <= float(libigl) * (1 + 1e-6)
        assert float(distance) < 1e-2
    distance = re.search(r"bi-Laplacian, largest distance of the two shapes: (\S+) of", text)
    assert float(distance[1]) < 1e-3
