"""Bends meshes: ARAP, thin plates, coupled prisms, shells, cages, lattices and more."""

import os
from collections.abc import Mapping, Sequence
from typing import Any, Literal, TypedDict, TypeVar, Union, final, overload

import numpy as np
import numpy.typing as npt

__version__: str

MethodName = Literal[
    "bilaplacian",
    "arap",
    "primo",
    "shells",
    "wrinkles",
    "poisson",
    "laplacian",
    "frames",
    "rbf",
    "mls",
    "embedded",
    "lattice",
    "cage",
    "space-primo",
]

Method = Union[MethodName, Mapping[str, Any]]
"""A method's name, or a dict with its `name` and options, as the edit format's `method`."""

Selection = Union[npt.ArrayLike, Literal["all", "none"], Mapping[str, Any]]
"""Numbers of vertices, a mask with a value for each vertex, or a selector of the edit format: `"all"`,
`{"sphere": {"center": [0, 0, 0], "radius": 1}}` and so on. Vertices in the same place are selected together.

A mask holds booleans, or whole numbers that are all 0 or 1 and as many as there are vertices (more than two)."""

class HandleEntry(TypedDict, total=False):
    """A handle with further members."""

    select: Selection
    """Its vertices; required without a `curve` or a `sketch`."""
    soft: float
    """The weight, 1e-6 to 1e6, of a handle that only pulls. Without it, the handle is hard: its vertices move exactly."""
    continuity: float
    """The continuity of the surface at the handle, 0 to 2, instead of the mesh's."""
    curve: Mapping[str, Any]
    """A curve that its vertices follow before its transform moves them, as in the edit format: `points`, and `closed`,
    `moved`, `twist` or `scale`. Without `select`, the vertices of the triangles under it follow it."""
    sketch: Mapping[str, Any]
    """A line to which its outline goes before its transform moves it, as in the edit format: `view_projection`, `line`
    and `weight`."""

Handles = Union[Mapping[str, Union[Selection, HandleEntry]], Sequence[Union[Selection, HandleEntry]]]
"""Handles by name, or in a row; those in a row are called "handle 1", "handle 2", ..."""

Field = Union[npt.ArrayLike, Sequence[Mapping[str, Any]]]
"""One number, an array with one for each vertex, or the edit format's list of selections and values. The stiffness
"rigid" is the same as infinity."""

Loose = Union[Literal["follow", "bend", "rest"], Sequence[Mapping[str, Any]]]
"""The behaviour of parts without a handle or a fixed vertex, or the edit format's list of selections and behaviours."""

Transform = Union[npt.ArrayLike, tuple[npt.ArrayLike, npt.ArrayLike], Mapping[str, Any]]
"""A map of world positions from rest: a 3x4 matrix; a 4x4 matrix whose last row is 0, 0, 0, 1; a translation of the
shape (3,) or (3, 1); a pair (R, t) of a 3x3 matrix and a translation, which takes p to R p + t; or the edit format's
dict of `translation`, `rotation`, `scale` and `pivot`."""

Positions = npt.ArrayLike
"""World positions of a handle's vertices, shape (k, 3): a row for each, in the order of the array that named them at
`bind`; for a mask or a selector the vertices ascend."""

Transforms = Union[Transform, Positions, Sequence[Any], Mapping[str, Union[Transform, Positions]]]
"""One transform, or positions, for each handle: an array of the shape (handles, 4, 4), a list, or a dict by names;
a handle that is not named is at rest. The only handle's target needs no list."""

Shape = Union["Mesh", tuple[npt.ArrayLike, npt.ArrayLike]]
"""A mesh from a file, or a pair (vertices, faces) like those of `bind`."""

File = Union[str, os.PathLike[str]]
"""A file's path."""

FileOrMembers = Union[str, os.PathLike[str], Mapping[str, Any]]
"""The path of a JSON file, or a dict of its members. The files that a dict names are relative to the working
directory."""

Out = TypeVar("Out", npt.NDArray[np.float64], npt.NDArray[np.float32])

class OptionValues(TypedDict, total=False):
    """The values of an option: a number within `range`, or one of `choices`; a switch has neither."""

    range: list[float]
    choices: Union[list[str], list[int]]

