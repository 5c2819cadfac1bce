//! The shapes of the open file to which undo and redo lead, after its triangles were changed.

use std::sync::Arc;

use glam::DVec3;
use pliant_engine::Loaded;
use pliant_mesh::Model;

use crate::window::files::in_file::InFile;
use crate::window::files::other_shape::OtherShape;
use crate::window::session::open_file::OpenFile;
use crate::window::viewport::shown::Shown;

/// The shapes that are not open now.
#[derive(Default)]
pub struct OtherShapes {
    shapes: Vec<OtherShape>,
    /// The surface of the one that was open last, so that it is shown at once when it is opened again. Only one is kept,
    /// because each takes as much of the GPU's memory as the open one.
    left: Option<Shown>,
}

impl OtherShapes {
    /// Adds one.
    pub fn add(&mut self, shape: OtherShape) {
        self.shapes.push(shape);
    }

    /// Opens the shape of this model instead of the open one. Returns its surface, if it is in GPU buffers, or `None` if
    /// there is no such shape, or it is open.
    pub fn open(&mut self, model: &Arc<Model>, open: &mut OpenFile) -> Option<Option<Shown>> {
        let mut others = self.shapes.iter_mut();
        let other = others.find(|other| Arc::ptr_eq(&other.loaded.model, model))?;
        std::mem::swap(&mut open.loaded, &mut other.loaded);
        std::mem::swap(&mut open.morph_targets, &mut other.morph_targets);
        std::mem::swap(&mut open.drawing, &mut other.drawing);
        std::mem::swap(&mut open.mesh, &mut other.mesh);
        std::mem::swap(&mut open.in_file, &mut other.in_file);
        std::mem::swap(&mut open.may_write_over, &mut other.may_write_over);
        let left = self
            .left
            .take()
            .filter(|left| Arc::ptr_eq(&left.drawing, &open.drawing));
        Some(match other.surface.take() {
            Some(unused) => {
                let at_rest = vec![DVec3::ZERO; model.surface.positions.len()];
                Some(Shown::new(Arc::clone(&open.drawing), unused, Arc::new(at_rest), model))
            }
            None => left.map(Shown::anew),
        })
    }

    /// Keeps the surface that was shown until now, if undo or redo leads to it.
    pub fn keep(&mut self, left: Option<Shown>) {
        let is_known = |left: &Shown| {
            let mut shapes = self.shapes.iter();
            shapes.any(|other| Arc::ptr_eq(&other.drawing, &left.drawing))
        };
        self.left = left.filter(is_known);
    }

    /// The shape as it was read from a file.
    pub fn of_mut(&mut self, loaded: &Arc<Loaded>) -> Option<&mut OtherShape> {
        self.shapes.iter_mut().find(|other| Arc::ptr_eq(&other.loaded, loaded))
    }

    /// What the open one's file holds of the shape of a model.
    pub fn in_file(&self, model: &Arc<Model>) -> Option<&InFile> {
        let mut others = self.shapes.iter();
        let other = others.find(|other| Arc::ptr_eq(&other.loaded.model, model))?;
        Some(&other.in_file)
    }

    /// Notes that a save of another shape has replaced the file at the open one's path.
    pub fn were_replaced(&mut self) {
        for other in &mut self.shapes {
            other.in_file.was_replaced();
            other.may_write_over = false;
        }
    }

    /// Forgets those to which nothing leads.
    pub fn forget_unless(&mut self, leads_to: impl Fn(&Arc<Model>) -> bool) {
        self.shapes.retain(|other| leads_to(&other.loaded.model));
    }
}
