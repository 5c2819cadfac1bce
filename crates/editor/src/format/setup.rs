//! An edit resolved on a model: the role and the stiffness of every surface vertex, and the motion of each handle.

use std::collections::BTreeSet;
use std::sync::Arc;

use glam::{DAffine3, DVec3};
use pliant_deform::{Attachment, CONTINUITY_RANGE, Constraints, Examples, Loose, Method, Problem, Role, Warning};
use pliant_mesh::{Model, Surface, SurfaceVertex};

use super::attachment::on_model;
use super::edit_error::EditError;
use super::edit_file::EditFile;
use super::handle_entry::HandleEntry;
use super::matched_by_place::MatchedByPlace;
use super::pivoted::with_pivot;
use super::pose::Limbs;
use super::selector::Selector;
use crate::HandleTransform;
use crate::bending::{Kept, Targets};
use crate::document::{Document, HandleCurve, HandleId, HandleLine, attachment_part};
use crate::lines::Lines;
use crate::region::Region;
use crate::warning::{shortened, worded};

/// The input of [`pliant_deform::Problem`] from an edit, and the handles' transforms.
#[derive(Clone, PartialEq, Debug)]
pub struct Setup {
    /// The role of each surface vertex.
    pub roles: Vec<Role>,
    /// The handles; [`Role::Handle`] is the index.
    pub handles: Vec<HandleSetup>,
    /// The lines that handles follow.
    pub lines: Lines,
    /// The shown share of the lines' way.
    pub line_share: f64,
    /// The stiffness of each surface vertex, 1 by default.
    pub stiffness: Vec<f64>,
    /// Each handle's weight, if it is soft.
    pub soft: Vec<Option<f64>>,
    /// The continuity of each surface vertex; empty for the highest everywhere.
    pub continuity: Vec<f64>,
    /// The behaviour of components that nothing holds.
    pub loose: Loose,
    /// The behaviour of single components instead of that.
    pub loose_parts: Vec<(u32, Loose)>,
    /// The connected parts that are turned inside out in the saved file, by their numbers.
    pub inside_out: BTreeSet<u32>,
    /// The method and its options.
    pub method: Method,
    /// The attachments that were brought, by declared name.
    pub attachments: Vec<(&'static str, Attachment)>,
    /// The rest shape of bending, if it differs from the file's.
    pub rest: Option<Rest>,
    /// The kept visible shape, if it differs from the solution for the handles' transforms.
    pub kept: Option<Kept>,
    /// How much of the edit was found by place, if it was made on another mesh.
    pub matched: Option<MatchedByPlace>,
}

/// A rest shape.
#[derive(Clone, Debug)]
pub struct Rest {
    /// Its displacements from the file's shape, one per surface vertex.
    pub displacements: Arc<Vec<DVec3>>,
    /// The surface in it.
    pub surface: Arc<Surface>,
}

impl PartialEq for Rest {
    fn eq(&self, other: &Self) -> bool {
        self.displacements == other.displacements
    }
}

/// A handle on a model.
#[derive(Clone, PartialEq, Debug)]
pub struct HandleSetup {
    /// Its name, for a person.
    pub name: String,
    /// Its target.
    pub transform: HandleTransform,
    /// The pivot of its transform, or else the mean of its rest positions.
    pub pivot: DVec3,
    /// The direction along which it is free, in world space.
    pub free_along: Option<DVec3>,
    /// The line that it follows; a curve with `snap` is where it was found.
    pub line: Option<HandleLine>,
}

impl Setup {
    /// The number of solved vertices.
    pub fn free_count(&self) -> usize {
        self.roles.iter().filter(|&&role| role == Role::Free).count()
    }

    /// The problem on `model`, on which it was resolved. The command line and the window both bind this.
    pub fn problem<'a>(&'a self, model: &'a Model) -> Problem<'a> {
        Problem {
            surface: self.rest.as_ref().map_or(&model.surface, |rest| &rest.surface),
            topology: &model.topology,
            roles: &self.roles,
            handle_count: self.handles.len(),
            stiffness: &self.stiffness,
            constraints: Constraints {
                soft: &self.soft,
                continuity: &self.continuity,
                parts: &self.loose_parts,
                sections: self.lines.sections(),
            },
            loose: self.loose,
            method: &self.method,
            attachments: &self.attachments,
            revision: 0,
        }
    }