class OptionInfo(OptionValues):
    """An option of a method."""

    default: Union[float, int, str, bool]
    """The value of an option that is left out."""
    first_choice: Union[float, int, str, bool]
    """The value when a person chooses the method in Pliant's window."""
    allowed: str
    unit: str
    help: str

class MethodInfo(TypedDict):
    title: str
    when_to_use: str
    options: dict[str, OptionInfo]
    attachments: list[str]

def methods() -> dict[MethodName, MethodInfo]:
    """The methods by name: title, when to use it, and its options with defaults, values, units and help."""

def bind(
    vertices: npt.ArrayLike,
    faces: npt.ArrayLike,
    *,
    handles: Handles | None = None,
    fixed: Selection | None = None,
    region: Selection | None = None,
    stiffness: Field | None = None,
    continuity: Field | None = None,
    loose: Loose | None = None,
    method: Method | None = None,
    weld: float | None = None,
) -> Bound:
    """Binds a mesh: factors and solves everything that does not depend on the handles' targets.

    :param vertices: positions, shape (n, 3). Rows that are not finite stay unchanged, with a warning.
    :param faces: triangles, whole numbers, shape (m, 3); none for bare points, with a method that bends space.
    :param handles: the moved vertices, by name or in a row; handles win over `fixed` and `region`. Each is numbers of
        vertices, a mask of the shape (n,), a selector, or a dict with `select` and `soft`,
        `continuity`, `curve` or `sketch`.
    :param fixed: the vertices that are held still: numbers of vertices, a mask or a selector; by default none.
    :param region: the vertices that may move, given likewise; the rest is held still. By default all.
    :param stiffness: one number or one for each vertex, shape (n,), from 0.001 to 1000; "rigid", or infinity, moves as
        one body. By default 1.
    :param continuity: the continuity at held vertices, one number or one for each vertex, 0 to 2; by default 2.
    :param loose: the behaviour of parts without a handle or a fixed vertex: "follow" (the default), "bend" or "rest".
    :param method: a name, or a dict of its `name` and options. By default {"name": "arap", "energy": "smooth"}, as in
        Pliant's window. A name alone has the edit format's defaults, for "arap" the energy "spokes-and-rims".
    :param weld: the distance within which vertices are joined; 0 joins only equal ones. Without it, the distance
        follows from the mesh's edges.
    :raises ValueError: one sentence that names the culprit and the remedy.
    """

def load(path: File, *, weld: float | None = None) -> Mesh:
    """Reads a mesh from a glTF, GLB, OBJ, PLY, STL, OFF, 3MF or USDZ file.

    :param weld: the distance within which vertices are joined, in the file's units; 0 joins only equal ones. Without
        it, the distance follows from the mesh's edges and from the file's rounding of numbers.
    :raises OSError: if the file can't be read: `FileNotFoundError` if there is none, with its `filename`.
    :raises ValueError: if it is not such a file.
    """

def save(path: File, mesh: Mesh, vertices: npt.ArrayLike | None = None) -> list[str]:
    """Saves a mesh with new positions of its vertices, in the format that the path's extension names.

    In the format of the file that was read, only the numbers of moved vertices differ, and if nothing moved the bytes
    are the same. `save` writes a new file beside the old one and reads it back before it replaces anything, so that the
    old one stays on any error.

    :param vertices: the rows of `mesh.vertices`, moved; shape (n, 3).
    :return: warnings, as sentences.
    :raises OSError: if the file can't be written.
    :raises ValueError: if the format can't hold it.
    """

def info(file: File, *, weld: float | None = None) -> dict[str, Any]:
    """The contents of a file and the faults of its mesh, like `pliant info --json`.

    :param file: a glTF, GLB, OBJ, PLY, STL, OFF, 3MF or USDZ file.
    :param weld: the distance within which vertices are joined, as in `load`.
    :return: `format`, `holds`, `vertices`, `welded_vertices`, `triangles`, `bounding_box`, `components`, `findings`,
        `sentences` and the other members of the command's JSON.
    :raises OSError: if the file can't be read.
    :raises ValueError: if it is not such a file.
    """

