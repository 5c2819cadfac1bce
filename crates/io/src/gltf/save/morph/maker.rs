//! Targets added to the meshes of a file, with their weights.

use std::collections::BTreeMap;

use super::animated::{Animated, Channel};
use super::animation::{Animate, WeightCourse, default_weights};
use super::deltas::NewTarget;
use super::nodes::{node_of_different_copies, nodes_of_copies};
use super::weights::{Missing, append_names, append_weights};
use crate::gltf::document::Document;
use crate::gltf::document::json::{At, Edits};
use crate::gltf::geometry::instancing::EXTENSION;
use crate::gltf::geometry::primitive::Primitive;
use crate::gltf::save::changes::{InstanceChange, Semantic};
use crate::gltf::save::copy_on_write::MeshCopy;
use crate::gltf::save::patch::{Patch, Patched, cannot_hold};
use crate::quote::quoted;
use crate::save::course::Course;
use crate::{Format, SaveError};

/// Adds targets to the meshes that an edit changes.
pub(super) struct TargetMaker<'a, 'b> {
    patch: Patch<'a>,
    meshes: &'b [Vec<Primitive>],
    targets: &'b [NewTarget],
    /// The animation that goes through the targets.
    animation: Option<WeightCourse<'b>>,
    format: Format,
    /// The accessor of an instance's displacements, by target and attribute.
    deltas: BTreeMap<(usize, usize, usize), usize>,
    /// The accessor of this many zeros, by whether they are positions.
    zeros: BTreeMap<(usize, bool), usize>,
    /// The samplers to add to each of the file's animations, and their places.
    samplers: BTreeMap<usize, (At, Vec<String>)>,
    animated: Animated,
    /// The nodes that the new animation moves.
    moving: Vec<Animate>,
}

impl<'a, 'b> TargetMaker<'a, 'b> {
    /// No target is added yet.
    pub fn new(
        document: &'a Document,
        meshes: &'b [Vec<Primitive>],
        targets: &'b [NewTarget],
        animation: Option<WeightCourse<'b>>,
        format: Format,
    ) -> Self {
        Self {
            patch: Patch::new(document),
            meshes,
            targets,
            animation,
            format,
            deltas: BTreeMap::new(),
            zeros: BTreeMap::new(),
            samplers: BTreeMap::new(),
            animated: Animated::of(document),
            moving: Vec::new(),
        }
    }

