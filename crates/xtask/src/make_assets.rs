//! `cargo xtask assets`: makes the samples.

use std::path::Path;
use std::time::Instant;

use crate::arguments::Order;
use crate::assets::mesh::Mesh;
use crate::assets::{SAMPLES, creature_of, glb};

/// Makes and writes the samples of `order`.
///
/// # Errors
/// One sentence naming the sample or file that can't be made.
pub fn make_assets(order: &Order) -> Result<(), String> {
    if let Some(name) = order
        .names
        .iter()
        .find(|name| SAMPLES.iter().all(|sample| sample.name != name.as_str()))
    {
        let names = SAMPLES.map(|sample| sample.name).join(", ");
        return Err(format!("There is no sample `{name}`; there are {names}."));
    }
    if let Some(triangles) = order.triangles {
        if let Some(name) = order.names.iter().find(|name| *name != "creature") {
            return Err(format!("`--triangles` sizes only the creature, not `{name}`."));
        }
        let folder = order
            .output
            .clone()
            .unwrap_or_else(|| crate::process::target_folder().join("assets"));
        return make(&folder, &format!("creature-{triangles}"), || creature_of(triangles));
    }
    let folder = order
        .output
        .clone()
        .unwrap_or_else(|| crate::root::root().join("assets"));
    for sample in &SAMPLES {
        if order.names.is_empty() || order.names.iter().any(|name| name == sample.name) {
            make(&folder, sample.name, sample.make)?;
        }
    }
    Ok(())
}

/// Makes one mesh and writes it.
fn make(folder: &Path, name: &str, mesh: impl Fn() -> Result<Mesh, String>) -> Result<(), String> {
    let started = Instant::now();
    let mesh = mesh().map_err(|why| format!("The sample {name} can't be made at this size: {why}; try another."))?;
    let path = folder.join(format!("{name}.glb"));
    let bytes = glb::write(&mesh, name);
    std::fs::create_dir_all(folder)
        .and_then(|()| std::fs::write(&path, &bytes))
        .map_err(|e| format!("{} can't be written: {e}.", path.display()))?;
    println!(
        "{}: {} vertices, {} triangles, {} KiB, {:.1} s",
        path.display(),
        mesh.positions.len(),
        mesh.triangles.len(),
        bytes.len() / 1024,
        started.elapsed().as_secs_f64()
    );
    Ok(())
}
