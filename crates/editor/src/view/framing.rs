//! What the camera is put before: everything, the selected handle, a part, a vertex of the file.

use glam::DVec3;
use pliant_mesh::{DrawnVertex, SurfaceVertex};

use crate::document::Paint;
use crate::editor::Editor;

impl Editor {
    pub(crate) fn frame_all(&mut self) {
        let Some(model) = self.engine.model.as_ref() else {
            return;
        };
        let rest = model.surface.positions.iter();
        let moved = rest.zip(self.document.from_file.iter()).map(|(&p, &d)| p + d);
        let shown = moved.enumerate().filter(|(vertex, _)| self.masks.is_shown(*vertex));
        let positions: Vec<DVec3> = shown.map(|(_, position)| position).collect();
        self.camera.frame(&positions, self.viewport_px);
        self.is_framed = true;
    }

    pub(crate) fn frame_selected(&mut self) {
        let (Some(model), Some(id)) = (self.engine.model.as_ref(), self.selected) else {
            return;
        };
        let members: Vec<DVec3> = (0..self.document.paint.len())
            .filter(|&vertex| self.document.paint[vertex] == Paint::Handle(id))
            .map(|vertex| model.surface.positions[vertex] + self.document.from_file[vertex])
            .collect();
        if !members.is_empty() {
            self.camera.frame(&members, self.viewport_px);
            // Its region shows what bends: as much room again on every side.
            self.camera.distance *= 3.0;
            self.is_framed = false;
        }
    }

    pub(crate) fn frame_part(&mut self, part: u32) {
        let Some(model) = self.engine.model.as_ref() else {
            return;
        };
        if part as usize >= model.topology.components().len() {
            return;
        }
        let position =
            |vertex: SurfaceVertex| model.surface.positions[vertex.index()] + self.document.from_file[vertex.index()];
        let positions: Vec<DVec3> = model.topology.vertices_of(part).map(position).collect();
        self.camera.frame(&positions, self.viewport_px);
        // What it lies on is to be seen, too.
        self.camera.distance *= 3.0;
        self.is_framed = false;
    }

    /// Comes close to a vertex, by the file's number.
    pub(crate) fn frame_file_vertex(&mut self, file_vertex: u32) {
        let Some(model) = self.engine.model.as_ref() else {
            return;
        };
        let drawn = model.drawn.file_vertices().position(|vertex| vertex.0 == file_vertex);
        let Some(drawn) = drawn.map(|drawn| DrawnVertex(drawn as u32)) else {
            return;
        };
        let surface = model.drawn.surface_vertex(drawn);
        let point =
            model.rest_position(drawn) + surface.map_or(DVec3::ZERO, |vertex| self.document.from_file[vertex.index()]);
        if point.is_finite() {
            self.camera.target = point;
            self.camera.distance = 0.15 * self.camera.scale;
            self.is_framed = false;
        }
    }
}
