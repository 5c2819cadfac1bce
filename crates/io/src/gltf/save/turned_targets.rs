//! Accessors of morph targets whose deltas turned.

use std::collections::BTreeMap;

use glam::{DMat3, Vec3};

use crate::gltf::geometry::primitive::Primitive;
use crate::gltf::save::changes::{InstanceChange, Semantic};
use crate::gltf::save::copy_on_write::MeshCopy;
use crate::gltf::save::patch::Patch;
use crate::{Format, SaveError};

impl Patch<'_> {
    /// Gives the targets of meshes that turn far accessors of turned deltas.
    pub(crate) fn turn_targets(
        &mut self,
        meshes: &[Vec<Primitive>],
        copies: &[MeshCopy],
        changes: &[InstanceChange],
        format: Format,
    ) -> Result<(), SaveError> {
        let document = self.document;
        let json = &document.json;
        // For each instance and accessor, the turned one, or `None` if it stays.
        let mut turned: BTreeMap<(usize, usize), Option<usize>> = BTreeMap::new();
        for (number, copy) in copies.iter().enumerate() {
            let primitives = &meshes[copy.mesh];
            for (primitive, instance) in primitives.iter().zip(copy.followed_instances(primitives)) {
                let turns = instance.and_then(|instance| Some((instance, changes[instance].target_turns.as_ref()?)));
                let Some((instance, turns)) = turns else { continue };
                let targets = json.member(primitive.at, "targets");
                let targets = targets.into_iter().flat_map(|targets| json.elements(targets));
                for (key, at) in targets.flat_map(|target| json.members(target)) {
                    let semantic = Semantic::ALL
                        .into_iter()
                        .find(|own| json.string(key).as_deref() == Some(own.key()));
                    let accessor = json.number(at).map(|accessor| accessor as usize);
                    let (Some(semantic), Some(accessor)) = (semantic, accessor) else {
                        continue;
                    };
                    let known = turned.get(&(instance, accessor)).copied();
                    let new = match known {
                        Some(known) => known,
                        None => self.turned_ways(accessor, turns, semantic, format)?,
                    };
                    turned.insert((instance, accessor), new);
                    if let Some(new) = new {
                        self.edits_of_copy(copies, number)
                            .replace(json.span(at), new.to_string());
                    }
                }
            }
        }
        Ok(())
    }

    /// An accessor of an accessor's deltas, turned; `None` if none changes.
    fn turned_ways(
        &mut self,
        accessor: usize,
        turns: &[DMat3],
        semantic: Semantic,
        format: Format,
    ) -> Result<Option<usize>, SaveError> {
        let Ok(layout) = self.document.layout(accessor) else {
            return Ok(None);
        };
        let ways = layout.floats::<3>(self.document);
        let new: Vec<[f32; 4]> = (ways.iter().zip(turns))
            .map(|(way, turn)| {
                let turned = *turn * Vec3::from_array(*way).as_dvec3();
                turned.as_vec3().extend(0.0).to_array()
            })
            .collect();
        let is_same = ways.iter().zip(&new).all(|(way, new)| way[..] == new[..3]);
        if is_same || new.len() != layout.count || layout.lanes != 3 {
            return Ok(None);
        }
        self.push_ways(&new, semantic, format).map(Some)
    }
}
