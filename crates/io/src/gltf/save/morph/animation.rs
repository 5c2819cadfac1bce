//! The animation that goes through the targets: a channel of weights for each node that shows one of their meshes.

use std::collections::BTreeMap;

use crate::gltf::document::Document;
use crate::gltf::document::json::At;
use crate::gltf::save::accessors::number;
use crate::gltf::save::patch::{Patch, cannot_hold};
use crate::{Format, SaveError};

/// An animation of the new targets' weights.
#[derive(Clone, Copy)]
pub(super) struct WeightCourse<'a> {
    pub name: &'a str,
    /// In seconds.
    pub times: &'a [f64],
    /// For each time the weight of each new target.
    pub weights: &'a [Vec<f32>],
    /// True if each time's weights hold until the next.
    pub holds: bool,
}

/// A node whose weights the animation changes.
pub(super) struct Animate {
    pub node: usize,
    /// The weights of its mesh's earlier targets, which stay.
    pub kept: Vec<f32>,
}

/// The weights of a node's `known` targets that are applied by default: its own, or else the mesh's.
pub(super) fn default_weights(document: &Document, node: At, mesh: At, known: usize) -> Vec<f32> {
    let json = &document.json;
    let list = json.member(node, "weights").or_else(|| json.member(mesh, "weights"));
    let weights = list.into_iter().flat_map(|list| json.elements(list));
    // f32 is the format's precision.
    let mut weights: Vec<f32> = weights.map(|at| json.number(at).unwrap_or(0.0) as f32).collect();
    weights.resize(known, 0.0);
    weights
}

impl Patch<'_> {
    /// Adds the animation.
    pub(super) fn push_animation(
        &mut self,
        animation: WeightCourse<'_>,
        nodes: &[Animate],
        format: Format,
    ) -> Result<(), SaveError> {
        let times: Vec<f32> = animation.times.iter().map(|time| *time as f32).collect();
        let bounds = [times.first(), times.last()].map(|time| number(time.copied().unwrap_or(0.0)));
        let bounds = format!(",\"min\":[{}],\"max\":[{}]", bounds[0], bounds[1]);
        let input = self.push_numbers(&times, &bounds, format)?;
        let mut sampler_of: BTreeMap<Vec<u32>, usize> = BTreeMap::new();
        let (mut samplers, mut channels) = (Vec::new(), Vec::new());
        for Animate { node, kept } in nodes {
            let bits = kept.iter().map(|weight| weight.to_bits()).collect();
            let sampler = match sampler_of.get(&bits) {
                Some(&sampler) => sampler,
                None => {
                    let own = animation.weights.iter();
                    let rows = own.flat_map(|row| kept.iter().chain(row).copied());
                    let output = self.push_numbers(&rows.collect::<Vec<f32>>(), "", format)?;
                    let way = if animation.holds { "STEP" } else { "LINEAR" };
                    samplers.push(format!(
                        "{{\"input\":{input},\"interpolation\":\"{way}\",\"output\":{output}}}"
                    ));
                    sampler_of.insert(bits, samplers.len() - 1);
                    samplers.len() - 1
                }
            };
            channels.push(format!(
                "{{\"sampler\":{sampler},\"target\":{{\"node\":{node},\"path\":\"weights\"}}}}"
            ));
        }
        let name = serde_json::Value::from(animation.name);
        let text = format!(
            "{{\"name\":{name},\"samplers\":[{}],\"channels\":[{}]}}",
            samplers.join(","),
            channels.join(",")
        );
        self.append("animations", &[text]);
        Ok(())
    }

    /// Adds an accessor of single numbers, and gives its number.
    fn push_numbers(&mut self, numbers: &[f32], members: &str, format: Format) -> Result<usize, SaveError> {
        let view = self.new_view(None, numbers.iter().flat_map(|number| number.to_le_bytes()), "");
        let view = view.ok_or_else(|| cannot_hold("a file without a buffer".to_owned(), format))?;
        let count = numbers.len();
        Ok(self.push_accessor(format!(
            "{{\"bufferView\":{view},\"componentType\":5126,\"count\":{count},\"type\":\"SCALAR\"{members}}}"
        )))
    }
}
