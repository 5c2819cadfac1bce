//! The ground.

use crate::frame::uniforms::GridUniform;

/// Lines on the ground, one `step` apart, each tenth stronger; the two of the world's axes that lie in it in colour.
/// It fades towards `reach` and is drawn from both sides.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    /// A crossing of strong lines near what is looked at (relative to the centre).
    pub middle: [f32; 3],
    /// Directions of the lines, unit vectors at right angles.
    pub along: [[f32; 3]; 2],
    /// World units between lines.
    pub step: f32,
    /// World units from the middle to where nothing is left of it.
    pub reach: f32,
    /// How strong the lines between the tenths are, 0 to 1: let it fall before the step becomes ten times as wide.
    pub fine_share: f32,
    /// Where the world's axes cross, in steps from the middle along each direction.
    pub axes: [f32; 2],
    /// Colour of the lines, sRGB with straight alpha.
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
