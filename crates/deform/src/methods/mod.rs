//! The methods, a folder each. Only the registry knows them all.

pub(crate) mod arap;
pub(crate) mod bilaplacian;
pub(crate) mod cage;
pub(crate) mod embedded;
pub(crate) mod frames;
#[cfg(feature = "identity-method")]
pub(crate) mod identity;
pub(crate) mod laplacian;
pub(crate) mod lattice;
pub(crate) mod mls;
pub(crate) mod poisson;
pub(crate) mod primo;
pub(crate) mod rbf;
pub(crate) mod shells;
pub(crate) mod space_primo;
pub(crate) mod wrinkles;