    /// The setup of a document, with the regions that follow from it.
    /// `of_file` is the surface in the file.
    pub(crate) fn of_document(document: &Document, region: &Region, of_file: &Surface) -> Self {
        let handles = || region.handles.iter().filter_map(|&id| document.handle(id));
        let stiffness = document.stiffness();
        let rest = region.rest_surface.as_ref().map(|surface| Rest {
            displacements: Arc::clone(&document.rest),
            surface: Arc::clone(surface),
        });
        let lines = handles().map(|handle| handle.line.as_ref());
        let surface = rest.as_ref().map_or(of_file, |rest| &rest.surface);
        Self {
            lines: Lines::of(lines, &region.roles, surface),
            line_share: document.strength(),
            roles: region.roles.to_vec(),
            handles: handles()
                .map(|handle| HandleSetup {
                    name: handle.name.clone(),
                    transform: with_pivot(handle),
                    pivot: handle.pivot,
                    free_along: document.freedom(handle.id),
                    line: handle.line.clone(),
                })
                .collect(),
            stiffness: stiffness.map_or_else(|| vec![1.0; region.roles.len()], <[f64]>::to_vec),
            soft: handles().map(|handle| handle.soft).collect(),
            continuity: document.joints().unwrap_or_default(),
            loose: document.loose,
            loose_parts: document
                .loose_parts
                .iter()
                .map(|(part, loose)| (*part, *loose))
                .collect(),
            inside_out: (*document.inside_out).clone(),
            method: document.method.clone(),
            attachments: document
                .attachments
                .iter()
                .map(|(name, attachment)| (*name, attachment.clone()))
                .collect(),
            kept: document
                .to_go_on_from()
                .and_then(|kept| Kept::of(&kept, region.handles.iter().copied())),
            rest,
            matched: None,
        }
    }

    /// The sentences of a binding's warnings, with the handles' names, after the one about the edit's places.
    pub fn worded(&self, warnings: &[Warning]) -> Vec<String> {
        let name = |number: usize| self.handles.get(number).map(|handle| &*handle.name);
        let sentence = |warning: &Warning| worded(warning, warning.handle().and_then(name));
        let matched = self.matched.iter().map(MatchedByPlace::sentence);
        matched.chain(warnings.iter().map(sentence)).collect()
    }

    /// The examples of the method, if some were brought.
    pub fn examples(&self) -> Option<&Examples> {
        match self.attachment()? {
            Attachment::Shapes(examples) => Some(examples),
            _ => None,
        }
    }

    /// The brought attachments of the method.
    fn attachment(&self) -> Option<&Attachment> {
        let declared = self.method.declaration();
        let mut own = self.attachments.iter();
        let (_, attachment) = own.find(|(name, _)| declared.attachment(name).is_some())?;
        Some(attachment)
    }

    /// The targets at the share `t` of the motion, 0 at rest and 1 at the end: the handles' maps, the method's control
    /// points, and the weights of those examples that bend the surface, times `t`.
    pub fn targets_at(&self, t: f64) -> Targets {
        let part = |attachment| attachment_part(&self.method, attachment, t);
        let targets = Targets::new(self.targets(t), self.attachment().map(part).as_ref());
        targets
            .along(&self.lines, self.line_share * t)
            .free_along(self.free_along())
    }

    /// The free direction of each handle that has one.
    pub fn free_along(&self) -> Vec<Option<DVec3>> {
        self.handles.iter().map(|handle| handle.free_along).collect()
    }

    /// The targets with these maps of the handles, weights of the examples, if there are others, and curves by the
    /// handles' numbers; `share` is that of the lines, the control points and the weights that is made.
    pub(crate) fn targets_with(
        &self,
        handles: Vec<DAffine3>,
        weights: Option<Vec<Option<f64>>>,
        curves: &[(usize, HandleCurve)],
        share: f64,
    ) -> Targets {
        let mut attachment = self.attachment().cloned();
        let mut part = share;
        if let (Some(weights), Some(Attachment::Shapes(examples))) = (weights, &mut attachment) {
            examples.weights = weights;
            // The edit's own weights are that share already.
            part *= self.line_share;
        }
        let attachment = attachment.map(|own| attachment_part(&self.method, &own, part));
        let targets = Targets::new(handles, attachment.as_ref());
        let of_handle = |handle: usize| curves.iter().find(|(own, _)| *own == handle).map(|(_, curve)| curve);
        let lines = match curves.is_empty() {
            true => self.lines.clone(),
            false => self.lines.moved(of_handle),
        };
        targets.along(&lines, self.line_share * share)
    }

