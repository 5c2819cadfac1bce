//! The graphics device, shared between the view that draws and the threads that upload files.

use std::sync::{Arc, PoisonError, RwLock, RwLockReadGuard, RwLockWriteGuard};

use pliant_render::{Materials, RenderError, Renderer, Surface};

use pliant_picture::drawing::{DecodedMaterials, Drawing, Pose};

/// The device, shared with the threads that upload files. Drawing needs exclusive access, and skips a frame rather than
/// wait.
#[derive(Clone)]
pub struct Gpu(Arc<RwLock<Renderer>>);

impl Gpu {
    /// A device's renderer, for sharing.
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

    /// The renderer, shared with other readers.
    pub fn read(&self) -> RwLockReadGuard<'_, Renderer> {
        // A panic elsewhere does not change the device.
        self.0.read().unwrap_or_else(PoisonError::into_inner)
    }

    /// The renderer, shared, unless somebody draws.
    pub fn try_read(&self) -> Option<RwLockReadGuard<'_, Renderer>> {
        self.0.try_read().ok()
    }

    /// The renderer, exclusively, unless somebody has it.
    pub fn try_write(&self) -> Option<RwLockWriteGuard<'_, Renderer>> {
        self.0.try_write().ok()
    }
}