def render(
    file: File,
    *,
    output: File | None = None,
    edit: FileOrMembers | None = None,
    size: str | tuple[int, int] | None = None,
    up: Literal["guess", "y", "z"] = "guess",
    view: Literal["front", "back", "left", "right", "top", "bottom", "three-quarter"] = "three-quarter",
    shading: Literal[
        "clay", "material", "regions", "stiffness", "distortion", "area", "curvature", "zebra", "normals"
    ] = "clay",
    clay: Literal["clay", "plaster", "wax", "bronze", "porcelain", "graphite"] = "clay",
    projection: Literal["perspective", "orthographic"] = "perspective",
    flat: bool = False,
    wireframe: bool = False,
    borders: bool = False,
    outlines: bool = False,
    grid: bool = False,
    shadow: bool = False,
    transparent: bool = False,
    turntable: int | None = None,
    weld: float | None = None,
) -> npt.NDArray[np.uint8] | None:
    """A picture of a file, with an edit if there is one, like `pliant render`. It needs no display, but a driver for
    Vulkan, Metal or Direct3D 12; Mesa's `lavapipe` draws without a graphics card.

    :param file: the file to draw.
    :param output: a PNG file to write. Without it the pixels are returned.
    :param edit: an edit's or a project's file, or an edit as a dict.
    :param size: the width and height in pixels, as a text such as `1280x800` or as a pair; by default 1280 by 800.
    :param up: the axis that points up; `guess` is the one on which the shape stands, as the window guesses it.
    :param view: the direction of view.
    :param shading: the surface's colours.
    :param clay: the clay of the shadings `clay` and `regions`.
    :param projection: the projection.
    :param flat: shades each triangle flat.
    :param wireframe: draws the triangles' edges.
    :param borders: marks the edges where the surface ends and those of more than two triangles.
    :param outlines: outlines the edit's handles and the free region.
    :param grid: draws the ground's grid.
    :param shadow: draws a soft shadow on the ground.
    :param transparent: leaves the background transparent.
    :param turntable: the number of pictures around the up axis, 2 to 9999; the files are numbered, as in
        `OUT-0001.png`.
    :param weld: the distance within which vertices are joined, as in `load`.
    :return: red, green, blue and straight alpha in sRGB, shape (height, width, 4), or (turntable, height, width, 4);
        `None` if `output` is given.
    :raises OSError: if a file can't be read or written, or if there is no driver to draw with.
    :raises ValueError: if the file or the edit is refused.
    """

def apply(
    file: File,
    *,
    edit: FileOrMembers,
    output: File,
    report: File | None = None,
    frames: int | None = None,
    as_morph: str | bool | None = None,
    morph_weight: float = 1.0,
    morph_deltas: Literal["turn", "stay"] | None = None,
    method: Method | None = None,
    memory: int | str | None = None,
    weld: float | None = None,
) -> dict[str, Any]:
    """Applies an edit to a file and writes the result, like `pliant apply`.

    Either all files are written or none: they are written beside their places and read back before they take them.

    :param file: the file to bend.
    :param edit: the path of an edit or of a project, or a dict in the edit format.
    :param output: the file to write, in the format that its extension names.
    :param report: the file for the report.
    :param frames: replays the edit as a drag of this many frames, 1 to 100000, instead of one solve.
    :param as_morph: keeps the shape and saves the new one as a morph target with this name; True names it after the
        edit's file. `output` must be glb or gltf.
    :param morph_weight: the morph target's default weight, 0 to 1.
    :param morph_deltas: whether the deltas of the file's own morph targets turn with the surface. By default they turn
        if they would otherwise be wrong by more than 30 degrees.
    :param method: the method instead of the edit's: a name, or a dict of its `name` and options.
    :param memory: the most memory for binding, in bytes or as text such as "8GB".
    :param weld: the distance within which vertices are joined; by default the edit's.
    :return: the report: `method`, `free_vertices`, `iterations`, `converged`, `distortion`, `warnings`, times in
        milliseconds and so on. The warnings also come as `UserWarning`.
    :raises OSError: if a file can't be read or written.
    :raises ValueError: one sentence that names the culprit and the remedy. Nothing is written then.
    """

