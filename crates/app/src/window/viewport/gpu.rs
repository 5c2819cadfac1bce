//! The graphics device, shared between the view that draws and the threads that upload files.

use std::sync::{Arc, PoisonError, RwLock, RwLockReadGuard, RwLockWriteGuard};

use pliant_render::{Materials, RenderError, Renderer, Surface};

use crate::drawing::{DecodedMaterials, Drawing, Pose};

/// The device, shared with the threads that upload files. Drawing needs it alone, and rather skips a frame than wait.
#[derive(Clone)]
pub struct Gpu(Arc<RwLock<Renderer>>);

impl Gpu {
    /// A device's renderer, to be shared.
    pub fn new(renderer: Renderer) -> Self {
        Self(Arc::new(RwLock::new(renderer)))
    }

    /// Uploads a file's images.
    ///
    /// # Errors
    /// As [`Materials::new`].
    pub fn upload_images(&self, decoded: &DecodedMaterials) -> Result<Materials, RenderError> {
        decoded.upload(&self.read())
    }

    /// Uploads a file's surface.
    ///
    /// # Errors
    /// As [`Surface::new`].
    pub fn upload(&self, drawing: &Drawing, pose: &Pose) -> Result<Surface, RenderError> {
        drawing.upload(&self.read(), pose)
    }

    /// The renderer, beside whoever else reads it.
    pub fn read(&self) -> RwLockReadGuard<'_, Renderer> {
        // A panic elsewhere leaves the device as it is.
        self.0.read().unwrap_or_else(PoisonError::into_inner)
    }

    /// The renderer beside others, unless somebody draws.
    pub fn try_read(&self) -> Option<RwLockReadGuard<'_, Renderer>> {
        self.0.try_read().ok()
    }

    /// The renderer alone, unless somebody has it.
    pub fn try_write(&self) -> Option<RwLockWriteGuard<'_, Renderer>> {
        self.0.try_write().ok()
    }
}
