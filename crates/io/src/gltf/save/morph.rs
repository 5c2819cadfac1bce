//! An edit saved as one more morph target: the shape does not change, and each primitive of the edited meshes gets the
//! displacements to the edited shape.
//!
//! Everything with one weight per target gets one more: the mesh's weights and names, the weights of its nodes, and
//! their animations.

use std::collections::{BTreeMap, HashMap};

use crate::gltf::document::Document;
use crate::gltf::document::json::{At, Edits};
use crate::gltf::geometry::Pieces;
use crate::gltf::geometry::primitive::Primitive;
use crate::gltf::save::accessors::{Bounds, number};
use crate::gltf::save::changes::{InstanceChange, Semantic};
use crate::gltf::save::copy_on_write::{self, MeshCopy};
use crate::gltf::save::patch::{Patch, Patched, cannot_hold};
use crate::gltf::save::turned_triangles::Turned;
use crate::quote::quoted;
use crate::save::MorphTarget;
use crate::save::course::Course;
use crate::{Format, SaveError};

/// The document with the changes as a morph target.
pub(crate) fn with_target<'a>(
    document: &'a Document,
    meshes: &[Vec<Primitive>],
    pieces: &Pieces,
    changes: &[InstanceChange],
    target: &MorphTarget<'_>,
    format: Format,
    course: &Course<'_>,
) -> Result<Patched<'a>, SaveError> {
    let (of_plan, course) = course.split(0.3);
    let hashes = copy_on_write::hashes(changes);
    let copies = copy_on_write::plan_meshes(document, meshes, pieces, (changes, &Turned::new()), &hashes, &of_plan)?;
    let nodes = nodes_of_copies(document, &copies);
    let mut maker = TargetMaker {
        patch: Patch::new(document),
        meshes,
        changes,
        target,
        format,
        deltas: BTreeMap::new(),
        zeros: BTreeMap::new(),
        samplers: BTreeMap::new(),
        animated: Animated::of(document),
    };
    for (number, copy) in copies.iter().enumerate() {
        course.reach(number, copies.len())?;
        if copy
            .instances
            .iter()
            .flatten()
            .any(|&instance| !changes[instance].is_empty())
        {
            maker.add_to(&copies, number, &nodes[number])?;
        }
    }
    let samplers = std::mem::take(&mut maker.samplers);
    for (list, texts) in samplers.into_values() {
        maker.patch.edits.append_elements(&document.json, list, &texts);
    }
    maker.patch.clone_meshes(&copies, format)?;
    maker.patch.finished(format)
}

struct TargetMaker<'a, 'b> {
    patch: Patch<'a>,
    meshes: &'b [Vec<Primitive>],
    changes: &'b [InstanceChange],
    target: &'b MorphTarget<'b>,
    format: Format,
    /// The accessor of an instance's displacements, by attribute.
    deltas: BTreeMap<(usize, usize), usize>,
    /// The accessor of this many zeros, by whether they are positions.
    zeros: BTreeMap<(usize, bool), usize>,
    /// The samplers to add to each animation, and their places.
    samplers: BTreeMap<usize, (At, Vec<String>)>,
    animated: Animated,
}

impl TargetMaker<'_, '_> {
    fn refuse(&self, what: String) -> SaveError {
        SaveError::CannotHold {
            what: format!("a morph target beside {what}"),
            format: self.format,
            remedy: "save the edited shape itself".to_owned(),
        }
    }

