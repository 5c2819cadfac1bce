//! What drives a flow.

use glam::DVec3;

/// The accuracy in time and space with which a flow is carried along itself.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Advection {
    /// Values are interpolated where they come from \[Sta99\]: edges of dye blur, and swirls calm down.
    FirstOrder,
    /// The error of going forth and back is taken off, as far as no new extremes arise \[SFK+08\].
    #[default]
    SecondOrder,
}

/// Forces and properties of a fluid. The default has no force and no viscosity.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct FlowSettings {
    /// The acceleration of dyed fluid, in world units per second squared. Its part along the surface acts, in proportion
    /// to the dye. It does not act on clear fluid: all along one fluid gravity is a gradient, which pressure balances.
    pub gravity: DVec3,
    /// Kinematic viscosity, in squared world units per second: 0 or more.
    pub viscosity: f64,
    /// The strength of vorticity confinement \[FSJ01\], per second: 0 or more. Swirls that are about as small as triangles
    /// get energy back.
    pub confinement: f64,
    /// The accuracy of advection.
    pub advection: Advection,
}

impl FlowSettings {
    /// Whether something may speed the fluid up.
    pub(crate) fn has_force(&self) -> bool {
        self.gravity != DVec3::ZERO || self.confinement > 0.0
    }
}