    /// The document with the targets added to those of the `copies` that `changes`, one for each instance, change.
    pub fn finished(
        mut self,
        copies: &[MeshCopy],
        changes: &[InstanceChange],
        course: &Course<'_>,
    ) -> Result<Patched<'a>, SaveError> {
        let document = self.patch.document;
        if let Some(node) = node_of_different_copies(copies).filter(|_| self.animation.is_some()) {
            let called = document.called(node);
            return Err(self.refuse(format!("copies of {called} that differ ({EXTENSION})")));
        }
        let nodes = nodes_of_copies(document, copies);
        for (number, copy) in copies.iter().enumerate() {
            course.reach(number, copies.len())?;
            let mut instances = copy.instances.iter().flatten();
            if instances.any(|&instance| !changes[instance].is_empty()) {
                self.add_to(copies, number, &nodes[number])?;
            }
        }
        for (list, texts) in std::mem::take(&mut self.samplers).into_values() {
            self.patch.edits.append_elements(&document.json, list, &texts);
        }
        if let Some(animation) = self.animation.filter(|_| !self.moving.is_empty()) {
            self.patch.push_animation(animation, &self.moving, self.format)?;
        }
        self.patch.clone_meshes(copies, self.format)?;
        self.patch.finished(self.format)
    }

    fn refuse(&self, what: String) -> SaveError {
        SaveError::CannotHold {
            what: format!("a morph target beside {what}"),
            format: self.format,
            remedy: match self.animation {
                None => "save the edited shape itself",
                Some(_) => "write numbered files, NAME-####.glb",
            }
            .to_owned(),
        }
    }

    /// Adds the targets to a mesh or a clone.
    fn add_to(&mut self, copies: &[MeshCopy], number: usize, nodes: &[usize]) -> Result<(), SaveError> {
        let document = self.patch.document;
        let json = &document.json;
        let copy = &copies[number];
        let primitives = &self.meshes[copy.mesh];
        let known = primitives.first().map_or(0, |primitive| primitive.targets.len());
        if primitives.iter().any(|primitive| primitive.targets.len() != known) {
            let mesh = copy.mesh;
            return Err(self.refuse(format!(
                "those of mesh {mesh}, whose primitives have different numbers of morph targets"
            )));
        }
        for (primitive, instance) in primitives.iter().zip(copy.followed_instances(primitives)) {
            let targets = 0..self.targets.len();
            let texts: Vec<String> = targets
                .map(|target| self.target_of(primitive, instance, target))
                .collect::<Result<_, SaveError>>()?;
            let edits = self.patch.edits_of_copy(copies, number);
            match json.member(primitive.at, "targets") {
                Some(list) => edits.append_elements(json, list, &texts),
                None => edits.set_member(json, primitive.at, "targets", &format!("[{}]", texts.join(","))),
            }
        }
        let mesh = document.meshes_at[copy.mesh];
        let edits = self.patch.edits_of_copy(copies, number);
        append_weights(document, edits, mesh, known, self.targets, Missing::Write);
        if !append_names(document, edits, mesh, known, self.targets) {
            let names: Vec<String> = self.targets.iter().map(|target| quoted(&target.name)).collect();
            self.patch.out.warnings.push(format!(
                "The number of names of mesh {}'s morph targets differs from that of the targets, so '{}' has no name \
                 there.",
                copy.mesh,
                names.join(", ")
            ));
        }
        for &node in nodes {
            let at = document.nodes_at[node];
            append_weights(document, &mut self.patch.edits, at, known, self.targets, Missing::Leave);
            self.moving.push(Animate {
                node,
                kept: default_weights(document, at, mesh, known),
            });
        }
        self.widen_animations(copy.mesh, nodes, known)
    }

    /// A primitive's target as JSON.
    fn target_of(
        &mut self,
        primitive: &Primitive,
        instance: Option<usize>,
        target: usize,
    ) -> Result<String, SaveError> {
        let document = self.patch.document;
        let mut members = Vec::new();
        for (place, semantic) in Semantic::ALL.into_iter().enumerate() {
            let Some(base) = semantic.accessor(primitive) else {
                continue;
            };
            let layout = document.layout(base).map_err(|what| cannot_hold(what, self.format))?;
            let all = self.targets;
            let ways = instance.map(|instance| (instance, all[target].of_instances[instance].of(place)));
            let accessor = match ways.filter(|(_, ways)| !ways.is_empty()) {
                None => self.zeros(layout.count, semantic),
                Some((instance, ways)) => {
                    let key = (instance, target, place);
                    let accessor = match (self.deltas.get(&key), self.animation) {
                        (Some(&accessor), _) => accessor,
                        (None, None) => self.patch.push_ways(ways, semantic, self.format)?,
                        (None, Some(_)) => self.patch.push_few_ways(ways, semantic, self.format)?,
                    };
                    self.deltas.insert(key, accessor);
                    accessor
                }
            };
            members.push(format!("\"{}\":{accessor}", semantic.key()));
        }
        if members.is_empty() {
            return Err(self.refuse("a primitive without positions".to_owned()));
        }
        Ok(format!("{{{}}}", members.join(",")))
    }

    /// An accessor without bytes is all zeros.
    fn zeros(&mut self, count: usize, semantic: Semantic) -> usize {
        let is_position = semantic == Semantic::Position;
        let patch = &mut self.patch;
        *self.zeros.entry((count, is_position)).or_insert_with(|| {
            let bounds = if is_position {
                ",\"max\":[0,0,0],\"min\":[0,0,0]"
            } else {
                ""
            };
            patch.push_accessor(format!(
                "{{\"componentType\":5126,\"count\":{count},\"type\":\"VEC3\"{bounds}}}"
            ))
        })
    }

    /// Gives every animation of the weights of `nodes`, which show `mesh` with `known` targets, the new ones' weights.
    fn widen_animations(&mut self, mesh: usize, nodes: &[usize], known: usize) -> Result<(), SaveError> {
        let pointers = nodes.iter().map(|node| format!("/nodes/{node}/weights"));
        for pointer in pointers.chain([format!("/meshes/{mesh}/weights")]) {
            if let Some(animation) = self.animated.pointers.get(&pointer) {
                return Err(self.refuse(format!(
                    "animation {animation} of {} (KHR_animation_pointer)",
                    quoted(&pointer)
                )));
            }
        }
        let of_nodes = nodes.iter().filter_map(|node| self.animated.weights_of_node.get(node));
        let mut channels: Vec<Channel> = of_nodes.flatten().copied().collect();
        channels.sort_by_key(|channel| (channel.animation, channel.number));
        for Channel { animation, sampler, .. } in channels {
            let broken = || format!("animation {animation}, whose number of weights differs from that of the targets,");
            let samplers = &self.animated.samplers[animation];
            let found = sampler.and_then(|named| {
                let number = self.patch.document.json.number(named)? as usize;
                Some((
                    named,
                    *samplers.elements.get(number)?,
                    samplers.list?,
                    samplers.elements.len(),
                ))
            });
            let Some((named, sampler, list, count)) = found else {
                return Err(self.refuse(broken()));
            };
            let text = self.widened(sampler, known).ok_or_else(|| self.refuse(broken()))?;
            let added = self.samplers.entry(animation).or_insert_with(|| (list, Vec::new()));
            added.1.push(text);
            let number = count + added.1.len() - 1;
            let span = self.patch.document.json.span(named);
            self.patch.edits.replace(span, number.to_string());
        }
        Ok(())
    }

    /// A sampler whose output has the new targets' weights in each key too; `None` if it does not have `known` of them.
    fn widened(&mut self, sampler: At, known: usize) -> Option<String> {
        let document = self.patch.document;
        let json = &document.json;
        let accessor = |key: &str| Some(json.number(json.member(sampler, key)?)? as usize);
        let input = document.layout(accessor("input")?).ok()?;
        let output = document.layout(accessor("output")?).ok()?;
        let interpolation = json.member(sampler, "interpolation").and_then(|at| json.string(at));
        let is_cubic = interpolation.as_deref() == Some("CUBICSPLINE");
        let rows = input.count * if is_cubic { 3 } else { 1 };
        if known == 0 || output.lanes != 1 || output.count != rows * known {
            return None;
        }
        let weights = output.floats::<1>(document);
        let all = known + self.targets.len();
        let mut bytes = Vec::with_capacity(4 * rows * all);
        for (row, weights) in weights.chunks(known).enumerate() {
            // A cubic key has its in-tangent, its value and its out-tangent.
            let is_value = !is_cubic || row % 3 == 1;
            let added = self.targets.iter();
            let added = added.map(|target| if is_value { target.weight as f32 } else { 0.0 });
            let row = weights.iter().map(|[weight]| *weight).chain(added);
            bytes.extend(row.flat_map(f32::to_le_bytes));
        }
        let view = self.patch.new_view(None, bytes.into_iter(), "")?;
        let accessor = self.patch.push_accessor(format!(
            "{{\"bufferView\":{view},\"componentType\":5126,\"count\":{},\"type\":\"SCALAR\"}}",
            rows * all
        ));
        let mut edits = Edits::default();
        edits.replace(json.span(json.member(sampler, "output")?), accessor.to_string());
        let text = edits.apply(json.text(), json.span(sampler));
        Some(String::from_utf8_lossy(&text).into_owned())
    }
}
