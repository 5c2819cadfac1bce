#![doc = include_str!("../README.md")]
//!
//! # This crate
//!
//! The package `pliant` re-exports this module, and its docstrings and stubs (`python/pliant/__init__.pyi`) document it
//! for people who write Python.
//!
//! `edit` builds an edit in the edit format, so that methods, options, selections and refusals are the same; only the
//! handles' targets come later, with every step. Long calls run without Python's lock and stop at Ctrl-C
//! (`interruptible`).

mod arrays;
mod bent_files;
mod bound;
mod compare;
mod compared;
mod edit;
mod flow;
mod given;
mod information;
mod interruptible;
mod mesh;
mod methods;
mod origin;
mod pool;
mod refusal;
mod render;
mod reported;
mod rows;
mod shape;
mod stitched_files;
mod symmetry;
mod targets;
mod transfer;
mod values;
mod warned;
mod welded;

use pyo3::pymodule;

#[pymodule(name = "_native")]
mod native {
    #[pymodule_export]
    use super::bent_files::{animate, apply, sequence};
    #[pymodule_export]
    use super::bound::{BoundMesh, bind};
    #[pymodule_export]
    use super::compare::compare;
    #[pymodule_export]
    use super::compared::{diff, distortion};
    #[pymodule_export]
    use super::flow::flow;
    #[pymodule_export]
    use super::information::info;
    #[pymodule_export]
    use super::mesh::{Mesh, load, save};
    #[pymodule_export]
    use super::methods::methods;
    #[pymodule_export]
    use super::render::render;
    #[pymodule_export]
    use super::stitched_files::{bridge, cut, fill, merge};
    #[pymodule_export]
    use super::symmetry::symmetry;
    #[pymodule_export]
    use super::transfer::transfer;

    #[pymodule_export]
    #[expect(non_upper_case_globals, reason = "Python's name for it")]
    const __version__: &str = env!("CARGO_PKG_VERSION");
}
