//! Factored systems of the bi-Laplacian, which the bi-Laplacian, gradient and Laplacian editing, rotation-invariant
//! coordinates, fairing, transfer and flow share: the operator of a [`plate_energy`], its assembly and solution, and
//! the [`poisson_system`] with a load on top.

pub(crate) mod assembly;
pub(crate) mod boundaries;
pub(crate) mod capacitance;
pub(crate) mod continuity;
pub(crate) mod elimination_plan;
pub(crate) mod factored;
pub(crate) mod held;
pub(crate) mod hubs;
pub(crate) mod natural;
pub(crate) mod operator;
pub(crate) mod plate_energy;
pub(crate) mod poisson_equation;
pub(crate) mod poisson_system;
pub(crate) mod refine;
pub(crate) mod setup;
pub(crate) mod solution;
pub(crate) mod springs;
pub(crate) mod stiff_parts;
