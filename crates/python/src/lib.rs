#![doc = include_str!("../README.md")]
//!
//! # This crate
//!
//! What is here the package `pliant` re-exports, and its docstrings and stubs (`python/pliant/__init__.pyi`) say it to
//! those who write Python.
//!
//! An edit is put together as the edit format has it (`edit`), so that methods, options, selections and refusals are
//! the same; only the handles' transforms come later, with every step. Whatever takes long runs without Python's lock
//! and stops at Ctrl-C (`interruptible`).

mod arrays;
mod bound;
mod edit;
mod interruptible;
mod mesh;
mod methods;
mod pool;
mod refusal;
mod transforms;
mod values;

use pyo3::pymodule;

#[pymodule(name = "_native")]
mod native {
    #[pymodule_export]
    use super::bound::{BoundMesh, bind};
    #[pymodule_export]
    use super::mesh::{Mesh, load, save};
    #[pymodule_export]
    use super::methods::methods;

    #[pymodule_export]
    #[expect(non_upper_case_globals, reason = "Python's name for it")]
    const __version__: &str = env!("CARGO_PKG_VERSION");
}