def animate(
    file: File,
    *,
    edit: FileOrMembers,
    output: File,
    report: File | None = None,
    tolerance: float = 0.00001,
    fps: float = 24.0,
    replace: bool = False,
    method: Method | None = None,
    memory: int | str | None = None,
    weld: float | None = None,
) -> dict[str, Any]:
    """Solves an edit with keys frame by frame and writes the animation, like `pliant animate`.

    :param file: the file to bend.
    :param edit: the path of an edit with `keys`, or a dict in the edit format.
    :param output: a glb or gltf with an animation of morph targets, a point cache (pc2, mdd), or a name that ends in
        `-####` before its extension, for a file for each frame.
    :param report: the file for the report.
    :param tolerance: the largest error of a glTF's frames, 1e-7 to 0.1, as a share of the diagonal of the shape's box.
    :param fps: the frames a second, 0.001 to 1000.
    :param replace: whether numbered files may replace existing ones.
    :param method: the method instead of the edit's, as in `apply`.
    :param memory: the most memory for binding, as in `apply`.
    :param weld: the distance within which vertices are joined; by default the edit's.
    :return: the report. The warnings also come as `UserWarning`.
    :raises OSError: if a file can't be read or written.
    :raises ValueError: one sentence that names the culprit and the remedy. Nothing is written then.
    """

def sequence(
    frames: File,
    *,
    edit: FileOrMembers,
    output: File,
    mesh: File | None = None,
    report: File | None = None,
    fps: float | None = None,
    replace: bool = False,
    method: Method | None = None,
    memory: int | str | None = None,
    weld: float | None = None,
) -> dict[str, Any]:
    """Bends the frames of a sequence, each on its own shape, like `pliant sequence`.

    :param frames: the folder of the frames, a point cache (pc2, mdd), or a glb or gltf with an animation of morph targets.
    :param edit: the path of an edit with `keys` at frames, or a dict in the edit format.
    :param output: the folder to write, in which frames keep their names; for a point cache the cache to write, and for
        a glTF an animation as of `animate`.
    :param mesh: the mesh whose vertices a point cache moves.
    :param report: the file for the report.
    :param fps: the frames a second in which a glTF's animation is edited. Without it every key of the animation is a
        frame: the rate is the lowest usual one from 24 on at which that is so.
    :param replace: whether numbered files of a glTF's animation may replace others.
    :param method: the method instead of the edit's, as in `apply`.
    :param memory: the most memory for the binding of a frame, as in `apply`.
    :param weld: the distance within which vertices are joined; by default the edit's.
    :return: the report. The warnings also come as `UserWarning`.
    :raises OSError: if a file can't be read or written.
    :raises ValueError: one sentence that names the culprit and the remedy. Nothing is written then.
    """

def merge(
    first: File,
    second: File,
    *,
    joins: FileOrMembers,
    output: File,
    report: File | None = None,
    weld: float | None = None,
) -> dict[str, Any]:
    """Joins two files at their borders, like `pliant merge`.

    :param first: the file that stays where it is.
    :param second: the file that is joined to it.
    :param joins: the parts to delete and the places to join: the path of a file of joins, or a dict of its members.
    :param output: the file to write; it can't be a file that is read.
    :param report: the file for the report.
    :param weld: the distance within which vertices are joined, as in `load`.
    :return: the report. The warnings also come as `UserWarning`.
    :raises OSError: if a file can't be read or written.
    :raises ValueError: one sentence that names the culprit and the remedy. Nothing is written then.
    """

def fill(
    file: File,
    *,
    output: File,
    largest: int | None = None,
    at: int | None = None,
    report: File | None = None,
    weld: float | None = None,
) -> dict[str, Any]:
    """Fills holes of a file, like `pliant fill`.

    :param file: the file with holes.
    :param output: the file to write; it can't be the file that is read.
    :param largest: fills only so many of the longest borders. Without it and `at`, every hole is filled, except the
        outer border of an open sheet.
    :param at: fills only the border that passes this vertex of the file.
    :param report: the file for the report.
    :param weld: the distance within which vertices are joined, as in `load`.
    :return: the report: `holes_filled`, `vertices_added`, `triangles_added`, `warnings` and so on. The warnings also
        come as `UserWarning`.
    :raises OSError: if a file can't be read or written.
    :raises ValueError: one sentence that names the culprit and the remedy. Nothing is written then.
    """

