//! Who asks for which numbers of which accessor: where a mesh must be cloned and an accessor doubled.
//!
//! A mesh that several nodes show is cloned where the nodes come to differ; the nodes that did not move, or else the
//! first ones, keep the original. An accessor that several primitives name is doubled where they come to differ;
//! whoever did not change (or is no vertex attribute at all: morph targets, animations, skins) keeps the original.

use std::collections::hash_map::Entry;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::hash::{DefaultHasher, Hash as _, Hasher as _};

use crate::gltf::document::Document;
use crate::gltf::document::json::At;
use crate::gltf::geometry::Pieces;
use crate::gltf::geometry::primitive::Primitive;
use crate::gltf::save::changes::{Change, PartChange, Rest, Semantic};
use crate::save::course::Course;
use pliant_mesh::Cancelled;

/// A mesh after the edit: the file's own, or a clone of it.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct MeshCopy {
    pub mesh: usize,
    /// `None` for the file's own mesh; the nodes that a clone is for.
    pub clone_for: Option<Vec<usize>>,
    /// The part that each primitive's attributes come from, where it is drawn.
    pub parts: Vec<Option<usize>>,
}

impl MeshCopy {
    /// The part that says what becomes of each primitive. One that is not drawn (the lines along a surface's edges, say)
    /// follows a drawn one of its mesh that names the same positions.
    pub fn followed_parts(&self, primitives: &[Primitive]) -> Vec<Option<usize>> {
        let mut leader: HashMap<Option<usize>, usize> = HashMap::new();
        for (part, primitive) in self.parts.iter().zip(primitives) {
            if let Some(part) = part {
                leader.entry(primitive.position).or_insert(*part);
            }
        }
        let each = self.parts.iter().zip(primitives);
        each.map(|(part, primitive)| part.or_else(|| leader.get(&primitive.position).copied()))
            .collect()
    }
}

/// A primitive's attribute in one of the copies.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Naming {
    pub copy: usize,
    pub primitive: usize,
    pub semantic: Semantic,
}

/// Those who ask for the same change of an accessor.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Claim<'a> {
    pub change: &'a Change,
    pub semantic: Semantic,
    pub namings: Vec<Naming>,
}

/// What becomes of an accessor: its own claim, then those that need a new one.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Outcome<'a> {
    pub kept: Claim<'a>,
    pub moved_out: Vec<Claim<'a>>,
}

static UNCHANGED: Change = Change::new();

/// Nodes of one mesh with this many different edits: further ones are told apart by their exact numbers alone, instead
/// of being compared with each of them.
const MOST_CLASSES_COMPARED: usize = 64;

/// A number for each part's changes, by attribute; equal for equal ones.
fn hashes(changes: &[PartChange]) -> Vec<[u64; 3]> {
    let of_change = |change: &Change| {
        let mut hasher = DefaultHasher::new();
        for (element, new) in change {
            // Adding zero makes 0 of -0, which is equal to it.
            (element, new.map(|number| (number + 0.0).to_bits())).hash(&mut hasher);
        }
        hasher.finish()
    };
    let of_part = |part: &PartChange| Semantic::ALL.map(|semantic| of_change(part.of(semantic)));
    changes.iter().map(of_part).collect()
}

