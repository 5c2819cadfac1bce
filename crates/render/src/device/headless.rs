//! A device without a window.

use crate::device::guard::one_line;
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

async fn adapter(instance: &wgpu::Instance) -> Option<wgpu::Adapter> {
    if let Ok(adapter) = wgpu::util::initialize_adapter_from_env(instance, None).await {
        return Some(adapter);
    }
    for force_fallback_adapter in [false, true] {
        let options = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            force_fallback_adapter,
            ..Default::default()
        };
        if let Ok(adapter) = instance.request_adapter(&options).await {
            return Some(adapter);
        }
    }
    None
}

/// The device descriptor for an adapter: the adapter's own limits (the defaults cap buffers at 256 MiB) and those
/// optional features that the renderer can use. A window should request its device with this descriptor, too.
pub fn device_descriptor(adapter: &wgpu::Adapter) -> wgpu::DeviceDescriptor<'static> {
    let useful = wgpu::Features::PRIMITIVE_INDEX | wgpu::Features::TIMESTAMP_QUERY;
    wgpu::DeviceDescriptor {
        label: Some("pliant"),
        required_features: adapter.features() & useful,
        required_limits: adapter.limits(),
        ..Default::default()
    }
}

/// Whether the device is a software renderer on the CPU.
pub(crate) fn is_software(device: &wgpu::Device) -> bool {
    device.adapter_info().device_type == wgpu::DeviceType::Cpu
}