def bridge(
    file: File,
    *,
    borders: tuple[int, int],
    output: File,
    report: File | None = None,
    weld: float | None = None,
) -> dict[str, Any]:
    """Joins two borders of a file by a tube, like `pliant bridge`.

    :param file: the file with the borders.
    :param borders: a vertex of each border, by the file's numbers.
    :param output: the file to write; it can't be the file that is read.
    :param report: the file for the report.
    :param weld: the distance within which vertices are joined, as in `load`.
    :return: the report, as in `fill`. The warnings also come as `UserWarning`.
    :raises OSError: if a file can't be read or written.
    :raises ValueError: one sentence that names the culprit and the remedy. Nothing is written then.
    """

def cut(
    file: File,
    *,
    output: File,
    delete: FileOrMembers | None = None,
    plane: Sequence[float] | None = None,
    curve: FileOrMembers | None = None,
    keep: Literal["positive", "negative", "both"] = "positive",
    report: File | None = None,
    weld: float | None = None,
) -> dict[str, Any]:
    """Cuts a part out of a file, like `pliant cut`. Give one of `delete`, `plane` and `curve`.

    :param file: the file to cut.
    :param output: the file to write; it can't be the file that is read.
    :param delete: the vertices to delete: the path of a file with a selector, or a dict such as {"vertices": [0, 1]}.
    :param plane: the numbers (nx, ny, nz, d) of the plane of the points p with (nx, ny, nz) . p = d, in world units.
    :param curve: a curve on the surface: the path of a file, or a dict such as {"version": 1, "points": [[0, 0, 1], ...],
        "closed": True}.
    :param keep: the side to keep: the one to which (nx, ny, nz) points, or to the left of the curve, seen from outside
        along it; the other; or both.
    :param report: the file for the report.
    :param weld: the distance within which vertices are joined, as in `load`.
    :return: the report: `vertices_deleted`, `triangles_deleted`, `triangles_split`, `warnings` and so on. The warnings
        also come as `UserWarning`.
    :raises OSError: if a file can't be read or written.
    :raises ValueError: one sentence that names the culprit and the remedy. Nothing is written then.
    """

class Distortion(TypedDict):
    """The distortion of a shape: the figures of the command line's report."""

    edge_stretch_mean: float
    """The mean over the edges of the larger of new by old length and old by new: 1 for a rigid motion."""
    edge_stretch_max: float
    """The largest of these ratios; infinite if an edge shrank to a point."""
    flipped_faces: int
    """Faces that turned over against the faces around them."""
    volume_ratio: float
    """The enclosed volume, new by old; 1 if the surface encloses none."""

def distortion(mesh: Shape, bent: npt.ArrayLike) -> Distortion:
    """The distortion of a mesh whose vertices are moved: the figures of the command line's report.

    :param mesh: the mesh at rest: a result of `load`, or a pair (vertices, faces).
    :param bent: its vertices, moved; shape (n, 3).
    :return: `edge_stretch_mean` and `edge_stretch_max` (1 for a rigid motion), `flipped_faces` and `volume_ratio`.
    :raises ValueError: one sentence that names the culprit and the remedy.
    """

class DifferencePlace(TypedDict):
    """The place and the kind of a difference between two files."""

    place: str
    """The place, for example "mesh 0, primitive 1, POSITION"."""
    sentence: str
    """The difference in words."""

class Difference(DifferencePlace, total=False):
    """A difference between two files. A difference between numbers of a list has further members."""

    elements: list[int]
    """The elements that differ, ascending."""
    of: int
    """The number of elements."""
    largest: float
    """The largest difference of two numbers; infinite if one of them is not finite."""

def diff(first: File | Mesh, second: File | Mesh) -> list[Difference]:
    """The differences of two files, as in `pliant diff --json`; an empty list if they hold the same.

    :param first: a path, or a result of `load`: the file as it was read.
    :param second: the other file, given likewise.
    :return: dicts with `place` and `sentence`; if numbers of a list differ, also with `elements`, `of` and `largest`.
    :raises OSError: if a file can't be read.
    """

def transfer(
    source: Shape, pose: Mesh | npt.ArrayLike, target: Shape, *, correspondences: npt.ArrayLike | None = None
) -> npt.NDArray[np.float64]:
    """Puts a pose of one mesh onto another, like `pliant transfer`.

    :param source: the mesh that has the pose, at rest: a result of `load`, or a pair (vertices, faces).
    :param pose: the same vertices in the pose: a result of `load`, or positions of the shape (n, 3).
    :param target: the mesh that takes the pose: a result of `load`, or a pair (vertices, faces).
    :param correspondences: pairs of a triangle of `source` and its partner in `target`, whole numbers, shape (p, 2).
        Without them, both meshes must have the same triangles.
    :return: the target's vertices in the pose, shape (k, 3); `save` writes them into its file. Warnings come as
        `UserWarning`.
    :raises ValueError: one sentence that names the culprit and the remedy.
    """

