//! The shapes of the drawn vertices during one of the file's animations of morph targets.

use std::ops::Range;

use glam::{DVec3, Vec3};
use pliant_mesh::Cancel;

use crate::gltf::document::Document;
use crate::gltf::document::fault::Fault;
use crate::gltf::document::json::At;
use crate::gltf::geometry::primitive::Primitive;
use crate::gltf::geometry::weights::{Interpolation, WeightTrack};
use crate::gltf::geometry::{Instance, Pieces};

/// The shapes of a file's drawn vertices during an animation of morph targets.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct MorphPlayback {
    name: String,
    others: usize,
    duration: f64,
    /// Ascending.
    key_times: Vec<f64>,
    parts: Vec<Part>,
}

/// The drawn vertices of an instance that the animation moves.
#[derive(Clone, PartialEq, Debug)]
struct Part {
    vertices: Range<usize>,
    /// Each target's weight at rest and the displacements of the vertices at full weight in world space, in the file's own
    /// single precision.
    targets: Vec<(f64, Vec<Vec3>)>,
    track: WeightTrack,
}

impl MorphPlayback {
    /// The animation's name; empty if it has none.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The number of earlier animations of morph targets in the file.
    pub fn others(&self) -> usize {
        self.others
    }

    /// The time of its last key, in seconds.
    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// The times of all its keys, in seconds, ascending.
    pub fn key_times(&self) -> &[f64] {
        &self.key_times
    }

    /// Returns true if each key's shape holds until the next, everywhere.
    pub fn holds(&self) -> bool {
        self.parts.iter().all(|part| part.track.holds())
    }

    /// Adds the displacements since rest at a time in seconds to the positions of the drawn vertices.
    pub fn displace(&self, time: f64, positions: &mut [DVec3]) {
        for part in &self.parts {
            let weights = part.track.at(time);
            for ((rest, ways), weight) in part.targets.iter().zip(weights) {
                let share = weight - rest;
                if share != 0.0 {
                    let positions = positions[part.vertices.clone()].iter_mut();
                    positions
                        .zip(ways)
                        .for_each(|(position, way)| *position += way.as_dvec3() * share);
                }
            }
        }
    }
}

/// The last animation that moves morph targets which are drawn, because an edit adds its own at the end; `None` if there
/// is none.
///
/// # Errors
/// A target or a list of weights that can't be read, or that is too large.
pub(crate) fn playback(
    document: &Document,
    meshes: &[Vec<Primitive>],
    pieces: &Pieces,
    cancel: &Cancel,
) -> Result<Option<MorphPlayback>, Fault> {
    let json = &document.json;
    let animations = json.member(json.root(), "animations");
    let mut last: Option<MorphPlayback> = None;
    for at in animations.into_iter().flat_map(|at| json.elements(at)) {
        let tracks = tracks(document, at)?;
        let mut budget = document.drawing_budget();
        let mut parts = Vec::new();
        for instance in &pieces.instances {
            cancel.check()?;
            let Some((_, track)) = tracks.iter().find(|(node, _)| *node == instance.node) else {
                continue;
            };
            let primitive = &meshes[instance.mesh][instance.primitive];
            if !primitive.targets.is_empty() {
                parts.push(part(document, (instance, primitive), track, &mut budget)?);
            }
        }
        if !parts.is_empty() {
            last = Some(MorphPlayback {
                name: document.name(at),
                others: last.map_or(0, |last| last.others + 1),
                key_times: key_times(&tracks),
                duration: tracks.iter().map(|(_, track)| track.end()).fold(0.0, f64::max),
                parts,
            });
        }
    }
    Ok(last)
}

fn key_times(tracks: &[(usize, WeightTrack)]) -> Vec<f64> {
    let mut times: Vec<f64> = tracks
        .iter()
        .flat_map(|(_, track)| track.times().iter().copied())
        .collect();
    times.sort_by(f64::total_cmp);
    times.dedup();
    times
}

fn part(
    document: &Document,
    (instance, primitive): (&Instance, &Primitive),
    track: &WeightTrack,
    budget: &mut usize,
) -> Result<Part, Fault> {
    let vertices = instance.vertices.start as usize..instance.vertices.end as usize;
    let bytes = primitive.targets.len().checked_mul(vertices.len() * size_of::<Vec3>());
    let left = bytes.and_then(|bytes| budget.checked_sub(bytes));
    *budget = left.ok_or_else(|| Fault::TooLarge("its morph targets, each seen through a node,".to_owned()))?;
    let target = |number: usize| -> Result<(f64, Vec<Vec3>), Fault> {
        let rest = instance.weights.iter().find(|(own, _)| *own == number);
        let rest = rest.map_or(0.0, |(_, weight)| *weight);
        let Some(accessor) = primitive.targets[number].position else {
            return Ok((rest, Vec::new()));
        };
        let layout = document.layout(accessor)?;
        if layout.count != vertices.len() || layout.lanes != 3 {
            let reason = format!("accessor {accessor}, a morph target, is not of its base's size");
            return Err(Fault::Malformed(reason));
        }
        let ways = layout.floats::<3>(document).into_iter().enumerate();
        let world = |(element, way)| {
            let way = Vec3::from_array(way).as_dvec3();
            instance.pose.at(element).transform_vector3(way).as_vec3()
        };
        Ok((rest, ways.map(world).collect()))
    };
    let targets: Result<Vec<_>, Fault> = (0..primitive.targets.len()).map(target).collect();
    Ok(Part {
        targets: targets?,
        track: track.clone(),
        vertices,
    })
}

/// The weights of nodes in an animation.
fn tracks(document: &Document, animation: At) -> Result<Vec<(usize, WeightTrack)>, Fault> {
    let json = &document.json;
    let list = |key: &str| {
        let list = json.member(animation, key);
        list.into_iter().flat_map(|at| json.elements(at)).collect::<Vec<At>>()
    };
    let samplers = list("samplers");
    let mut tracks = Vec::new();
    for channel in list("channels") {
        let text = |keys: &[&str]| json.path(channel, keys).and_then(|at| json.string(at));
        let node = json.path(channel, &["target", "node"]).and_then(|at| json.number(at));
        let (Some("weights"), Some(node)) = (text(&["target", "path"]).as_deref(), node) else {
            continue;
        };
        let what = || format!("an animation of node {node}");
        let sampler = document.index(channel, "sampler", samplers.len(), what)?;
        let sampler = samplers[sampler.ok_or_else(|| format!("{} has no sampler", what()))?];
        let numbers = |key: &str| -> Result<Vec<f64>, Fault> {
            let accessor = document.index(sampler, key, document.accessors.len(), what)?;
            let accessor = accessor.ok_or_else(|| format!("{} has no {key}", what()))?;
            let layout = document.layout(accessor)?;
            let floats = layout.floats::<1>(document).into_iter();
            Ok(floats.map(|[number]| f64::from(number)).collect())
        };
        let interpolation = json.member(sampler, "interpolation").and_then(|at| json.string(at));
        let interpolation = Interpolation::of(interpolation.as_deref());
        let track = WeightTrack::new(numbers("input")?, numbers("output")?, interpolation);
        let track = track.ok_or_else(|| format!("{} has times or weights that do not fit together", what()))?;
        tracks.push((node as usize, track));
    }
    Ok(tracks)
}
