//! A handle's entry on a model: the line that it follows, and its vertices.

use std::collections::BTreeSet;

use pliant_mesh::{Bvh, Model, SurfaceVertex, triangles_under};

use super::edit_error::EditError;
use super::handle_entry::HandleEntry;
use crate::document::HandleLine;
use crate::snapped::snapped;
use crate::{crease, outline};

impl HandleEntry {
    /// The line that it follows on a model: a curve with `snap` is found first.
    pub(super) fn line_on(&self, index: usize, model: &Model) -> Result<Option<HandleLine>, EditError> {
        let snap = self.curve.as_ref().and_then(|rough| Some((rough, rough.snap()?)));
        let Some((rough, distance)) = snap else {
            return Ok(self.line());
        };
        let found = snapped(rough, model, distance).ok_or_else(|| EditError::Other {
            place: format!("handles[{index}].curve.snap"),
            sentence: format!(
                "finds no crease and no border within {distance} of the points along the surface: move them nearer to one, \
                 or give a larger distance"
            ),
        })?;
        Ok(Some(HandleLine::Curve(found)))
    }

    /// Its vertices, each once; it follows `line`.
    pub(super) fn members(
        &self,
        index: usize,
        line: Option<&HandleLine>,
        model: &Model,
    ) -> Result<Vec<SurfaceVertex>, EditError> {
        let select = self.select.as_ref();
        let selected = select.map(|select| select.evaluate_at(model, &format!("handles[{index}].select")));
        let selected = selected.transpose()?;
        let surface = &model.surface;
        match (line, selected) {
            (Some(HandleLine::Sketch(sketch)), selected) => {
                let is_selected = |vertex| selected.as_ref().is_none_or(|own| own.contains(vertex));
                let matched = outline::matched(sketch, surface, is_selected).ok_or_else(|| EditError::Other {
                    place: format!("handles[{index}].sketch"),
                    sentence:
                        "is beside no outline: draw it along one that is seen from there, or select more vertices"
                            .to_owned(),
                })?;
                Ok(matched.into_iter().map(|(vertex, _)| vertex).collect())
            }
            (_, Some(selected)) => Ok(selected.iter().collect()),
            (Some(HandleLine::Curve(curve)), None) => {
                let bvh = Bvh::build(&surface.positions, &surface.triangles);
                let under = triangles_under(curve.rest(), &bvh, &surface.triangles).into_iter();
                let corners = under.flat_map(|triangle| surface.triangles[triangle as usize]);
                let members: BTreeSet<SurfaceVertex> = corners.collect();
                Ok(match curve.crease() {
                    Some(crease) => {
                        let position = |v: SurfaceVertex| surface.positions[v.index()];
                        let under = members.into_iter();
                        crease::beside(surface, &model.topology, position, under, crease.width())
                    }
                    None => members.into_iter().collect(),
                })
            }
            (None, None) => Ok(Vec::new()),
        }
    }
}
