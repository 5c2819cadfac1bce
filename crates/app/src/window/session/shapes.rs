//! The shapes of the open file to which undo and redo lead, after its triangles were changed.

use std::sync::Arc;

use pliant_engine::Loaded;
use pliant_mesh::Model;
use pliant_render::Surface;

use crate::window::files::in_file::InFile;
use crate::window::files::other_shape::OtherShape;
use crate::window::session::open_file::OpenFile;

/// The shapes that are not open now.
#[derive(Default)]
pub struct OtherShapes(Vec<OtherShape>);

impl OtherShapes {
    /// Adds one.
    pub fn add(&mut self, shape: OtherShape) {
        self.0.push(shape);
    }

    /// Opens the shape of this model instead of the open one. Returns its surface, if it is still unused, or `None` if
    /// there is no such shape, or it is open.
    pub fn open(&mut self, model: &Arc<Model>, open: &mut OpenFile) -> Option<Option<Surface>> {
        let mut others = self.0.iter_mut();
        let other = others.find(|other| Arc::ptr_eq(&other.loaded.model, model))?;
        std::mem::swap(&mut open.loaded, &mut other.loaded);
        std::mem::swap(&mut open.morph_targets, &mut other.morph_targets);
        std::mem::swap(&mut open.drawing, &mut other.drawing);
        std::mem::swap(&mut open.mesh, &mut other.mesh);
        std::mem::swap(&mut open.in_file, &mut other.in_file);
        std::mem::swap(&mut open.may_write_over, &mut other.may_write_over);
        Some(other.surface.take())
    }

    /// The shape as it was read from a file.
    pub fn of_mut(&mut self, loaded: &Arc<Loaded>) -> Option<&mut OtherShape> {
        self.0.iter_mut().find(|other| Arc::ptr_eq(&other.loaded, loaded))
    }

    /// What the open one's file holds of the shape of a model.
    pub fn in_file(&self, model: &Arc<Model>) -> Option<&InFile> {
        let mut others = self.0.iter();
        let other = others.find(|other| Arc::ptr_eq(&other.loaded.model, model))?;
        Some(&other.in_file)
    }

    /// Notes that a save of another shape has replaced the file at the open one's path.
    pub fn were_replaced(&mut self) {
        for other in &mut self.0 {
            other.in_file.was_replaced();
            other.may_write_over = false;
        }
    }

    /// Forgets those to which nothing leads.
    pub fn forget_unless(&mut self, leads_to: impl Fn(&Arc<Model>) -> bool) {
        self.0.retain(|other| leads_to(&other.loaded.model));
    }
}
