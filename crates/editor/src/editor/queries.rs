//! Queries: the state to show, and the available commands.

use std::borrow::Cow;
use std::sync::Arc;

use glam::DVec2;
use pliant_deform::Role;
use pliant_mesh::{ContourLine, SurfaceVertex};

use super::Editor;
use crate::command::{Command, Shortcut, State};
use crate::document::{Aspect, Crease, Document, HandleId, History, SaveMark};
use crate::format::{ExportError, export};
use crate::jobs::{Activity, Comparison, FlowRecording, Intersections, JobKind};
use crate::region::Rim;
use crate::scene_view::{ControlPoints, SceneView};
use crate::snapshot::Snapshot;
use crate::status::status;
use crate::stitching::StitchRequest;
use crate::timeline::Following;
use crate::tool::{Gesture, ToolMode};
use crate::view::{Cursor, Look, Pick};
use crate::warning::in_window_words;
use crate::workspace::{
    ControlSource, SnapshotKey, Workspace, lasting, region_colour, rims, selected_curve, take_stitching,
};
use crate::{EditFile, MeshReference, geometry_hash};

impl Editor {
    /// The present content of the window.
    pub fn view(&self) -> SceneView<'_> {
        let (workspace, view, settings) = (&self.workspace, &self.view, &self.settings);
        let gesture = self.gesture.as_deref();
        let document = &workspace.document;
        let computed = workspace.computed();
        SceneView {
            model: workspace.model(),
            camera: view.camera(),
            viewport_px: view.viewport_px(),
            shape_revision: workspace.shape_revision(),
            displacements: document.from_file(),
            original: &workspace.original,
            drawn: match view.look {
                // A frame's own shape is its rest shape.
                Look { original: true, .. } if document.animation().frames().is_some() => &document.rest,
                Look { original: true, .. } => &workspace.original,
                Look { base: true, .. } => computed.base().unwrap_or(document.from_file()),
                _ => document.from_file(),
            },
            weights: computed.weights().filter(|_| workspace.selection.selected().is_some()),
            regions_revision: workspace.colours().regions_revision(),
            rims_revision: workspace.colours().rims_revision(),
            overlay_revision: self.overlay.revision,
            camera_revision: view.revision(),
            is_dragging: workspace.keys.is_playing()
                || gesture.is_some_and(|gesture| gesture.activity() == Activity::Dragging),
            brush_ring: &self.overlay.ring,
            gizmo: &self.overlay.gizmo,
            controls: &self.overlay.controls,
            shapes: &self.overlay.shapes,
            control_points: self.control_points(),
            descent: workspace.descent.filter(|_| document.is_displaced()),
            look: view.look,
            orbit: view.orbit(),
            readout: gesture.and_then(|gesture| gesture.readout(workspace, view)),
            tool: settings.mode,
            cursor: self.cursor(),
            outline_px: gesture.map_or(Vec::new(), Gesture::outline_px),
            stroke_shape: settings.stroke_shape,
            chain: settings.chain,
            whole_limb: settings.whole_limb,
            depth: settings.depth,
            symmetry: workspace.symmetry(),
            brush_metric: settings.brush().metric,
            stiffness_brush: settings.stiffness_brush,
            correction_brush: settings.correction_brush,
            flow_brush: settings.flow_brush,
            skins: workspace.jobs.skins(),
            selected_keys: workspace.keys.selected(),
            is_animating: workspace.keys.is_playing(),
            is_catching_up: self.is_catching_up(),
            wanted_frame: workspace.frame_to_read(),
            wanted_mix: workspace.mix_to_read(),
            wants_following: gesture.is_none() && workspace.wants_following(&view.look),
            pointed_frame: self.overlay.pointed_frame,
            world_camera: view.world_camera(),
            body_motion: view.body(),
            is_playing: workspace.flow.is_playing(),
            pressure: settings.pressure,
            orientation: settings.orientation,
            wants_pivot: settings.wants_pivot,
            wants_rim: settings.wants_rim,
            rim: self.overlay.rim.as_ref(),
            pair_numbers: settings.pair_numbers(workspace),
            wants_cut: settings.wants_cut,
            merge: &settings.merge,
            stitching: workspace.stitching.as_ref().map(|stitching| stitching.change.name()),
            brush_radius_px: settings.brush().radius_px,
            handles: document.handles(),
            selected: workspace.selection.selected(),
            companions: workspace.selection.companions(),
            status: status(gesture, workspace, view, settings, &self.overlay),
            problem: workspace.refusal.as_deref(),
            jobs: workspace.jobs.running(),
            counts: workspace.computed().region.counts,
            undo: workspace.history.undo_name(),
            redo: workspace.history.redo_name(),
            unsaved: workspace.history.is_unsaved(),
            settled: self.is_settled(),
        }
    }

    /// The change of the mesh that a person has asked for, once, and when the shape has settled. The caller makes the new
    /// mesh and sends [`Event::Stitched`](crate::Event::Stitched).
    pub fn take_stitch(&mut self) -> Option<StitchRequest> {
        if !self.is_shape_settled() {
            return None;
        }
        let change = take_stitching(&mut self.workspace)?;
        Some(StitchRequest {
            change,
            snapshot: self.snapshot()?,
        })
    }

    /// The handles to follow while all frames of a sequence are read.
    pub fn following(&self) -> Following {
        self.workspace.following()
    }

    /// The number of footprints of a handle; `None` without any, or until the frames were followed.
    pub fn footprints_of(&self, handle: HandleId) -> Option<usize> {
        self.workspace.footprints_of(handle)
    }

    fn control_points(&self) -> Option<ControlPoints> {
        let declared = self.document().method().declaration().attachments.first()?;
        let shown = self.workspace.shown_controls()?;
        if matches!(shown.source, ControlSource::Curve(..)) {
            return None;
        }
        let count = shown.positions.len();
        (count > 0).then(|| ControlPoints {
            title: declared.title,
            count,
            selected: self.workspace.controls.points().len(),
            is_own: self.document().attachment().is_some(),
        })
    }

    /// The least and the most bend, in degrees, at the first of the selected points of an open curve, or at the joint of
    /// the selected part of a limb; `None` if no point between a curve's ends is selected, or if the part has no parent.
    pub fn selected_bend_deg(&self) -> Option<[f64; 2]> {
        let Some((_, curve)) = selected_curve(&self.workspace) else {
            let handle = self.workspace.selected()?;
            return (handle.line.is_none() && handle.parent.is_some()).then_some(handle.bend_deg);
        };
        let joints = 1..curve.rest().points().len() as u32 - 1;
        let selected = self.workspace.controls.points().iter();
        let joint = selected.copied().find(|point| joints.contains(point))?;
        (!curve.rest().is_closed()).then(|| curve.bend_deg(joint as usize))
    }

    /// The crease along the selected handle's curve; `None` without one.
    pub fn selected_crease(&self) -> Option<Crease> {
        let (_, curve) = selected_curve(&self.workspace)?;
        curve.crease()
    }

    /// Returns true if that crease is narrower than the edges beside it, so that only the line itself moves.
    pub fn is_crease_narrow(&self) -> bool {
        self.workspace.is_crease_narrow()
    }

    fn cursor(&self) -> Cursor {
        match &self.gesture {
            Some(gesture) => gesture.cursor(),
            None if self.overlay.takes_press() => Cursor::Grab,
            None if self.overlay.takes_handle => Cursor::Grab,
            None if self.settings.mode == ToolMode::Pose && !self.overlay.shapes.is_empty() => Cursor::Grab,
            None if self.overlay.is_over_surface && self.settings.mode != ToolMode::Select => Cursor::Brush,
            None => Cursor::Arrow,
        }
    }

    /// The weights of the method's examples that the last solve used or found; empty before the first solve.
    pub fn example_weights(&self) -> &[f64] {
        &self.workspace.computed().example_weights
    }

    /// The most memory in bytes that bindings may take, if a person has set it.
    pub fn most_memory(&self) -> Option<u64> {
        self.workspace.jobs.most_memory()
    }

    /// The document.
    pub fn document(&self) -> &Document {
        &self.workspace.document
    }

    /// The steps that can be undone and redone.
    pub fn history(&self) -> &History {
        &self.workspace.history
    }

    /// The open file's name; empty before the first.
    pub fn file_name(&self) -> &str {
        &self.workspace.file_name
    }

    /// The role of each surface vertex in the last measured region.
    pub fn roles(&self) -> &[Role] {
        &self.workspace.computed().region.roles
    }

    /// The reach of a handle along the surface, in world units, in the last measured region; `None` if it has no vertices
    /// there.
    pub fn reach_length(&self, handle: HandleId) -> Option<f64> {
        self.workspace.computed().region.reach_length(handle)
    }

    /// The highlighted connected part, by its component's number.
    pub fn lit_part(&self) -> Option<u32> {
        self.workspace.colours().lit()
    }

    /// The connected parts without paint that follow the part that they touch, and those with their own setting, by
    /// their component's number, in the last measured region.
    pub fn loose_components(&self) -> &[u32] {
        &self.workspace.computed().region.loose
    }

    /// Sentences about the present binding and shape: the behaviour of loose parts, repairs, and motions of the handles
    /// that the method can't follow.
    pub fn warnings(&self) -> Vec<String> {
        let warnings = self.workspace.computed().warnings();
        warnings.map(|warning| warning.worded(self.document())).collect()
    }

    /// The places where the final shape passes through itself and the file's did not; `None` if nothing is bent, before
    /// the search, and while the shape changes.
    pub fn intersections(&self) -> Option<&Intersections> {
        self.workspace.intersections()
    }

    /// The faults of the shape by the present method, in the words of the window.
    pub fn faults(&self) -> Vec<String> {
        let found = self
            .intersections()
            .map(|found| found.sentences(self.document().method()));
        let sentences = found.unwrap_or_default();
        sentences.iter().map(|sentence| in_window_words(sentence)).collect()
    }

    /// The methods' solutions for the present edit, during a comparison.
    pub fn comparison(&self) -> Option<&Comparison> {
        self.workspace.jobs.comparison.as_ref()
    }

    /// The shown ones among [`pliant_mesh::Drawn::triangles`]; `None` is all of them. A change makes a new allocation.
    pub fn shown_triangles(&self) -> Option<&Arc<Vec<bool>>> {
        self.workspace.vertex_access.drawn.as_ref()
    }

    /// Replaces `out` by the colour of each surface vertex for its role, sRGB with alpha: handles in their own colours,
    /// the free region blue, vertices painted as fixed dark grey, and no colour (alpha 0) for vertices that rest by
    /// themselves.
    ///
    /// A change of [`SceneView::regions_revision`] means that they changed.
    pub fn region_colours(&self, out: &mut Vec<[u8; 4]>) {
        out.clear();
        let colour = self.region_colour();
        out.extend((0..self.document().paint().len() as u32).map(|vertex| colour(SurfaceVertex(vertex))));
    }

    /// The vertices whose colour may have changed since a revision of the regions; `None`: all of them.
    pub fn recoloured_since(&self, regions_revision: u64) -> Option<&[SurfaceVertex]> {
        self.workspace.colours().since(regions_revision)
    }

    /// The data that determine the colour of a vertex: see [`Editor::region_colours`].
    pub fn region_colour(&self) -> impl Fn(SurfaceVertex) -> [u8; 4] {
        region_colour(&self.workspace)
    }

    /// The lines between the last measured regions, each with the region that it bounds; those of hidden handles are
    /// left out. A change of [`SceneView::rims_revision`] means that they changed.
    pub fn rims(&self) -> impl Iterator<Item = (&ContourLine, Rim)> {
        rims(&self.workspace)
    }

    /// The hit under a point of the view, in points, on the last shape of the hierarchy for rays.
    pub fn pick(&self, position_px: DVec2) -> Option<Pick> {
        self.workspace.pick(&self.view, position_px)
    }

    /// The present document, with an active drag; `None` before the first file.
    pub fn snapshot(&self) -> Option<Snapshot> {
        Some(Snapshot {
            document: self.lasting_document()?,
            model: Arc::clone(self.workspace.model()?),
            camera: *self.view.camera(),
            work_pose: self
                .document()
                .work_pose()
                .map(|_| self.document().present_pose("work pose".to_owned())),
        })
    }

    /// The document outside its work pose, which files get.
    fn lasting_document(&self) -> Option<Document> {
        let model = self.workspace.model()?;
        if self.document().animation().frames().is_some() {
            return Some(self.workspace.document_at_file());
        }
        Some(match self.document().work_pose() {
            None => self.document().clone(),
            Some(_) => lasting(self.document(), model),
        })
    }

    /// The shape outside the work pose, per surface vertex, as displacements from the file's shape.
    pub fn lasting_shape(&self) -> Arc<Vec<glam::DVec3>> {
        match self.lasting_document() {
            Some(document) => Arc::clone(document.from_file()),
            None => Arc::clone(self.document().from_file()),
        }
    }

    /// The state that a save beginning now writes.
    pub fn save_mark(&self) -> SaveMark {
        let Workspace { history, document, .. } = &self.workspace;
        history.mark(document, self.is_settled() && document.is_settled())
    }

    /// A value that differs for every other state of the document.
    pub fn snapshot_key(&self) -> SnapshotKey {
        SnapshotKey::of(&self.workspace)
    }

    /// A digest of the document, to compare two to the bit; `None` before the first file.
    pub fn document_hash(&self) -> Option<String> {
        let snapshot = self.snapshot()?;
        let geometry = geometry_hash(snapshot.model());
        Some(
            snapshot
                .project(MeshReference {
                    path: None,
                    name: None,
                    geometry,
                })
                .document_hash(),
        )
    }

    /// The document as an edit of the open file, from which `pliant apply` makes the same positions.
    ///
    /// # Errors
    /// No file is open, a shape was applied, or a vertex that two nodes show has two roles.
    pub fn edit_file(&self) -> Result<EditFile, ExportError> {
        let model = self.workspace.model().ok_or(ExportError::NoFile)?;
        let document = self.lasting_document().ok_or(ExportError::NoFile)?;
        export(&document, model)
    }

    /// The keys that send a listed command; the first is shown.
    pub fn shortcuts(&self, command: &Command) -> &[Shortcut] {
        self.key_map.shortcuts(command)
    }

    /// Returns true if the command has an effect now.
    pub fn is_enabled(&self, command: &Command) -> bool {
        self.unavailable_because(command).is_none()
    }

    /// The reason why a command can't be executed now, as a sentence with the remedy if there is one; `None` if it can.
    pub fn unavailable_because(&self, command: &Command) -> Option<Cow<'static, str>> {
        command.unavailable(&State {
            workspace: &self.workspace,
            view: &self.view,
            settings: &self.settings,
        })
    }

    /// The flow that was played and led to the document's fluid; `None` if another change came last.
    pub fn flow_recording(&self) -> Option<&FlowRecording> {
        let workspace = &self.workspace;
        workspace
            .flow
            .recording(workspace.document.versions().of(Aspect::Fluid))
    }

    /// Returns true if a gesture is active that Esc ends: a stroke, a drag, picking a pivot.
    pub fn is_acting(&self) -> bool {
        self.gesture.is_some() || self.settings.waits_for_press()
    }

    /// Returns true if shape and regions are final: no drag or stroke is active, and no job runs except those that
    /// prepare for the pointer or the first drag.
    pub fn is_settled(&self) -> bool {
        self.workspace.stitching.is_none() && self.is_shape_settled()
    }

    /// The same on the present mesh, even if it is being changed.
    fn is_shape_settled(&self) -> bool {
        let is_displaced = self.document().is_displaced();
        let awaited = |kind: JobKind| kind.is_awaited() && (kind != JobKind::Order || is_displaced);
        let jobs = &self.workspace.jobs;
        let is_busy = || JobKind::ALL.iter().any(|&kind| awaited(kind) && jobs.is_busy(kind));
        // A stretch of play that ends becomes a part of the document.
        let is_ending = !(self.workspace.flow.is_still() || self.workspace.flow.is_playing());
        let is_awaiting = self.workspace.awaits_frame();
        self.gesture.is_none() && self.waiting.is_empty() && !is_ending && !is_awaiting && !is_busy()
    }
}
