//! Device errors as results: every use of the device runs inside error scopes.

use crate::RenderError;

/// Runs `work` inside error scopes of `device`. A device error becomes a [`RenderError`] whose message says what the
/// renderer was `doing` ("while drawing").
pub(crate) fn guarded<T>(
    device: &wgpu::Device,
    doing: &'static str,
    work: impl FnOnce() -> Result<T, RenderError>,
) -> Result<T, RenderError> {
    let memory = device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
    let internal = device.push_error_scope(wgpu::ErrorFilter::Internal);
    let validation = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let result = work();
    // Scopes are popped in reverse order. On native platforms the futures are ready at once.
    let refused = pollster::block_on(validation.pop()).or(pollster::block_on(internal.pop()));
    let out_of_memory = pollster::block_on(memory.pop());
    if out_of_memory.is_some() {
        return Err(RenderError::OutOfMemory { doing });
    }
    if let Some(error) = refused {
        return Err(RenderError::Refused {
            doing,
            reason: one_line(&error.to_string()),
        });
    }
    result
}

/// A multi-line message as one line.
pub(crate) fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
