//! The ground grid.

use crate::uniforms::GridUniform;

/// A ground grid with lines `step` apart, every tenth stronger, and the two world axes in colour. It fades out towards
/// `reach` and is drawn from both sides.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    /// A crossing of strong lines near the camera's target (relative to the centre).
    pub middle: [f32; 3],
    /// Directions of the lines: orthogonal unit vectors.
    pub along: [[f32; 3]; 2],
    /// World units between lines.
    pub step: f32,
    /// Distance from the middle, in world units, at which the grid has faded out.
    pub reach: f32,
    /// Strength of the lines between the tenths, 0 to 1. Fade it out before `step` grows tenfold.
    pub fine_share: f32,
    /// The crossing of the world's axes, in steps from the middle along each direction.
    pub axes: [f32; 2],
    /// Line colour, sRGB with straight alpha.
    pub colour: [u8; 4],
    /// Colours of the axes along each direction.
    pub axis_colours: [[u8; 4]; 2],
}

impl Grid {
    pub(crate) fn uniform(&self) -> GridUniform {
        let shares = |colour: [u8; 4]| colour.map(|byte| f32::from(byte) / 255.0);
        GridUniform {
            middle: self.middle,
            step: self.step,
            along_u: self.along[0],
            reach: self.reach,
            along_v: self.along[1],
            fine_share: self.fine_share,
            axes: self.axes,
            padding: [0.0; 2],
            colour: shares(self.colour),
            u_axis_colour: shares(self.axis_colours[0]),
            v_axis_colour: shares(self.axis_colours[1]),
        }
    }
}
