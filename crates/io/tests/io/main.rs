//! Reading and saving: whole files, damaged files, and files in foreign hands.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]

mod foreign_text;
mod fuzz;
mod fuzzing;
mod gltf;
mod gltf_compressed;
mod gltf_maker;
mod gltf_morph;
mod gltf_mutations;
mod gltf_new;
mod gltf_normals;
mod gltf_originals;
mod gltf_saving;
mod gltf_shared_files;
mod gltf_skins;
mod gltf_surroundings;
mod gltf_unseen;
mod looks_of_scans;
mod mutations;
mod obj;
mod off;
mod outside;
mod ply;
mod read_back;
mod shared_files;
mod single_precision;
mod stl;
mod stopping;
mod text;
mod threemf;
mod turned;
mod usdz;
mod vertex_colours;
