//! Colours that distinguish handles.

/// The colours that handles get in turn: gold first, as in the survey's figures. A test of the regions' colours checks
/// that they are distinct from each other and from the regions under every common colour blindness.
pub const HANDLE_COLOURS: [[u8; 4]; 8] = [
    [232, 184, 48, 255],
    [219, 84, 32, 255],
    [80, 204, 99, 255],
    [117, 52, 250, 255],
    [20, 243, 250, 255],
    [176, 72, 159, 255],
    [117, 83, 42, 255],
    [203, 248, 164, 255],
];

/// The initial colour of the handle of this number.
pub(crate) fn handle_colour(number: u16) -> [u8; 4] {
    HANDLE_COLOURS[usize::from(number) % HANDLE_COLOURS.len()]
}
