//! Opening a device, and the device's kind.

/// The best available adapter, which may be a software one.
pub(crate) async fn adapter(instance: &wgpu::Instance) -> Option<wgpu::Adapter> {
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

/// Returns true if the device is a software renderer on the CPU.
pub(crate) fn is_software(device: &wgpu::Device) -> bool {
    device.adapter_info().device_type == wgpu::DeviceType::Cpu
}