    /// The handles' maps at the share `t` of the motion, 0 at rest and 1 at their targets.
    pub fn targets(&self, t: f64) -> Vec<DAffine3> {
        self.handles
            .iter()
            .map(|handle| handle.transform.at(t, handle.pivot))
            .collect()
    }
}

impl EditFile {
    /// Resolves the edit on a model.
    ///
    /// Vertices outside `region` and those in `fixed` are fixed, and a handle has priority over both.
    ///
    /// # Errors
    /// A vertex or component that the model does not have, a handle that selects nothing, a vertex in two handles, a
    /// stiffness field of a wrong length; on another mesh than its own those of [`EditFile::placed`].
    pub fn resolve(&self, model: &Model) -> Result<Setup, EditError> {
        if self.handles.len() > usize::from(u16::MAX) {
            return Err(EditError::TooManyHandles(self.handles.len()));
        }
        if let Some(placed) = self.placed(model)? {
            return Ok(Setup {
                matched: Some(placed.matched),
                ..placed.edit.resolve(model)?
            });
        }
        let poses = self.handles.iter().enumerate();
        let limbs = Limbs::of(
            poses.filter_map(|(index, entry)| Some((index, entry.pose.as_ref()?))),
            model,
        )?;
        let mut members = Vec::with_capacity(self.handles.len());
        let mut lines = Vec::with_capacity(self.handles.len());
        for (index, entry) in self.handles.iter().enumerate() {
            let line = entry.line_on(index, model)?;
            members.push(match limbs.at(index) {
                Some(limb) => limb.own.clone(),
                None => entry.members(index, line.as_ref(), model)?,
            });
            lines.push(line);
        }
        let mut roles = vec![Role::Fixed; model.surface.positions.len()];
        if limbs.is_empty() || self.region != Selector::All {
            for vertex in self.region.evaluate_at(model, "region")?.iter() {
                roles[vertex.index()] = Role::Free;
            }
        } else {
            limbs.free(&members, model, &mut roles);
        }
        for vertex in self.fixed.evaluate_at(model, "fixed")?.iter() {
            roles[vertex.index()] = Role::Fixed;
        }
        let mut handles = Vec::with_capacity(self.handles.len());
        for (index, entry) in self.handles.iter().enumerate() {
            let (mut sum, mut count) = (DVec3::ZERO, 0.0);
            let mut shared: Vec<(SurfaceVertex, u16)> = Vec::new();
            for &vertex in &members[index] {
                if let Role::Handle(other) = roles[vertex.index()] {
                    shared.push((vertex, other));
                }
                roles[vertex.index()] = Role::Handle(index as u16);
                sum += model.surface.positions[vertex.index()];
                count += 1.0;
            }
            if let Some(&(vertex, other)) = shared.first() {
                return Err(EditError::SharedVertex {
                    first: shortened(&self.handles[usize::from(other)].name),
                    second: shortened(&entry.name),
                    shared: shared.iter().filter(|&&(_, o)| o == other).count(),
                    file_vertex: model.first_file_vertex(vertex).0,
                });
            }
            if count == 0.0 {
                return Err(EditError::EmptyHandle {
                    handle: shortened(&entry.name),
                    index,
                });
            }
            let middle = limbs.at(index).map_or(sum / count, |limb| limb.joint.centre);
            let pivot = entry.transform.pivot_or(middle);
            handles.push(HandleSetup {
                name: entry.name.clone(),
                transform: entry.transform.part(self.part_before_keys(), pivot),
                pivot,
                free_along: entry.free_along,
                line: lines[index].take(),
            });
        }
        let lines = handles.iter().map(|handle| handle.line.as_ref());
        let lines = Lines::of(lines, &roles, &model.surface);
        if let Some((index, why)) = lines.refused() {
            return Err(EditError::Other {
                place: format!("handles[{index}].curve.crease"),
                sentence: why.clone(),
            });
        }
        let stiffness = self.stiffness_on(model)?;
        let continuity = self.continuity_on(model, &roles)?;
        Ok(Setup {
            roles,
            handles,
            lines,
            line_share: self.part_before_keys(),
            stiffness,
            soft: self.handles.iter().map(HandleEntry::softness).collect(),
            continuity,
            loose: self.loose,
            loose_parts: self.loose_parts_on(model)?,
            inside_out: self.inside_out_on(model)?,
            method: self.method.clone(),
            attachments: self.attachments_on(model)?,
            kept: self.kept_on(model)?,
            rest: None,
            matched: None,
        })
    }