def flow(
    mesh: Shape,
    *,
    dye: Sequence[Mapping[str, Any]] | None = None,
    velocity: Sequence[Mapping[str, Any]] | None = None,
    gravity: npt.ArrayLike | None = None,
    viscosity: float | None = None,
    confinement: float | None = None,
    advection: Literal["first-order", "second-order"] | None = None,
    step: float | None = None,
    seconds: float | None = None,
) -> npt.NDArray[np.float64]:
    """Lets dye flow along a surface, like `pliant flow`; the arguments are the members of its flow format.

    :param mesh: a result of `load`, or a pair (vertices, faces).
    :param dye: dicts with `select`, a selector of the edit format, and `color`, linear red, green and blue from 0 to 1.
    :param velocity: dicts with `select` and either `spin`, a dict with `axis`, `rate` (radians a second) and `center`,
        or `push`, a velocity. By default the fluid rests.
    :param gravity: the acceleration of dyed fluid, in world units per second squared. By default there is none.
    :param viscosity: kinematic viscosity, in squared world units per second, 0 by default.
    :param confinement: the strength of vorticity confinement per second, 0 by default.
    :param advection: `"second-order"` by default.
    :param step: the length of a step in seconds, 1/60 by default.
    :param seconds: the whole time, 2 by default.
    :return: the dye at each vertex, shape (n, 4): linear red, green and blue multiplied by the coverage, and the
        coverage. The colour there is the dye plus 1 - coverage times the mesh's own. Warnings come as `UserWarning`.
    :raises ValueError: one sentence that names the culprit and the remedy.
    """

class Symmetry(TypedDict):
    """A mesh's plane of symmetry."""

    plane: tuple[float, float, float, float]
    """(nx, ny, nz, d): the plane of the points p with (nx, ny, nz) . p = d; the normal has the length 1."""
    images: npt.NDArray[np.int64]
    """For each vertex the row of the vertex nearest to its mirror image, shape (n,): its own if it is on the plane, and
    -1 if the mesh has none there."""

def symmetry(mesh: Shape) -> Symmetry | None:
    """The plane across which a mesh is its own mirror image, up to the unevenness of a scan.

    :param mesh: a result of `load`, or a pair (vertices, faces).
    :return: `plane`, the numbers (nx, ny, nz, d), and `images`, the row of the vertex on the other side for each vertex;
        `None` if no plane comes close to it.
    :raises ValueError: if `mesh` is not a mesh.
    """

class Outcome(TypedDict, total=False):
    """One method's result: its shape and figures, or only `refused`."""

    vertices: npt.NDArray[np.float64]
    """The positions of all vertices, shape (n, 3)."""
    distortion: Distortion
    detail_error: float
    """The change of the details as seen from the surface, without unit; the edit's own bend counts equally for all
    methods."""
    detail_error_ratio: float | None
    """The detail error divided by the best method's; `None` if the best is 0."""
    method: MethodName
    free_vertices: int
    iterations: int
    converged: bool
    energy: float
    handle_residual: float
    warnings: list[str]
    refused: str
    """The reason why the method can't do the edit."""

def compare(
    mesh: Shape,
    transforms: Transforms,
    *,
    methods: Method | Sequence[Method] | Mapping[str, Method] | None = None,
    handles: Handles | None = None,
    fixed: Selection | None = None,
    region: Selection | None = None,
    stiffness: Field | None = None,
    continuity: Field | None = None,
    loose: Loose | None = None,
) -> dict[str, Outcome]:
    """One edit by several methods: the figures of `pliant compare` and the shapes.

    :param mesh: a result of `load`, or a pair (vertices, faces).
    :param transforms: the handles' targets, as in `Bound.step`.
    :param methods: names, or dicts of a `name` and options, in a row or by your own labels. By default every method
        with its defaults.
    :param handles: the same as in `bind`, and so are `fixed`, `region`, `stiffness`, `continuity` and `loose`.
    :return: by name or label a dict with `vertices`, `distortion`, `detail_error` and its ratio to the best method's,
        `method`, `free_vertices`, `iterations`, `converged`, `energy`, `handle_residual` and `warnings`; or with
        `refused`, a sentence, if a method can't do the edit.
    :raises ValueError: if `mesh` is not a mesh.
    """

