"""Bends meshes: ARAP, thin plates, coupled prisms, shells, cages, lattices and more.

>>> import pliant
>>> bound = pliant.bind(vertices, faces, handles={"tip": tip}, fixed=foot)
>>> bent = bound.step({"tip": positions})

The methods, their options and the selectors are those of Pliant's edit format; `methods()` lists them. A refusal is a
`ValueError` (an `OSError` for files) of one sentence that names the culprit and the remedy. Long calls let other
threads run and stop at Ctrl-C. Results are the same to the bit on any number of threads, which the environment
variable `RAYON_NUM_THREADS` sets; by default it is the number of processors.
"""

from ._native import (
    Bound,
    Mesh,
    __version__,
    animate,
    apply,
    bind,
    bridge,
    compare,
    cut,
    diff,
    distortion,
    fill,
    flow,
    info,
    load,
    merge,
    methods,
    render,
    save,
    sequence,
    symmetry,
    transfer,
)

__all__ = [
    "Bound",
    "Mesh",
    "__version__",
    "animate",
    "apply",
    "bind",
    "bridge",
    "compare",
    "cut",
    "diff",
    "distortion",
    "fill",
    "flow",
    "info",
    "load",
    "merge",
    "methods",
    "render",
    "save",
    "sequence",
    "symmetry",
    "transfer",
]
