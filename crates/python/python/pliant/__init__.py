"""Bends meshes: ARAP, thin plates, coupled prisms, shells, cages, lattices and more.

>>> import pliant
>>> bound = pliant.bind(vertices, faces, handles={"tip": tip}, fixed=foot)
>>> bent = bound.step({"tip": positions})

The methods, their options and the selectors are those of Pliant's edit format; `methods()` lists them. A refusal is a
`ValueError` (an `OSError` for files) of one sentence that names the culprit and the remedy. Long calls let other
threads run and stop at Ctrl-C. Results are the same bits whatever the number of threads, which is that of the
processors or what the environment variable `RAYON_NUM_THREADS` says.
"""

from ._native import (
    Bound,
    Mesh,
    __version__,
    bind,
    compare,
    diff,
    distortion,
    load,
    methods,
    save,
    transfer,
)

__all__ = [
    "Bound",
    "Mesh",
    "__version__",
    "bind",
    "compare",
    "diff",
    "distortion",
    "load",
    "methods",
    "save",
    "transfer",
]
