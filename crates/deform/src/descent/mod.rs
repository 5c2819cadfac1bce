//! The descent to a least energy, which the nonlinear methods share.
//!
//! A method implements [`energy::Energy`] for its shape: its value, a direction uphill, and trial shapes along it. From
//! this [`energy::lower`] takes a step with a line search, and [`rule::Rule`] tells whether the descent has converged.
//! `springs` are the soft handles, `prescribed` the vertices of hard ones, and `corrections` is the schedule by which a
//! coarse level corrects a large surface. `rival` is the second descent, from rest, at the end of a drag.

pub(crate) mod corrections;
pub(crate) mod energy;
pub(crate) mod prescribed;
pub(crate) mod rival;
pub(crate) mod rule;
pub(crate) mod springs;
