//! Colours to tell handles apart by.

/// The colours that handles get in turn: gold first, as in the survey's figures.
pub const HANDLE_COLOURS: [[u8; 4]; 8] = [
    [232, 184, 48, 255],
    [222, 96, 72, 255],
    [120, 190, 88, 255],
    [176, 112, 214, 255],
    [64, 190, 190, 255],
    [236, 132, 176, 255],
    [150, 128, 84, 255],
    [244, 222, 120, 255],
];

/// The colour that the handle of this number gets when it is made.
pub(crate) fn handle_colour(number: u16) -> [u8; 4] {
    HANDLE_COLOURS[usize::from(number) % HANDLE_COLOURS.len()]
}
