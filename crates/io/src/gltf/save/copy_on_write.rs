//! The copy-on-write plan of a save: which meshes are cloned and which accessors are copied, so that unchanged parts
//! stay shared.
//!
//! A mesh that several nodes, or several copies of one node, show is cloned if the edit makes them differ; those that
//! did not move, or else the first ones, keep the original. A node that shows it without being drawn did not move. An
//! accessor that several primitives use is copied if they differ; unchanged uses, and those that are not vertex
//! attributes (morph targets, animations, skins), keep the original.

use std::collections::hash_map::Entry;
use std::collections::{BTreeMap, HashMap};
use std::hash::{DefaultHasher, Hash as _, Hasher as _};

use crate::gltf::document::Document;
use crate::gltf::geometry::Pieces;
use crate::gltf::geometry::primitive::Primitive;
use crate::gltf::save::changes::{Change, InstanceChange, Rest, Semantic};
use crate::gltf::save::elsewhere;
use crate::gltf::save::turned_triangles::Turned;
use crate::save::course::Course;
use pliant_mesh::Cancelled;
use rayon::prelude::*;

/// A mesh after the edit: the file's own, or a clone of it.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct MeshCopy {
    pub mesh: usize,
    pub is_clone: bool,
    /// The places where it is drawn.
    pub uses: Vec<MeshUse>,
    /// The instance with each primitive's attributes, if it is drawn.
    pub instances: Vec<Option<usize>>,
}

/// A node that shows a mesh, and the number of the copy if it shows several.
pub(crate) type MeshUse = (usize, usize);

impl MeshCopy {
    /// Returns true if it is drawn: the file's own mesh may be left to nodes that are not.
    pub fn is_drawn(&self) -> bool {
        !self.uses.is_empty()
    }

    /// The instance that determines each primitive's change. A primitive that is not drawn (for example lines along a
    /// surface's edges) follows a drawn one of its mesh with the same positions.
    pub fn followed_instances(&self, primitives: &[Primitive]) -> Vec<Option<usize>> {
        let mut leader: HashMap<Option<usize>, usize> = HashMap::new();
        for (instance, primitive) in self.instances.iter().zip(primitives) {
            if let Some(instance) = instance {
                leader.entry(primitive.position).or_insert(*instance);
            }
        }
        let each = self.instances.iter().zip(primitives);
        each.map(|(instance, primitive)| instance.or_else(|| leader.get(&primitive.position).copied()))
            .collect()
    }
}

/// A primitive's attribute in one of the copies.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct AttributeUse {
    pub copy: usize,
    pub primitive: usize,
    pub semantic: Semantic,
}

/// One version of an accessor after the edit, and the attributes that need it.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct AccessorVersion<'a> {
    pub change: &'a Change,
    pub semantic: Semantic,
    pub used_by: Vec<AttributeUse>,
}

/// The versions of an accessor: the one that it takes itself, then those that need a new accessor.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct AccessorPlan<'a> {
    pub in_place: AccessorVersion<'a>,
    pub copies: Vec<AccessorVersion<'a>>,
}

static UNCHANGED: Change = Change::new();

/// The most different edits of one mesh that are compared with each other; further ones are only compared exactly, by
/// hash.
const MOST_CLASSES_COMPARED: usize = 64;

/// The number of elements that are hashed at a time.
const BLOCK: usize = 1 << 13;

/// A number for each instance's changes, by attribute; equal for equal ones.
pub(crate) fn hashes(changes: &[InstanceChange]) -> Vec<[u64; 3]> {
    let of_block = |block: &[(u32, [f32; 4])]| {
        let mut hasher = DefaultHasher::new();
        for (element, new) in block {
            // Adding zero turns -0 into 0, which is equal to it.
            (element, new.map(|number| (number + 0.0).to_bits())).hash(&mut hasher);
        }
        hasher.finish()
    };
    let of_change = |change: &Change| {
        let blocks: Vec<u64> = change.par_chunks(BLOCK).map(of_block).collect();
        let mut hasher = DefaultHasher::new();
        blocks.hash(&mut hasher);
        hasher.finish()
    };
    let of_instance = |instance: &InstanceChange| Semantic::ALL.map(|semantic| of_change(instance.of(semantic)));
    changes.iter().map(of_instance).collect()
}

