//! The drawn set of a glTF: every vertex of the default scene's triangles, seen through its node.
//!
//! **Numbering.** File vertices are the elements of POSITION accessors. Accessors come in the order in which the
//! file's primitives first name them: meshes in the file's order, a mesh's primitives in theirs, whether drawn or not
//! and whatever their mode; one that several primitives name is counted once.
//!
//! Drawn vertices come node by node (depth first), primitive by primitive. Primitives of one mesh that name the same
//! accessors share their drawn vertices, so that a mesh cut into a hundred materials is not multiplied by a hundred.

use std::ops::Range;

use glam::{DAffine3, Vec3};
use pliant_mesh::{Cancel, Drawn, DrawnVertex, FileVertex, Progress};
use rayon::prelude::*;

use super::accessor::Layout;
use super::document::{Document, MOST_GROWTH};
use super::fault::Fault;
use super::primitive::{Mode, Primitive};
use super::tree::Placed;

/// The drawn vertices of one attribute set seen through one node.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Part {
    pub node: usize,
    pub mesh: usize,
    pub world_from_node: DAffine3,
    /// Its drawn vertices: element `e` is vertex `vertices.start + e`.
    pub vertices: Range<u32>,
    /// The primitive whose attributes these are (others of the mesh may name the same).
    pub primitive: usize,
    /// The morph targets that are applied by default, with their weights.
    pub weights: Vec<(usize, f64)>,
}

/// The triangles of one primitive seen through one node.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Piece {
    pub part: usize,
    pub primitive: usize,
    /// Range of the drawn triangles.
    pub triangles: Range<u32>,
}

/// How the drawn set is made up.
#[derive(Clone, PartialEq, Debug, Default)]
pub(super) struct Pieces {
    pub parts: Vec<Part>,
    pub pieces: Vec<Piece>,
}

/// How many bytes the drawn set may have beyond [`MOST_GROWTH`]: small files with many instances.
const GRACE_BYTES: usize = 256 << 20;

/// Vertices that a thread handles at a time.
const CHUNK: usize = 1 << 14;

/// Reads the drawn set.
pub(super) fn drawn(
    document: &Document,
    meshes: &[Vec<Primitive>],
    placed: &[Placed],
    progress: &Progress,
    cancel: &Cancel,
) -> Result<(Drawn, Pieces), Fault> {
    let (first_file_vertex, file_vertex_count) = number_file_vertices(document, meshes)?;
    let mut drawn = Drawn {
        file_vertex_count,
        ..Drawn::default()
    };
    let mut pieces = Pieces::default();
    let mut budget = document
        .loaded_bytes()
        .saturating_mul(MOST_GROWTH)
        .saturating_add(GRACE_BYTES);
    for (number, place) in placed.iter().enumerate() {
        let first_part = pieces.parts.len();
        for (number, primitive) in meshes[place.mesh].iter().enumerate() {
            cancel.check()?;
            let (Some(mode), Some(position)) = (primitive.mode, primitive.position) else {
                continue;
            };
            if !matches!(mode, Mode::Triangles | Mode::Strip | Mode::Fan) {
                continue;
            }
            let here = || format!("mesh {} primitive {number}", place.mesh);
            primitive
                .check_decoded(document)
                .map_err(|what| format!("{} {what}", here()))?;
            let layout = Layout::of(document, position)?;
            if layout.lanes != 3 {
                return Err(format!("{}: POSITION is not made of three numbers each", here()).into());
            }
            let known = pieces.parts[first_part..]
                .iter()
                .position(|part| meshes[place.mesh][part.primitive].has_attributes_of(primitive));
            let part = match known {
                Some(known) => first_part + known,
                None => {
                    spend(
                        &mut budget,
                        layout.count,
                        size_of::<[f64; 3]>() + size_of::<FileVertex>(),
                        "vertices",
                    )?;
                    let start = drawn.positions.len() as u32;
                    let weights = default_weights(document, place, primitive);
                    let mut positions = layout.floats::<3>(document);
                    let targets = weights
                        .iter()
                        .map(|&(target, weight)| (primitive.targets[target].position, weight));
                    apply_targets(document, &mut positions, targets)?;
                    place_vertices(
                        &positions,
                        place.world_from_node,
                        first_file_vertex[position],
                        &mut drawn,
                    );
                    let vertices = start..drawn.positions.len() as u32;
                    let Placed {
                        node,
                        mesh,
                        world_from_node,
                    } = *place;
                    pieces.parts.push(Part {
                        node,
                        mesh,
                        world_from_node,
                        vertices,
                        primitive: number,
                        weights,
                    });
                    pieces.parts.len() - 1
                }
            };
            let corners = corners(document, primitive, layout.count).map_err(|what| format!("{} {what}", here()))?;
            spend(
                &mut budget,
                corners.count(mode),
                size_of::<[DrawnVertex; 3]>(),
                "triangles",
            )?;
            let start = drawn.triangles.len() as u32;
            let is_mirrored = place.world_from_node.matrix3.determinant() < 0.0;
            let winding = if is_mirrored {
                Winding::Flipped
            } else {
                Winding::AsStored
            };
            corners.triangles(mode, winding, pieces.parts[part].vertices.start, &mut drawn.triangles);
            let triangles = start..drawn.triangles.len() as u32;
            pieces.pieces.push(Piece {
                part,
                primitive: number,
                triangles,
            });
        }
        progress.set((number + 1) as f32 / placed.len() as f32);
    }
    Ok((drawn, pieces))
}