    /// Adds the target to a mesh or a clone.
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
            let text = self.target_of(primitive, instance)?;
            let edits = self.patch.edits_of_copy(copies, number);
            match json.member(primitive.at, "targets") {
                Some(list) => edits.append_elements(json, list, &[text]),
                None => edits.set_member(json, primitive.at, "targets", &format!("[{text}]")),
            }
        }
        let mesh = document.meshes_at[copy.mesh];
        let weight = self.target.weight;
        let edits = self.patch.edits_of_copy(copies, number);
        append_weight(document, edits, mesh, known, weight, Missing::Write);
        if !append_name(document, edits, mesh, known, self.target.name) {
            self.patch.out.warnings.push(format!(
                "The number of names of mesh {}'s morph targets differs from that of the targets, so '{}' has no name \
                 there.",
                copy.mesh,
                quoted(self.target.name)
            ));
        }
        for &node in nodes {
            let at = document.nodes_at[node];
            append_weight(document, &mut self.patch.edits, at, known, weight, Missing::Leave);
        }
        self.widen_animations(copy.mesh, nodes, known)
    }

    /// A primitive's target as JSON.
    fn target_of(&mut self, primitive: &Primitive, instance: Option<usize>) -> Result<String, SaveError> {
        let document = self.patch.document;
        let mut members = Vec::new();
        for (place, semantic) in Semantic::ALL.into_iter().enumerate() {
            let Some(base) = semantic.accessor(primitive) else {
                continue;
            };
            let layout = document.layout(base).map_err(|what| cannot_hold(what, self.format))?;
            let change = instance.map(|instance| (instance, self.changes[instance].of(semantic)));
            let accessor = match change.filter(|(_, change)| !change.is_empty()) {
                None => self.zeros(layout.count, semantic),
                Some((instance, _)) if self.deltas.contains_key(&(instance, place)) => self.deltas[&(instance, place)],
                Some((instance, change)) => {
                    let rest = layout.floats::<3>(document);
                    let mut way = vec![[0.0_f32; 4]; layout.count];
                    for &(element, new) in change {
                        let (way, rest) = (&mut way[element as usize], rest[element as usize]);
                        (0..3).for_each(|lane| way[lane] = new[lane] - rest[lane]);
                        if !way.iter().all(|number| number.is_finite()) {
                            return Err(SaveError::NotFinite { file_vertex: element });
                        }
                    }
                    let accessor = self.patch.push_ways(&way, semantic, self.format)?;
                    self.deltas.insert((instance, place), accessor);
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

    /// Gives every animation of the weights of `nodes`, which show `mesh` with `known` targets, the new one's weight.
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

    /// A sampler whose output has one more weight in each key; `None` if it does not have `known` of them.
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
        let mut bytes = Vec::with_capacity(4 * rows * (known + 1));
        for (row, weights) in weights.chunks(known).enumerate() {
            // A cubic key has its in-tangent, its value and its out-tangent.
            let is_value = !is_cubic || row % 3 == 1;
            let added = if is_value { self.target.weight as f32 } else { 0.0 };
            let all = weights.iter().map(|[weight]| *weight).chain([added]);
            bytes.extend(all.flat_map(f32::to_le_bytes));
        }
        let view = self.patch.new_view(None, bytes.into_iter(), "")?;
        let accessor = self.patch.push_accessor(format!(
            "{{\"bufferView\":{view},\"componentType\":5126,\"count\":{},\"type\":\"SCALAR\"}}",
            rows * (known + 1)
        ));
        let mut edits = Edits::default();
        edits.replace(json.span(json.member(sampler, "output")?), accessor.to_string());
        let text = edits.apply(json.text(), json.span(sampler));
        Some(String::from_utf8_lossy(&text).into_owned())
    }
}

/// The treatment of a missing list of weights.
#[derive(Clone, Copy, PartialEq)]
enum Missing {
    /// It is written, with zeros for the earlier targets.
    Write,
    /// It is left out: the mesh's own applies.
    Leave,
}

impl Patch<'_> {
    /// Adds an accessor of a target's deltas, and gives its number.
    pub(super) fn push_ways(
        &mut self,
        way: &[[f32; 4]],
        semantic: Semantic,
        format: Format,
    ) -> Result<usize, SaveError> {
        let numbers = way.iter().flat_map(|element| &element[..3]);
        let bytes = numbers.flat_map(|number| number.to_le_bytes());
        let view = self.new_view(None, bytes, ",\"target\":34962");
        let view = view.ok_or_else(|| cannot_hold("a file without a buffer".to_owned(), format))?;
        let mut text = format!(
            "{{\"bufferView\":{view},\"componentType\":5126,\"count\":{},\"type\":\"VEC3\"",
            way.len()
        );
        if semantic == Semantic::Position {
            let bounds = Bounds::of(way);
            for (key, bound) in [("max", bounds.max), ("min", bounds.min)] {
                let numbers: Vec<String> = bound[..3].iter().map(|&bound| number(bound)).collect();
                text += &format!(",\"{key}\":[{}]", numbers.join(","));
            }
        }
        text.push('}');
        Ok(self.push_accessor(text))
    }
}

fn append_weight(document: &Document, edits: &mut Edits, object: At, known: usize, weight: f64, missing: Missing) {
    let json = &document.json;
    let list = json.member(object, "weights");
    let there = list.map_or(0, |list| json.elements(list).count());
    let zeros = std::iter::repeat_n("0".to_owned(), known.saturating_sub(there));
    let added: Vec<String> = zeros.chain([number(weight as f32)]).collect();
    match list {
        Some(list) => edits.append_elements(json, list, &added),
        None if missing == Missing::Write => {
            edits.set_member(json, object, "weights", &format!("[{}]", added.join(",")));
        }
        None => {}
    }
}

/// Adds the target's name to those of the mesh, where exporters keep them; returns whether there was a place for it.
fn append_name(document: &Document, edits: &mut Edits, mesh: At, known: usize, name: &str) -> bool {
    let json = &document.json;
    let quoted = |name: &str| serde_json::Value::from(name).to_string();
    let extras = json.member(mesh, "extras");
    if let Some(list) = extras.and_then(|extras| json.member(extras, "targetNames")) {
        let is_whole = json.elements(list).count() == known;
        if is_whole {
            edits.append_elements(json, list, &[quoted(name)]);
        }
        return is_whole;
    }
    let unnamed = (0..known).map(|target| quoted(&format!("target {target}")));
    let names: Vec<String> = unnamed.chain([quoted(name)]).collect();
    let names = format!("[{}]", names.join(","));
    match extras {
        None => edits.set_member(json, mesh, "extras", &format!("{{\"targetNames\":{names}}}")),
        Some(extras) if json.raw(extras).starts_with(b"{") => edits.set_member(json, extras, "targetNames", &names),
        Some(_) => return false,
    }
    true
}

/// The nodes that show each copy after the edit, ascending.
fn nodes_of_copies(document: &Document, copies: &[MeshCopy]) -> Vec<Vec<usize>> {
    let json = &document.json;
    let mut copy_of: HashMap<usize, usize> = HashMap::new();
    for (number, copy) in copies.iter().enumerate() {
        copy_of.extend(copy.uses.iter().map(|&(node, _)| (node, number)));
    }
    let mut nodes = vec![Vec::new(); copies.len()];
    for (node, &at) in document.nodes_at.iter().enumerate() {
        let mesh = json.member(at, "mesh").and_then(|at| json.number(at));
        // The file's own meshes come first among the copies.
        let shown = copy_of.get(&node).copied().or(mesh.map(|mesh| mesh as usize));
        if let Some(nodes) = shown.and_then(|copy| nodes.get_mut(copy)) {
            nodes.push(node);
        }
    }
    nodes
}

/// The animations of weights, found once for all meshes.
struct Animated {
    /// The samplers of each animation.
    samplers: Vec<Samplers>,
    weights_of_node: HashMap<usize, Vec<Channel>>,
    /// The targets of `KHR_animation_pointer`, and their animations.
    pointers: HashMap<String, usize>,
}

struct Samplers {
    list: Option<At>,
    elements: Vec<At>,
}

/// A channel of an animation, by its number in it, and the place of its sampler's number.
#[derive(Clone, Copy)]
struct Channel {
    animation: usize,
    number: usize,
    sampler: Option<At>,
}

impl Animated {
    fn of(document: &Document) -> Self {
        let json = &document.json;
        let mut out = Self {
            samplers: Vec::new(),
            weights_of_node: HashMap::new(),
            pointers: HashMap::new(),
        };
        let animations = json.member(json.root(), "animations");
        for (animation, at) in animations.into_iter().flat_map(|at| json.elements(at)).enumerate() {
            let list = json.member(at, "samplers");
            out.samplers.push(Samplers {
                list,
                elements: list.into_iter().flat_map(|at| json.elements(at)).collect(),
            });
            let channels = json.member(at, "channels");
            for (number, channel) in channels.into_iter().flat_map(|at| json.elements(at)).enumerate() {
                let pointer = json.path(channel, &["target", "extensions", "KHR_animation_pointer", "pointer"]);
                if let Some(pointer) = pointer.and_then(|at| json.string(at)) {
                    out.pointers.entry(pointer).or_insert(animation);
                }
                let path = json.path(channel, &["target", "path"]).and_then(|at| json.string(at));
                let node = json.path(channel, &["target", "node"]).and_then(|at| json.number(at));
                if let (Some("weights"), Some(node)) = (path.as_deref(), node) {
                    out.weights_of_node.entry(node as usize).or_default().push(Channel {
                        animation,
                        number,
                        sampler: json.member(channel, "sampler"),
                    });
                }
            }
        }
        out
    }
}