/// The meshes after the edit, the file's own first (mesh `m` is copy `m`), then the clones. `hashes` are those of the
/// changes.
pub(crate) fn plan_meshes(
    document: &Document,
    meshes: &[Vec<Primitive>],
    pieces: &Pieces,
    (changes, turned): (&[InstanceChange], &Turned),
    hashes: &[[u64; 3]],
    course: &Course<'_>,
) -> Result<Vec<MeshCopy>, Cancelled> {
    let mut copies: Vec<MeshCopy> = meshes
        .iter()
        .enumerate()
        .map(|(mesh, primitives)| MeshCopy {
            mesh,
            is_clone: false,
            uses: Vec::new(),
            instances: vec![None; primitives.len()],
        })
        .collect();
    let mut clones = Vec::new();
    let mut rest = Rest::default();
    let elsewhere = elsewhere::meshes(document, pieces);
    for (mesh, uses) in uses(meshes, pieces) {
        let mut is_same = |a: &[Option<usize>], b: &[Option<usize>]| {
            let mut primitives = meshes[mesh].iter().zip(a.iter().zip(b));
            primitives.all(|(primitive, instances)| match instances {
                (Some(a), Some(b)) => Semantic::ALL.into_iter().all(|semantic| {
                    let [a, b] = [a, b].map(|&instance| changes[instance].of(semantic));
                    let accessor = semantic.accessor(primitive);
                    accessor.is_none_or(|accessor| rest.comes_to_the_same(document, accessor, a, b))
                }),
                (a, b) => a == b,
            })
        };
        let mut classes: Vec<(Vec<Option<usize>>, Vec<MeshUse>)> = Vec::new();
        let mut class_of: HashMap<u64, usize> = HashMap::new();
        for (place, instances) in uses {
            course.reach(0, 1)?;
            let mut hasher = DefaultHasher::new();
            instances
                .iter()
                .for_each(|instance| instance.map(|instance| hashes[instance]).hash(&mut hasher));
            let likely = class_of.entry(hasher.finish());
            let mut candidates = match likely {
                Entry::Occupied(ref entry) => *entry.get()..*entry.get() + 1,
                Entry::Vacant(_) => 0..classes.len().min(MOST_CLASSES_COMPARED),
            };
            let class = candidates.find(|&class| is_same(&classes[class].0, &instances));
            let class = class.unwrap_or(classes.len());
            likely.or_insert(class);
            match classes.get_mut(class) {
                Some((_, places)) => places.push(place),
                None => classes.push((instances, vec![place])),
            }
        }
        let is_turned = turned.range((mesh, 0)..(mesh + 1, 0)).next().is_some();
        let is_unmoved = |instances: &[Option<usize>]| {
            let mut instances = instances.iter().flatten();
            !is_turned && instances.all(|&instance| changes[instance].is_empty())
        };
        let unmoved = classes.iter().position(|(instances, _)| is_unmoved(instances));
        let own = unmoved.or((!elsewhere.contains(&mesh)).then_some(0));
        for (number, (instances, uses)) in classes.into_iter().enumerate() {
            let is_clone = own != Some(number);
            let copy = MeshCopy {
                mesh,
                is_clone,
                uses,
                instances,
            };
            match is_clone {
                true => clones.push(copy),
                false => copies[mesh] = copy,
            }
        }
    }
    copies.extend(clones);
    Ok(copies)
}

/// The nodes that show a mesh, and the instance of each primitive.
type DrawnUse = (MeshUse, Vec<Option<usize>>);

/// For each mesh, the nodes that show it, in drawing order, with the instance of each primitive.
fn uses(meshes: &[Vec<Primitive>], pieces: &Pieces) -> BTreeMap<usize, Vec<DrawnUse>> {
    let mut uses: BTreeMap<usize, Vec<DrawnUse>> = BTreeMap::new();
    for piece in &pieces.pieces {
        let instance = &pieces.instances[piece.instance];
        let of_mesh = uses.entry(instance.mesh).or_default();
        let place = (instance.node, instance.copy);
        // Pieces of one node, and of one copy, are adjacent.
        if of_mesh.last().is_none_or(|(last, _)| *last != place) {
            of_mesh.push((place, vec![None; meshes[instance.mesh].len()]));
        }
        if let Some((_, instances)) = of_mesh.last_mut() {
            instances[piece.primitive] = Some(piece.instance);
        }
    }
    uses
}

