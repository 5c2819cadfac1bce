//! Who asks for which numbers of which accessor: where a mesh must be cloned and an accessor doubled.
//!
//! A mesh that several nodes show is cloned where the nodes come to differ; the nodes that did not move, or else the
//! first ones, keep the original. An accessor that several primitives name is doubled where they come to differ;
//! whoever did not change (or is no vertex attribute at all: morph targets, animations, skins) keeps the original.

use std::collections::{BTreeMap, BTreeSet};

use super::changes::{Change, PartChange, Rest, Semantic};
use super::document::Document;
use super::geometry::Pieces;
use super::json::At;
use super::primitive::Primitive;

/// A mesh after the edit: the file's own, or a clone of it.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct MeshCopy {
    pub mesh: usize,
    /// `None` for the file's own mesh; the nodes that a clone is for.
    pub clone_for: Option<Vec<usize>>,
    /// The part that each primitive's attributes come from, where it is drawn.
    pub parts: Vec<Option<usize>>,
}

impl MeshCopy {
    /// The part that says what becomes of a primitive. One that is not drawn (the lines along a surface's edges, say)
    /// follows a drawn one of its mesh that names the same positions.
    pub fn part_of(&self, primitives: &[Primitive], primitive: usize) -> Option<usize> {
        let position = primitives[primitive].position;
        let followed = || {
            let others = self.parts.iter().zip(primitives);
            others
                .filter(|(_, other)| other.position == position)
                .find_map(|(part, _)| *part)
        };
        self.parts[primitive].or_else(followed)
    }
}

/// A primitive's attribute in one of the copies.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Naming {
    pub copy: usize,
    pub primitive: usize,
    pub semantic: Semantic,
}

/// Those who ask for the same change of an accessor.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Claim<'a> {
    pub change: &'a Change,
    pub semantic: Semantic,
    pub namings: Vec<Naming>,
}

/// What becomes of an accessor: its own claim, then those that need a new one.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Outcome<'a> {
    pub kept: Claim<'a>,
    pub moved_out: Vec<Claim<'a>>,
}

static UNCHANGED: Change = Change::new();

/// The meshes after the edit, the file's own first (mesh `m` is copy `m`), then the clones.
pub(super) fn copies(
    document: &Document,
    meshes: &[Vec<Primitive>],
    pieces: &Pieces,
    changes: &[PartChange],
) -> Vec<MeshCopy> {
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
        for (node, parts) in uses {
            match classes.iter_mut().find(|(other, _)| is_same(other, &parts)) {
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
    copies
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
pub(super) fn outcomes<'a>(
    document: &Document,
    meshes: &[Vec<Primitive>],
    copies: &[MeshCopy],
    changes: &'a [PartChange],
) -> BTreeMap<usize, Outcome<'a>> {
    let mut claims: BTreeMap<usize, Vec<Claim<'a>>> = BTreeMap::new();
    for (copy, of_copy) in copies.iter().enumerate() {
        for (primitive, named) in meshes[of_copy.mesh].iter().enumerate() {
            for semantic in Semantic::ALL {
                let Some(accessor) = semantic.accessor(named) else {
                    continue;
                };
                let change = change_of(&meshes[of_copy.mesh], of_copy, primitive, semantic, changes);
                let of_accessor = claims.entry(accessor).or_default();
                let naming = Naming {
                    copy,
                    primitive,
                    semantic,
                };
                match of_accessor
                    .iter_mut()
                    .find(|claim| std::ptr::eq(claim.change, change) || claim.change == change)
                {
                    Some(claim) => claim.namings.push(naming),
                    None => of_accessor.push(Claim {
                        change,
                        semantic,
                        namings: vec![naming],
                    }),
                }
            }
        }
    }
    claims.retain(|_, claims| claims.iter().any(|claim| !claim.change.is_empty()));
    let elsewhere = used_elsewhere(document, meshes);
    claims
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
        .collect()
}

/// What a primitive wants of an attribute. One that is not drawn (the lines along a surface's edges, say) follows a
/// drawn one of its mesh that names the same accessor.
fn change_of<'a>(
    primitives: &[Primitive],
    copy: &MeshCopy,
    primitive: usize,
    semantic: Semantic,
    changes: &'a [PartChange],
) -> &'a Change {
    let accessor = semantic.accessor(&primitives[primitive]);
    let followed = || {
        let others = copy.parts.iter().zip(primitives);
        others
            .filter(|(_, other)| semantic.accessor(other) == accessor)
            .find_map(|(part, _)| *part)
    };
    match copy.parts[primitive].or_else(followed) {
        Some(part) => changes[part].of(semantic),
        None => &UNCHANGED,
    }
}

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