@final
class Mesh:
    """A file that was read: its shape as arrays, and its other contents, which `save` keeps."""

    @property
    def vertices(self) -> npt.NDArray[np.float64]:
        """The vertices in world space, shape (n, 3), a new array each time. A glTF's vertex that several nodes show
        has a row for each."""
    @property
    def faces(self) -> npt.NDArray[np.uint32]:
        """The triangles, rows of `vertices`, shape (m, 3). Polygons are cut into triangles."""
    @property
    def file_vertices(self) -> npt.NDArray[np.uint32]:
        """The file's own number of each row of `vertices`, which selections use. The numbers count up unless a glTF
        shows a vertex several times."""
    @property
    def path(self) -> os.PathLike[str]:
        """The file's path."""
    @property
    def findings(self) -> list[str]:
        """The mesh's faults, as sentences; empty for a clean, closed, connected mesh."""
    def bind(
        self,
        *,
        handles: Handles | None = None,
        fixed: Selection | None = None,
        region: Selection | None = None,
        stiffness: Field | None = None,
        continuity: Field | None = None,
        loose: Loose | None = None,
        method: Method | None = None,
    ) -> Bound:
        """Binds the file's mesh: factors and solves everything that does not depend on the handles' targets.

        The parameters are those of `pliant.bind`, with the same defaults. Numbers of vertices, masks and fields use
        the file's own numbers (`file_vertices`).

        :raises ValueError: one sentence that names the culprit and the remedy.
        """

@final
class Bound:
    """A mesh that is bound to a method: it takes the handles' targets and gives the positions of all vertices.

    Threads may share it; their steps wait for each other.
    """

    @overload
    def step(
        self, transforms: Transforms, *, iterations: int | None = None, out: None = None
    ) -> npt.NDArray[np.float64]:
        """Moves the handles and returns the positions of all vertices, shape (n, 3).

        :param transforms: for each handle a transform from rest (a 3x4 or 4x4 matrix, a translation of the shape (3,)
            or (3, 1), a pair of a 3x3 matrix and a translation, or the edit format's dict), or a position for each of
            its vertices, shape (k, 3): its i-th vertex goes to row i, in the order of the array that named the
            vertices; for a mask or a selector they ascend. The targets are an array or a list in the order of
            `handles`, or a dict by names; a handle that is not named is at rest, and one with a curve or a sketch follows
            it first. The only handle's target needs no
            list. "arap", "bilaplacian", "shells", "poisson", "frames" and "wrinkles" take positions.
        :param iterations: the largest number of steps of an iterative method. By default it goes on until it has
            converged or reached the limit in its options. Fewer steps follow a moving hand; calls with the same
            transforms go on from the last step.
        :param out: an array that is filled and returned instead of a new one.
        :raises ValueError: one sentence that names the culprit and the remedy.
        """
    @overload
    def step(self, transforms: Transforms, *, iterations: int | None = None, out: Out) -> Out: ...
    @property
    def handles(self) -> list[str]:
        """The handles' names, in the order of the transforms in `step`."""
    @property
    def method(self) -> MethodName:
        """The method's name."""
    @property
    def free_count(self) -> int:
        """The number of solved vertices, after vertices in the same place are joined."""
    @property
    def warnings(self) -> list[str]:
        """The warnings about the binding and the last step, as sentences.

        A component without a fixed vertex is named from the first step on: three positions of its vertices hold it.
        """
    @property
    def findings(self) -> list[str]:
        """The mesh's faults, as sentences; empty for a clean, closed, connected mesh."""
    @property
    def converged(self) -> bool:
        """Whether further steps with the same transforms would change nothing."""
    @property
    def iterations(self) -> int:
        """The number of iterations towards the last transforms."""
    @property
    def energy(self) -> float:
        """The method's energy after the last step, 0 at rest, without unit."""
    @property
    def handle_residual(self) -> float:
        """The largest distance of a handle's vertex from its target, after the last step, in world units: 0 for methods
        that hold handles exactly."""
