//! The common code of the methods that bend the space around the points, connected or not.
//!
//! A method that is linear in the handles' motions is a [`field::SpaceMap`]: it gives each point's coefficients once,
//! and [`field::LinearField`] makes its frames, by a product, and its Jacobians; [`linear::BoundLinear`] is the bound
//! form of those that meet their handles. Methods that do not hold fixed vertices by themselves fade towards them by a
//! [`falloff::Falloff`]. Those that only fit the handles do so at [`fit_samples`], and solve for an affine map first
//! ([`affine`]), and for control points that meet them without swinging far ([`point_fit`]). Control points that a person may move are [`controls`], and the hand's effect on the vertices is a
//! [`hand_field`]. Methods that are not linear evaluate each vertex of [`moving::Moving`].

pub(crate) mod affine;
pub(crate) mod blend;
pub(crate) mod falloff;
pub(crate) mod field;
pub(crate) mod fit_samples;
pub(crate) mod hand_field;
pub(crate) mod joining;
pub(crate) mod linear;
pub(crate) mod moving;
pub(crate) mod neighbours;
pub(crate) mod point_fit;
pub(crate) mod shaping;
pub(crate) mod unit;
