//! Changes of the mesh as steps of the history.

use std::collections::BTreeSet;
use std::sync::Arc;

use glam::DVec3;
use pliant_mesh::SurfaceVertex;

use super::control_selection::ControlSelection;
use super::handles::put_handle;
use super::state::Workspace;
use super::stitching_request::Stitching;
use crate::document::{Content, HandleTransform, Paint, Versions};
use crate::jobs::Symmetry;
use crate::stitching::{MergeChange, MergeSettings, MeshChange, NewMesh};

/// Asks for a change of the mesh.
pub(crate) fn stitch(workspace: &mut Workspace, change: MeshChange) {
    workspace.stitching = Some(Stitching { change, taken_at: None });
}

/// The change that was asked for, once.
pub(crate) fn take_stitching(workspace: &mut Workspace) -> Option<MeshChange> {
    let now = present(workspace);
    let stitching = workspace.stitching.as_mut()?;
    if stitching.taken_at.replace(now).is_some() {
        return None;
    }
    Some(stitching.change.clone())
}

/// Differs for every other state of the document.
fn present(workspace: &Workspace) -> (u64, Versions) {
    (workspace.history.revision(), *workspace.document.versions())
}

/// Takes the end of a change of the mesh: the new mesh, or the reason why there is none.
pub(crate) fn take_stitched(workspace: &mut Workspace, result: Result<NewMesh, String>) {
    let Some(stitching) = workspace.stitching.take() else {
        return;
    };
    match result {
        Ok(_) if stitching.taken_at != Some(present(workspace)) => {
            let name = stitching.change.name();
            workspace.refuse(format!(
                "The document was changed in the meantime, so the new mesh was dropped: choose {name} again."
            ));
        }
        Ok(new) => workspace.replace_mesh(stitching.change.name(), new),
        Err(sentence) => workspace.refuse(sentence),
    }
}

impl Workspace {
    /// Replaces the mesh and the document on it, as one step of the history.
    fn replace_mesh(&mut self, name: &str, new: NewMesh) {
        self.pause_keys();
        self.jobs.drop_solves();
        // Steps that are open belong to the former mesh.
        self.pause_keys();
        self.commit_adjusting();
        self.history.sync(&self.document);
        let before = Content::clone(&self.document);
        self.document.replace(new.document);
        self.history
            .push_mesh(name.to_owned(), new.model, before, &self.document);
        self.follow_mesh();
        if new.selected.is_some() {
            self.selection.put(new.selected);
        }
    }

    /// Follows the history to its present mesh. Results for another mesh are dropped.
    pub(super) fn follow_mesh(&mut self) {
        let Some(mesh) = self.history.mesh() else { return };
        if self.model().is_some_and(|model| Arc::ptr_eq(model, mesh)) {
            return;
        }
        self.jobs.open(Arc::clone(mesh));
        self.begin_mesh();
    }

    /// Forgets everything that belongs to another mesh.
    pub(super) fn begin_mesh(&mut self) {
        self.original = Arc::new(vec![DVec3::ZERO; self.document.paint.len()]);
        self.controls = ControlSelection::default();
        self.descent = None;
        self.mirroring = None;
        self.symmetry = Symmetry::None;
        self.both_sides = None;
        self.stitching = None;
        self.flow.reset();
        self.seen = *self.document.versions();
        self.shape_revision += 1;
        self.colours.change_all();
    }
}

/// The connected parts that the selected handle holds whole, by their components' numbers.
pub(crate) fn held_parts(workspace: &Workspace) -> BTreeSet<u32> {
    let (Some(id), Some(model)) = (workspace.selection.selected(), workspace.model()) else {
        return BTreeSet::new();
    };
    let (mut held, mut others) = (BTreeSet::new(), BTreeSet::new());
    for (vertex, paint) in (0..).zip(workspace.document.paint()) {
        let part = model.topology.component(SurfaceVertex(vertex));
        let own = if *paint == Paint::Handle(id) {
            &mut held
        } else {
            &mut others
        };
        own.insert(part);
    }
    held.difference(&others).copied().collect()
}

/// The vertices that a cut along a plane spares: those of parts that are hidden or locked as a whole, and all others
/// than the parts that the selected handle holds, if it holds any.
pub(crate) fn spared_by_cuts(workspace: &Workspace) -> Vec<SurfaceVertex> {
    let Some(model) = workspace.model() else {
        return Vec::new();
    };
    let (held, access) = (held_parts(workspace), &workspace.vertex_access);
    let parts = 0..model.topology.components().len() as u32;
    let is_spared = |part: &u32| {
        let is_another = !held.is_empty() && !held.contains(part);
        let mut vertices = model.topology.vertices_of(*part);
        is_another || !vertices.any(|vertex| access.may_be_painted(vertex.index()))
    };
    let spared = parts.filter(is_spared);
    spared.flat_map(|part| model.topology.vertices_of(part)).collect()
}

/// Joins the parts that the selected handle holds to the others, at these pairs of vertices or at the nearest borders.
/// Each pair has a vertex of either side, in any order.
pub(crate) fn merge_held(workspace: &mut Workspace, pairs: &[[SurfaceVertex; 2]], settings: MergeSettings) {
    let parts = held_parts(workspace);
    let Some(model) = workspace.model().cloned() else {
        return;
    };
    let is_held = |vertex: SurfaceVertex| parts.contains(&model.topology.component(vertex));
    if let Some([one, other]) = pairs.iter().find(|[one, other]| is_held(*one) == is_held(*other)) {
        let [one, other] = [one, other].map(|vertex| model.first_file_vertex(*vertex).0);
        workspace.refuse(format!(
            "Both borders, at the vertices {one} and {other}, are on one side: click one border of the selected handle's \
             part and one of another part."
        ));
        return;
    }
    let sorted = |[one, other]: &[SurfaceVertex; 2]| match is_held(*one) {
        true => [*other, *one],
        false => [*one, *other],
    };
    let all = (0..model.surface.positions.len() as u32).map(SurfaceVertex);
    let change = MergeChange {
        part: all.filter(|vertex| is_held(*vertex)).collect(),
        pairs: pairs.iter().map(sorted).collect(),
        settings,
    };
    stitch(workspace, MeshChange::Merge(change));
}

/// Mirrors the parts that the selected handle holds across its own axis 0, 1, 2 for x, y, z. They are turned inside out
/// as well, so that they still face outwards.
pub(crate) fn mirror_held(workspace: &mut Workspace, axis: usize) {
    let parts = held_parts(workspace);
    let Some(handle) = workspace.selected().cloned() else {
        return;
    };
    let HandleTransform::Trs {
        translation,
        rotation,
        mut scale,
        pivot,
    } = handle.transform
    else {
        workspace.refuse(format!(
            "{} is moved by a matrix: reset it, then mirror it.",
            handle.name
        ));
        return;
    };
    scale[axis.min(2)] *= -1.0;
    let mirrored = HandleTransform::Trs {
        translation,
        rotation,
        scale,
        pivot,
    };
    workspace.step(format!("Mirror {}", handle.name), |workspace| {
        put_handle(workspace, handle.id, mirrored);
        let turned = workspace.document.inside_out().symmetric_difference(&parts);
        let turned = Arc::new(turned.copied().collect());
        workspace.document.set_inside_out(turned);
    });
}