/// The plan of each accessor that any attribute needs changed.
pub(crate) fn plan_accessors<'a>(
    document: &Document,
    meshes: &[Vec<Primitive>],
    copies: &[MeshCopy],
    changes: &'a [InstanceChange],
    hashes: &[[u64; 3]],
    course: &Course<'_>,
) -> Result<BTreeMap<usize, AccessorPlan<'a>>, Cancelled> {
    let mut versions = versions_of_accessors(meshes, copies, changes, hashes, course)?;
    versions.retain(|_, versions| versions.iter().any(|version| !version.change.is_empty()));
    let elsewhere = elsewhere::accessors(document, meshes);
    let plans = versions
        .into_iter()
        .filter_map(|(accessor, mut versions)| {
            if elsewhere.contains(&accessor) && versions.iter().all(|version| !version.change.is_empty()) {
                let semantic = versions.first()?.semantic;
                versions.push(AccessorVersion {
                    change: &UNCHANGED,
                    semantic,
                    used_by: Vec::new(),
                });
            }
            let own = versions
                .iter()
                .position(|version| version.change.is_empty())
                .unwrap_or(0);
            let in_place = versions.remove(own);
            Some((
                accessor,
                AccessorPlan {
                    in_place,
                    copies: versions,
                },
            ))
        })
        .collect();
    Ok(plans)
}

/// Every version of each accessor that the copies' attributes use, with the attributes that use it.
fn versions_of_accessors<'a>(
    meshes: &[Vec<Primitive>],
    copies: &[MeshCopy],
    changes: &'a [InstanceChange],
    hashes: &[[u64; 3]],
    course: &Course<'_>,
) -> Result<BTreeMap<usize, Vec<AccessorVersion<'a>>>, Cancelled> {
    let mut versions: BTreeMap<usize, Vec<AccessorVersion<'a>>> = BTreeMap::new();
    // For each accessor and hash, the accessor's versions with this hash.
    let mut known: HashMap<(usize, u64), Vec<usize>> = HashMap::new();
    for (copy, of_copy) in copies.iter().enumerate() {
        course.reach(0, 1)?;
        let primitives = &meshes[of_copy.mesh];
        let leaders = leaders(primitives, of_copy);
        for (primitive, named) in primitives.iter().enumerate() {
            for (place, semantic) in Semantic::ALL.into_iter().enumerate() {
                let Some(accessor) = semantic.accessor(named) else {
                    continue;
                };
                let instance = of_copy.instances[primitive].or_else(|| leaders.get(&(place, accessor)).copied());
                let (change, hash) = instance.map_or((&UNCHANGED, UNCHANGED_HASH), |instance| {
                    let change = changes[instance].of(semantic);
                    let hash = if change.is_empty() {
                        UNCHANGED_HASH
                    } else {
                        hashes[instance][place]
                    };
                    (change, hash)
                });
                let of_accessor = versions.entry(accessor).or_default();
                let attribute = AttributeUse {
                    copy,
                    primitive,
                    semantic,
                };
                let alike = known.entry((accessor, hash)).or_default();
                let same = |&place: &usize| {
                    let other = of_accessor[place].change;
                    std::ptr::eq(other, change) || other == change
                };
                match alike.iter().copied().find(same) {
                    Some(place) => of_accessor[place].used_by.push(attribute),
                    None => {
                        alike.push(of_accessor.len());
                        of_accessor.push(AccessorVersion {
                            change,
                            semantic,
                            used_by: vec![attribute],
                        });
                    }
                }
            }
        }
    }
    Ok(versions)
}

/// For each place in [`Semantic::ALL`] and accessor, the instance of the first drawn primitive that uses it there.
/// Primitives that are not drawn and use it too follow that instance.
fn leaders(primitives: &[Primitive], copy: &MeshCopy) -> HashMap<(usize, usize), usize> {
    let mut leaders: HashMap<(usize, usize), usize> = HashMap::new();
    for (instance, named) in copy.instances.iter().zip(primitives) {
        for (place, semantic) in Semantic::ALL.into_iter().enumerate() {
            if let (Some(instance), Some(accessor)) = (instance, semantic.accessor(named)) {
                leaders.entry((place, accessor)).or_insert(*instance);
            }
        }
    }
    leaders
}

/// The hash of unchanged data.
const UNCHANGED_HASH: u64 = 0;
