//! Colours of vertices, to be saved in place of a file's own.

use pliant_mesh::Drawn;

use crate::appearance::colour::SrgbBytes;

/// The colour of each *file* vertex as sRGB with a linear alpha, `None` for those that nothing draws. `colours` has the
/// linear colour of each drawn vertex; the first of a file vertex counts.
pub(crate) fn of_file(drawn: &Drawn, colours: &[[u16; 4]]) -> Vec<Option<[u8; 4]>> {
    let srgb = SrgbBytes::new();
    let mut out = vec![None; drawn.file_vertex_count];
    for (file, &colour) in drawn.file_vertex.iter().zip(colours) {
        if let Some(slot) = out.get_mut(file.index()) {
            slot.get_or_insert_with(|| srgb.of_linear(colour));
        }
    }
    out
}

/// A channel from 0 to 1, with four decimals: finer than its 8 bits.
pub(crate) fn unit(channel: u8) -> f32 {
    (f32::from(channel) / 255.0 * 1e4).round() / 1e4
}