/// The first file vertex of each accessor that is a POSITION, and how many file vertices there are.
fn number_file_vertices(document: &Document, meshes: &[Vec<Primitive>]) -> Result<(Vec<Option<u32>>, usize), Fault> {
    let mut first = vec![None; document.accessors.len()];
    let mut count = 0_u64;
    for position in meshes.iter().flatten().filter_map(|primitive| primitive.position) {
        if first[position].is_none() {
            first[position] = Some(count as u32);
            count = count.saturating_add(document.accessors[position].count.0);
        }
    }
    // Every element of a sound accessor has a byte in the file, but several accessors may share it.
    let most = document
        .loaded_bytes()
        .saturating_mul(MOST_GROWTH)
        .saturating_add(GRACE_BYTES)
        / size_of::<u32>();
    if count > most.min(u32::MAX as usize) as u64 {
        return Err(Fault::TooLarge(format!("{count} vertices")));
    }
    Ok((first, count as usize))
}

fn spend(budget: &mut usize, count: usize, bytes_each: usize, what: &str) -> Result<(), Fault> {
    let left = count
        .checked_mul(bytes_each)
        .and_then(|bytes| budget.checked_sub(bytes));
    *budget = left.ok_or_else(|| Fault::TooLarge(format!("{count} {what} more, each seen through a node")))?;
    Ok(())
}

/// The targets of a primitive that its node, or else its mesh, applies, with their weights.
fn default_weights(document: &Document, place: &Placed, primitive: &Primitive) -> Vec<(usize, f64)> {
    let json = &document.json;
    let own = json.member(document.nodes_at[place.node], "weights");
    let list = own.or_else(|| json.member(document.meshes_at[place.mesh], "weights"));
    let numbers = list.into_iter().flat_map(|list| json.elements(list));
    numbers
        .map(|at| json.number(at).unwrap_or(0.0))
        .take(primitive.targets.len())
        .enumerate()
        .filter(|(_, weight)| *weight != 0.0 && weight.is_finite())
        .collect()
}

