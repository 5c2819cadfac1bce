//! A device without a window.

use crate::device::guard::one_line;
use crate::device::opening::{adapter, device_descriptor};
use crate::{NoGpu, Renderer};

/// A renderer on the best available device, which may be a software one.
#[derive(Debug)]
pub struct Headless {
    /// The renderer; draw with [`Renderer::draw_to_image`].
    pub renderer: Renderer,
}

impl Headless {
    /// Opens a device of any backend (`WGPU_BACKEND` and `WGPU_ADAPTER_NAME` choose one).
    ///
    /// # Errors
    /// [`NoGpu`] when there is no device or it can't be used.
    pub fn new() -> Result<Self, NoGpu> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
        let adapter = pollster::block_on(adapter(&instance)).ok_or(NoGpu::NoAdapter)?;
        let name = adapter.get_info().name;
        let (device, queue) =
            pollster::block_on(adapter.request_device(&device_descriptor(&adapter))).map_err(|error| {
                NoGpu::Refused {
                    name: name.clone(),
                    reason: one_line(&error.to_string()),
                }
            })?;
        let renderer = Renderer::new(&device, &queue).map_err(|error| NoGpu::Unusable {
            name,
            reason: error.to_string(),
        })?;
        Ok(Self { renderer })
    }
}
