//! The drawn set of a glTF: every vertex of the default scene's triangles, lines and points, seen through its node.
//!
//! **Numbering.** File vertices are the elements of POSITION accessors. Accessors come in the order in which the
//! file's primitives first name them: meshes in the file's order, a mesh's primitives in theirs, drawn or not, in any
//! mode; one that several primitives name is counted once.
//!
//! Drawn vertices come node by node (depth first), copy by copy if a node shows several, primitive by primitive: those
//! of triangles, then those of lines and points. Primitives of one mesh that name the same accessors share their drawn
//! vertices, so that a mesh cut into a hundred materials is not multiplied by a hundred. Lines and points share those
//! of any primitive with the same positions.

mod corners;
pub(crate) mod draco;
pub(crate) mod instancing;
pub(crate) mod meshopt;
pub(crate) mod playback;
mod pose;
pub(crate) mod primitive;
mod rounding;
mod skins;
pub(crate) mod targets;
pub(crate) mod tree;
mod weights;

use std::collections::HashMap;
use std::ops::Range;

use glam::{DAffine3, Vec3};
use pliant_mesh::{Cancel, Drawn, DrawnVertex, FileVertex, Progress, Rounding};
use rayon::prelude::*;

use crate::gltf::document::Document;
use crate::gltf::document::fault::Fault;
use crate::gltf::document::json::At;
use crate::gltf::document::layout::Layout;
use crate::gltf::geometry::corners::{Winding, corner_count, corners, triangle_count};
use crate::gltf::geometry::pose::SkinPose;
pub(crate) use crate::gltf::geometry::pose::{Linear, Pose};
use crate::gltf::geometry::primitive::{Mode, Primitive};
use crate::gltf::geometry::rounding::Coding;
use crate::gltf::geometry::tree::{Placed, unread_skin};
use crate::source::notes::Notes;

/// The drawn vertices of one attribute set seen through one node.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Instance {
    pub node: usize,
    /// The number of its node's copy; 0 if there is one.
    pub copy: usize,
    pub mesh: usize,
    pub pose: Pose,
    /// Its drawn vertices: element `e` is vertex `vertices.start + e`.
    pub vertices: Range<u32>,
    /// The primitive whose attributes these are (others of the mesh may name the same).
    pub primitive: usize,
    /// The morph targets that are applied by default, with their weights.
    pub weights: Vec<(usize, f64)>,
}

/// The triangles of one primitive seen through one node.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Piece {
    pub instance: usize,
    pub primitive: usize,
    /// Range of the drawn triangles.
    pub triangles: Range<u32>,
}

/// The composition of the drawn set.
#[derive(Clone, PartialEq, Debug, Default)]
pub(crate) struct Pieces {
    pub instances: Vec<Instance>,
    pub pieces: Vec<Piece>,
}

/// The memory of a piece besides its triangles: its own description, a group's and an object's.
const PIECE_BYTES: usize = 256;

/// The number of vertices for one task.
const CHUNK: usize = 1 << 14;

/// Reads the drawn set.
pub(crate) fn drawn(
    document: &Document,
    meshes: &[Vec<Primitive>],
    placed: &[Placed],
    notes: &mut Notes,
    progress: &Progress,
    cancel: &Cancel,
) -> Result<(Drawn, Pieces), Fault> {
    let (first_file_vertex, file_vertex_count) = number_file_vertices(document, meshes)?;
    let mut gathering = Gathering {
        document,
        cancel,
        drawn: Drawn {
            file_vertex_count,
            ..Drawn::default()
        },
        pieces: Pieces::default(),
        notes,
        budget: document.drawing_budget(),
    };
    let mut weights = Weights::default();
    let mut first_alike: HashMap<usize, Vec<usize>> = HashMap::new();
    for (number, place) in placed.iter().enumerate() {
        cancel.check()?;
        let primitives = &meshes[place.mesh];
        let alike = first_alike
            .entry(place.mesh)
            .or_insert_with(|| primitive::first_alike(primitives));
        let mut instance_of: HashMap<usize, usize> = HashMap::new();
        // The first primitive with each accessor of positions, and its instance.
        let mut instance_at: HashMap<usize, (usize, usize)> = HashMap::new();
        let applied = weights.of(document, place);
        spend(
            &mut gathering.budget,
            primitives.len(),
            PIECE_BYTES,
            "runs of triangles",
        )?;
        for (number, primitive, mode) in primitive::triangles_first(primitives) {
            cancel.check()?;
            let Some(position) = primitive.position else {
                continue;
            };
            let here = || format!("mesh {} primitive {number}", place.mesh);
            match primitive.check_decoded(document) {
                Err(what) if mode.makes_triangles() => return Err(format!("{} {what}", here()).into()),
                // Lines and points that can't be read are kept and not drawn.
                Err(_) => continue,
                Ok(()) => {}
            }
            let layout = document.layout(position)?;
            if layout.lanes != 3 {
                return Err(format!("{}: POSITION is not made of three numbers each", here()).into());
            }
            let same_positions = instance_at
                .get(&position)
                .filter(|(other, _)| !mode.makes_triangles() && primitive.moves_as(&primitives[*other]));
            let instance = match (instance_of.get(&alike[number]), same_positions) {
                (Some(&known), _) | (None, Some(&(_, known))) => known,
                (None, None) => {
                    let first = first_file_vertex[position];
                    let added = gathering.instance(place, primitive, number, &layout, first, applied)?;
                    instance_of.insert(alike[number], added);
                    instance_at.entry(position).or_insert((number, added));
                    added
                }
            };
            gathering.piece(place, primitive, mode, number, layout.count, instance)?;
        }
        progress.set((number + 1) as f32 / placed.len() as f32);
    }
    Ok((gathering.drawn, gathering.pieces))
}