    fn attachments_on(&self, model: &Model) -> Result<Vec<(&'static str, Attachment)>, EditError> {
        let entries = self.attachments.iter();
        let declared = self.method.declaration();
        let attachments = entries.map(|(name, entry)| {
            let attachment = on_model(name, entry, model)?;
            let attachment = match declared.attachment(name) {
                Some(_) => attachment_part(&self.method, &attachment, self.part_before_keys()),
                None => attachment,
            };
            Ok((*name, attachment))
        });
        let attachments: Result<_, EditError> = attachments.collect();
        attachments.map_err(|error| error.under("method"))
    }

    fn stiffness_on(&self, model: &Model) -> Result<Vec<f64>, EditError> {
        let mut stiffness = vec![1.0; model.surface.positions.len()];
        for (index, entry) in self.stiffness.iter().enumerate() {
            entry.paint(&mut stiffness, model, "stiffness", index)?;
        }
        Ok(stiffness)
    }

    /// The continuity of each surface vertex without the handles' own; empty if none is given.
    pub(crate) fn painted_continuity(&self, model: &Model) -> Result<Vec<f64>, EditError> {
        if self.continuity.is_empty() {
            return Ok(Vec::new());
        }
        let mut continuity = vec![*CONTINUITY_RANGE.end(); model.surface.positions.len()];
        for (index, entry) in self.continuity.iter().enumerate() {
            entry.paint(&mut continuity, model, "continuity", index)?;
        }
        Ok(continuity)
    }

    fn kept_on(&self, model: &Model) -> Result<Option<Kept>, EditError> {
        let Some(kept) = self.kept.as_ref().and_then(|kept| kept.taken_by(&self.method)) else {
            return Ok(None);
        };
        let kept = Arc::new(kept.on(model, "kept")?);
        Ok(Kept::of(
            &kept,
            (0..self.handles.len()).map(|place| HandleId(place as u16)),
        ))
    }

    /// The components with a vertex selected as inside out.
    fn inside_out_on(&self, model: &Model) -> Result<BTreeSet<u32>, EditError> {
        let selected = self.inside_out.evaluate_at(model, "inside_out")?;
        Ok(selected.iter().map(|vertex| model.topology.component(vertex)).collect())
    }

    /// The behaviour of single components, the later entry having priority.
    pub(crate) fn loose_parts_on(&self, model: &Model) -> Result<Vec<(u32, Loose)>, EditError> {
        let mut does = std::collections::BTreeMap::new();
        for (index, (select, loose)) in self.loose_parts.iter().enumerate() {
            // The first entry applies to all and is kept apart.
            for vertex in select
                .evaluate_at(model, &format!("loose[{}].select", index + 1))?
                .iter()
            {
                does.insert(model.topology.component(vertex), *loose);
            }
        }
        Ok(does.into_iter().collect())
    }

    /// The continuity of each surface vertex; empty if everything joins as smoothly as the method allows.
    fn continuity_on(&self, model: &Model, roles: &[Role]) -> Result<Vec<f64>, EditError> {
        let mut continuity = self.painted_continuity(model)?;
        if self.handles.iter().all(|handle| handle.continuity.is_none()) {
            return Ok(continuity);
        }
        continuity.resize(roles.len(), *CONTINUITY_RANGE.end());
        for (own, role) in continuity.iter_mut().zip(roles) {
            if let Role::Handle(handle) = *role
                && let Some(value) = self.handles[usize::from(handle)].continuity
            {
                *own = value;
            }
        }
        Ok(continuity)
    }
}
