//! The file's own animations of weights.

use std::collections::HashMap;

use crate::gltf::document::Document;
use crate::gltf::document::json::At;

/// The animations of weights, found once for all meshes.
pub(super) struct Animated {
    /// The samplers of each animation.
    pub samplers: Vec<Samplers>,
    pub weights_of_node: HashMap<usize, Vec<Channel>>,
    /// The targets of `KHR_animation_pointer`, and their animations.
    pub pointers: HashMap<String, usize>,
}

pub(super) struct Samplers {
    pub list: Option<At>,
    pub elements: Vec<At>,
}

/// A channel of an animation, by its number in it, and the place of its sampler's number.
#[derive(Clone, Copy)]
pub(super) struct Channel {
    pub animation: usize,
    pub number: usize,
    pub sampler: Option<At>,
}

impl Animated {
    pub fn of(document: &Document) -> Self {
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