/// The drawn set during reading.
struct Gathering<'a> {
    document: &'a Document,
    cancel: &'a Cancel,
    drawn: Drawn,
    pieces: Pieces,
    notes: &'a mut Notes,
    /// The rest of the budget in bytes.
    budget: usize,
}

impl Gathering<'_> {
    /// Adds the vertices of primitive `number`, seen through a node, and returns their instance's number.
    fn instance(
        &mut self,
        place: &Placed,
        primitive: &Primitive,
        number: usize,
        layout: &Layout,
        first_file_vertex: Option<u32>,
        applied: &[(usize, f64)],
    ) -> Result<usize, Fault> {
        let vertex_bytes = size_of::<[f64; 3]>() + size_of::<FileVertex>();
        spend(&mut self.budget, layout.count, vertex_bytes, "vertices")?;
        let start = self.drawn.positions.len() as u32;
        let weights: Vec<(usize, f64)> = applied
            .iter()
            .copied()
            .take_while(|(target, _)| *target < primitive.targets.len())
            .collect();
        // Every target is read for every instance that applies it.
        let numbers = weights.len().saturating_mul(layout.count.max(2));
        spend(
            &mut self.budget,
            numbers,
            size_of::<[f32; 3]>(),
            "numbers of morph targets",
        )?;
        let mut positions = layout.floats::<3>(self.document);
        let coding = match draco::extension_of(self.document, primitive) {
            Some(_) => Coding::Draco,
            None => Coding::Plain,
        };
        let pose = self.pose(place, primitive, layout.count)?;
        let rounding = rounding::distance(layout, coding, &positions, &pose);
        let targets = weights
            .iter()
            .map(|&(target, weight)| (primitive.targets[target].position, weight));
        apply_targets(self.document, &mut positions, targets, self.cancel)?;
        place_vertices(&positions, &pose, first_file_vertex, &mut self.drawn);
        self.drawn.roundings.push(Rounding {
            vertices: start..self.drawn.positions.len() as u32,
            distance: rounding,
        });
        self.pieces.instances.push(Instance {
            node: place.node,
            copy: place.copy,
            mesh: place.mesh,
            pose,
            vertices: start..self.drawn.positions.len() as u32,
            primitive: number,
            weights,
        });
        Ok(self.pieces.instances.len() - 1)
    }

    /// The transforms of the primitive's vertices by its skin or node. A skin that can't be read is noted.
    fn pose(&mut self, place: &Placed, primitive: &Primitive, count: usize) -> Result<Pose, Fault> {
        let by_node = Pose::Node(place.world_from_node);
        let Some(skin) = &place.skin else {
            return Ok(by_node);
        };
        spend(&mut self.budget, count, size_of::<DAffine3>(), "vertices of a skin")?;
        let called = self.document.called(place.node);
        match skins::transforms(self.document, primitive, skin, count) {
            Ok(Some(transforms)) => {
                let pose = Pose::Skin(SkinPose::of(transforms));
                let flattened = pose.flattened_count();
                let note = (flattened > 0).then(|| {
                    let vertices = if flattened == 1 { "vertex" } else { "vertices" };
                    format!(
                        "The skin of {called} flattens {flattened} {vertices}, so their moves can't be saved: they \
                         stay as they are."
                    )
                });
                self.notes.add("skins", note);
                Ok(pose)
            }
            Ok(None) => Ok(by_node),
            Err(reason) => {
                self.notes.add("skins", Some(unread_skin(&called, &reason)));
                Ok(by_node)
            }
        }
    }

    /// Adds the triangles or lines of primitive `number`, whose `vertex_count` vertices are those of `instance`.
    fn piece(
        &mut self,
        place: &Placed,
        primitive: &Primitive,
        mode: Mode,
        number: usize,
        vertex_count: usize,
        instance: usize,
    ) -> Result<(), Fault> {
        let corner_count = corner_count(self.document, primitive, vertex_count)?;
        match mode {
            Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip => {
                spend(&mut self.budget, corner_count, size_of::<[DrawnVertex; 2]>(), "lines")?;
            }
            Mode::Triangles | Mode::Strip | Mode::Fan => {
                let count = triangle_count(mode, corner_count);
                spend(&mut self.budget, count, size_of::<[DrawnVertex; 3]>(), "triangles")?;
            }
        }
        let corners = corners(self.document, primitive, vertex_count)
            .map_err(|what| format!("mesh {} primitive {number} {what}", place.mesh))?;
        let start = self.drawn.triangles.len() as u32;
        let of_piece = &self.pieces.instances[instance];
        let winding = if of_piece.pose.is_mirrored() {
            Winding::Flipped
        } else {
            Winding::AsStored
        };
        let first = of_piece.vertices.start;
        if mode.makes_triangles() {
            corners.triangles(mode, winding, first, &mut self.drawn.triangles);
        } else {
            corners.lines(mode, first, &mut self.drawn.lines);
        }
        self.pieces.pieces.push(Piece {
            instance,
            primitive: number,
            triangles: start..self.drawn.triangles.len() as u32,
        });
        Ok(())
    }
}