/// Adds the ways of morph targets, each times its weight. A target of another count is refused in words.
pub(super) fn apply_targets(
    document: &Document,
    elements: &mut [[f32; 3]],
    targets: impl Iterator<Item = (Option<usize>, f64)>,
) -> Result<(), String> {
    for (accessor, weight) in targets {
        let Some(accessor) = accessor else { continue };
        let layout = Layout::of(document, accessor)?;
        if layout.count != elements.len() || layout.lanes != 3 {
            return Err(format!(
                "accessor {accessor}, a morph target, is not of its base's size"
            ));
        }
        for (element, way) in elements.iter_mut().zip(layout.floats::<3>(document)) {
            (0..3).for_each(|lane| element[lane] = (f64::from(element[lane]) + weight * f64::from(way[lane])) as f32);
        }
    }
    Ok(())
}

fn place_vertices(
    positions: &[[f32; 3]],
    world_from_node: DAffine3,
    first_file_vertex: Option<u32>,
    drawn: &mut Drawn,
) {
    let first = first_file_vertex.unwrap_or(0);
    let world = |p: &[f32; 3]| world_from_node.transform_point3(Vec3::from_array(*p).as_dvec3());
    drawn
        .positions
        .par_extend(positions.par_iter().with_min_len(CHUNK).map(world));
    drawn
        .file_vertex
        .extend((first..).take(positions.len()).map(FileVertex));
}

/// The corners of a primitive: indices into its vertices, or all of them in order.
enum Corners {
    Listed(Vec<u32>),
    Counted(u32),
}

/// Which way round a triangle is taken.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Winding {
    AsStored,
    Flipped,
}

fn corners(document: &Document, primitive: &Primitive, vertex_count: usize) -> Result<Corners, String> {
    let Some(accessor) = primitive.indices else {
        return Ok(Corners::Counted(vertex_count as u32));
    };
    let indices = Layout::of(document, accessor)?
        .indices(document)
        .map_err(|what| format!("has indices that {what}"))?;
    match indices
        .par_iter()
        .with_min_len(CHUNK)
        .position_first(|&index| index as usize >= vertex_count)
    {
        Some(at) => Err(format!(
            "has index {} where it has {vertex_count} vertices",
            indices[at]
        )),
        None => Ok(Corners::Listed(indices)),
    }
}

impl Corners {
    fn len(&self) -> usize {
        match self {
            Self::Listed(indices) => indices.len(),
            Self::Counted(count) => *count as usize,
        }
    }

    /// At most how many triangles these are.
    fn count(&self, mode: Mode) -> usize {
        if mode == Mode::Triangles {
            self.len() / 3
        } else {
            self.len().saturating_sub(2)
        }
    }

    /// Appends the triangles over drawn vertices that begin at `first`. A strip's stitches (two equal corners) are
    /// left out: they are there to be skipped.
    fn triangles(&self, mode: Mode, winding: Winding, first: u32, out: &mut Vec<[DrawnVertex; 3]>) {
        let corner = |k: usize| match self {
            Self::Listed(indices) => indices[k],
            Self::Counted(_) => k as u32,
        };
        let triangle = |t: usize| match mode {
            Mode::Strip if t % 2 == 1 => [corner(t + 1), corner(t), corner(t + 2)],
            Mode::Strip => [corner(t), corner(t + 1), corner(t + 2)],
            Mode::Fan => [corner(0), corner(t + 1), corner(t + 2)],
            _ => [corner(3 * t), corner(3 * t + 1), corner(3 * t + 2)],
        };
        let wound = |[a, b, c]: [u32; 3]| {
            let corners = if winding == Winding::Flipped {
                [a, c, b]
            } else {
                [a, b, c]
            };
            corners.map(|corner| DrawnVertex(first + corner))
        };
        let all = (0..self.count(mode)).into_par_iter().with_min_len(CHUNK);
        if mode == Mode::Triangles {
            out.par_extend(all.map(|t| wound(triangle(t))));
        } else {
            let is_drawn = |[a, b, c]: &[u32; 3]| a != b && b != c && c != a;
            out.par_extend(all.map(triangle).filter(is_drawn).map(wound));
        }
    }
}