/// The meshes after the edit, the file's own first (mesh `m` is copy `m`), then the clones.
pub(crate) fn copies(
    document: &Document,
    meshes: &[Vec<Primitive>],
    pieces: &Pieces,
    changes: &[PartChange],
    course: &Course<'_>,
) -> Result<Vec<MeshCopy>, Cancelled> {
    let hashes = hashes(changes);
    let mut copies: Vec<MeshCopy> = meshes
        .iter()
        .enumerate()
        .map(|(mesh, primitives)| MeshCopy {
            mesh,
            clone_for: None,
            parts: vec![None; primitives.len()],
        })
        .collect();
    let mut clones = Vec::new();
    let mut rest = Rest::default();
    for (mesh, uses) in uses(meshes, pieces) {
        let mut is_same = |a: &[Option<usize>], b: &[Option<usize>]| {
            let mut primitives = meshes[mesh].iter().zip(a.iter().zip(b));
            primitives.all(|(primitive, parts)| match parts {
                (Some(a), Some(b)) => Semantic::ALL.into_iter().all(|semantic| {
                    let [a, b] = [a, b].map(|&part| changes[part].of(semantic));
                    let accessor = semantic.accessor(primitive);
                    accessor.is_none_or(|accessor| rest.comes_to_the_same(document, accessor, a, b))
                }),
                (a, b) => a == b,
            })
        };
        let mut classes: Vec<(Vec<Option<usize>>, Vec<usize>)> = Vec::new();
        let mut class_of: HashMap<u64, usize> = HashMap::new();
        for (node, parts) in uses {
            course.reach(0, 1)?;
            let mut hasher = DefaultHasher::new();
            parts
                .iter()
                .for_each(|part| part.map(|part| hashes[part]).hash(&mut hasher));
            let likely = class_of.entry(hasher.finish());
            let mut candidates = match likely {
                Entry::Occupied(ref entry) => *entry.get()..*entry.get() + 1,
                Entry::Vacant(_) => 0..classes.len().min(MOST_CLASSES_COMPARED),
            };
            let class = candidates.find(|&class| is_same(&classes[class].0, &parts));
            let class = class.unwrap_or(classes.len());
            likely.or_insert(class);
            match classes.get_mut(class) {
                Some((_, nodes)) => nodes.push(node),
                None => classes.push((parts, vec![node])),
            }
        }
        let is_unmoved = |parts: &[Option<usize>]| parts.iter().flatten().all(|&part| changes[part].is_empty());
        let own = classes.iter().position(|(parts, _)| is_unmoved(parts)).unwrap_or(0);
        for (number, (parts, nodes)) in classes.into_iter().enumerate() {
            if number == own {
                copies[mesh].parts = parts;
            } else {
                clones.push(MeshCopy {
                    mesh,
                    clone_for: Some(nodes),
                    parts,
                });
            }
        }
    }
    copies.extend(clones);
    Ok(copies)
}

/// A node that shows a mesh, and the part of each primitive.
type Use = (usize, Vec<Option<usize>>);

/// By mesh: the nodes that show it, in the order of drawing, with the part of each primitive.
fn uses(meshes: &[Vec<Primitive>], pieces: &Pieces) -> BTreeMap<usize, Vec<Use>> {
    let mut uses: BTreeMap<usize, Vec<Use>> = BTreeMap::new();
    for piece in &pieces.pieces {
        let part = &pieces.parts[piece.part];
        let of_mesh = uses.entry(part.mesh).or_default();
        // Pieces of one node stand together.
        if of_mesh.last().is_none_or(|(node, _)| *node != part.node) {
            of_mesh.push((part.node, vec![None; meshes[part.mesh].len()]));
        }
        if let Some((_, parts)) = of_mesh.last_mut() {
            parts[piece.primitive] = Some(piece.part);
        }
    }
    uses
}