/// The first file vertex of each accessor that is a POSITION, and the number of file vertices.
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
    let most = document.drawing_budget() / size_of::<u32>();
    if count > most.min(u32::MAX as usize) as u64 {
        return Err(Fault::TooLarge(format!("{count} vertices")));
    }
    Ok((first, count as usize))
}

fn spend(budget: &mut usize, count: usize, bytes_each: usize, what: &str) -> Result<(), Fault> {
    let left = count
        .checked_mul(bytes_each)
        .and_then(|bytes| budget.checked_sub(bytes));
    *budget = left.ok_or_else(|| Fault::TooLarge(format!("{count} {what} more, each seen through a node,")))?;
    Ok(())
}

/// The weights that nodes and meshes give to morph targets, each list read once.
#[derive(Default)]
struct Weights {
    of_mesh: HashMap<usize, Vec<(usize, f64)>>,
    of_node: Vec<(usize, f64)>,
}

impl Weights {
    /// The targets that a node, or else its mesh, applies, with their weights.
    fn of(&mut self, document: &Document, place: &Placed) -> &[(usize, f64)] {
        let json = &document.json;
        let read = |list: At| {
            let numbers = json.elements(list).map(|at| json.number(at).unwrap_or(0.0));
            let applied = numbers.enumerate();
            applied
                .filter(|(_, weight)| *weight != 0.0 && weight.is_finite())
                .collect()
        };
        match json.member(document.nodes_at[place.node], "weights") {
            Some(own) => {
                self.of_node = read(own);
                &self.of_node
            }
            None => self.of_mesh.entry(place.mesh).or_insert_with(|| {
                let list = json.member(document.meshes_at[place.mesh], "weights");
                list.map(read).unwrap_or_default()
            }),
        }
    }
}

/// Adds the displacements of morph targets, each times its weight. A target of another count is refused.
pub(crate) fn apply_targets(
    document: &Document,
    elements: &mut [[f32; 3]],
    targets: impl Iterator<Item = (Option<usize>, f64)>,
    cancel: &Cancel,
) -> Result<(), Fault> {
    for (accessor, weight) in targets {
        cancel.check()?;
        let Some(accessor) = accessor else { continue };
        let layout = document.layout(accessor)?;
        if layout.count != elements.len() || layout.lanes != 3 {
            let reason = format!("accessor {accessor}, a morph target, is not of its base's size");
            return Err(Fault::Malformed(reason));
        }
        for (element, way) in elements.iter_mut().zip(layout.floats::<3>(document)) {
            (0..3).for_each(|lane| element[lane] = (f64::from(element[lane]) + weight * f64::from(way[lane])) as f32);
        }
    }
    Ok(())
}

fn place_vertices(positions: &[[f32; 3]], pose: &Pose, first_file_vertex: Option<u32>, drawn: &mut Drawn) {
    let first = first_file_vertex.unwrap_or(0);
    let positioned = positions.par_iter().with_min_len(CHUNK);
    let point = |p: &[f32; 3]| Vec3::from_array(*p).as_dvec3();
    match pose {
        Pose::Node(world_from_node) => {
            let world = |p| world_from_node.transform_point3(point(p));
            drawn.positions.par_extend(positioned.map(world));
        }
        Pose::Skin(skin) => {
            let skinned = positioned.zip(skin.transforms());
            let world = skinned.map(|(p, transform)| transform.transform_point3(point(p)));
            drawn.positions.par_extend(world);
        }
    }
    drawn
        .file_vertex
        .extend((first..).take(positions.len()).map(FileVertex));
}