/// What becomes of each accessor that anyone wants changed.
pub(crate) fn outcomes<'a>(
    document: &Document,
    meshes: &[Vec<Primitive>],
    copies: &[MeshCopy],
    changes: &'a [PartChange],
    course: &Course<'_>,
) -> Result<BTreeMap<usize, Outcome<'a>>, Cancelled> {
    let hashes = hashes(changes);
    let mut claims: BTreeMap<usize, Vec<Claim<'a>>> = BTreeMap::new();
    // Where among an accessor's claims those with a hash stand.
    let mut known: HashMap<(usize, u64), Vec<usize>> = HashMap::new();
    for (copy, of_copy) in copies.iter().enumerate() {
        course.reach(0, 1)?;
        let primitives = &meshes[of_copy.mesh];
        // Primitives that are not drawn follow a drawn one that names the same accessor.
        let mut leader: HashMap<(usize, usize), usize> = HashMap::new();
        for (part, named) in of_copy.parts.iter().zip(primitives) {
            for (place, semantic) in Semantic::ALL.into_iter().enumerate() {
                if let (Some(part), Some(accessor)) = (part, semantic.accessor(named)) {
                    leader.entry((place, accessor)).or_insert(*part);
                }
            }
        }
        for (primitive, named) in primitives.iter().enumerate() {
            for (place, semantic) in Semantic::ALL.into_iter().enumerate() {
                let Some(accessor) = semantic.accessor(named) else {
                    continue;
                };
                let part = of_copy.parts[primitive].or_else(|| leader.get(&(place, accessor)).copied());
                let (change, hash) = part.map_or((&UNCHANGED, UNCHANGED_HASH), |part| {
                    let change = changes[part].of(semantic);
                    let hash = if change.is_empty() {
                        UNCHANGED_HASH
                    } else {
                        hashes[part][place]
                    };
                    (change, hash)
                });
                let of_accessor = claims.entry(accessor).or_default();
                let naming = Naming {
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
                    Some(place) => of_accessor[place].namings.push(naming),
                    None => {
                        alike.push(of_accessor.len());
                        of_accessor.push(Claim {
                            change,
                            semantic,
                            namings: vec![naming],
                        });
                    }
                }
            }
        }
    }
    claims.retain(|_, claims| claims.iter().any(|claim| !claim.change.is_empty()));
    let elsewhere = used_elsewhere(document, meshes);
    let outcomes = claims
        .into_iter()
        .filter_map(|(accessor, mut claims)| {
            if elsewhere.contains(&accessor) && claims.iter().all(|claim| !claim.change.is_empty()) {
                let semantic = claims.first()?.semantic;
                claims.push(Claim {
                    change: &UNCHANGED,
                    semantic,
                    namings: Vec::new(),
                });
            }
            let own = claims.iter().position(|claim| claim.change.is_empty()).unwrap_or(0);
            let kept = claims.remove(own);
            Some((
                accessor,
                Outcome {
                    kept,
                    moved_out: claims,
                },
            ))
        })
        .collect();
    Ok(outcomes)
}

/// Stands for the hash of what does not change.
const UNCHANGED_HASH: u64 = 0;

/// Accessors that something else than a primitive's POSITION, NORMAL or TANGENT reads.
fn used_elsewhere(document: &Document, meshes: &[Vec<Primitive>]) -> BTreeSet<usize> {
    let json = &document.json;
    let section = |key: &str| {
        json.member(json.root(), key)
            .into_iter()
            .flat_map(|list| json.elements(list))
    };
    let mut named: Vec<At> = Vec::new();
    for primitive in meshes.iter().flatten() {
        let targets = json
            .member(primitive.at, "targets")
            .into_iter()
            .flat_map(|targets| json.elements(targets));
        named.extend(targets.flat_map(|target| json.members(target)).map(|(_, value)| value));
        named.extend(json.member(primitive.at, "indices"));
        let attributes = json
            .member(primitive.at, "attributes")
            .into_iter()
            .flat_map(|at| json.members(at));
        let ours = Semantic::ALL.map(|semantic| Some(semantic.key().to_owned()));
        named.extend(
            attributes
                .filter(|&(key, _)| !ours.contains(&json.string(key)))
                .map(|(_, value)| value),
        );
    }
    named.extend(section("skins").filter_map(|skin| json.member(skin, "inverseBindMatrices")));
    let samplers = section("animations").filter_map(|animation| json.member(animation, "samplers"));
    for sampler in samplers.flat_map(|samplers| json.elements(samplers)) {
        named.extend(["input", "output"].iter().filter_map(|key| json.member(sampler, key)));
    }
    named
        .into_iter()
        .filter_map(|at| json.number(at))
        .map(|number| number as usize)
        .collect()
}
