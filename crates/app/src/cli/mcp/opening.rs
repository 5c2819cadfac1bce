//! Files and selections: `info`, `open`, `close`, `select`.

use std::path::PathBuf;

use glam::DVec3;
use pliant_editor::EditError;
use pliant_engine::watch::Watch;
use pliant_engine::{EngineError, Given, inspect};
use pliant_mesh::{Bounds, SurfaceVertex, WeldOptions, bounding_box};
use serde::Deserialize;
use serde_json::{Value, json};

use super::answer::Answer;
use super::models::{Models, Opened};

/// The most ranges of vertices that `select` lists.
const LISTED_RANGES: usize = 100;

/// The arguments of `info` and `open`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct File {
    file: PathBuf,
    weld: Option<f64>,
}

impl File {
    fn weld(&self) -> Result<WeldOptions, EngineError> {
        match self.weld {
            Some(distance) if !distance.is_finite() || distance < 0.0 => Err(EngineError::Arguments(format!(
                "weld is {distance}: a distance is a number from 0"
            ))),
            distance => Ok(WeldOptions { distance }),
        }
    }
}

/// The argument of `close`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Named {
    model: String,
}

/// The arguments of `select`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Select {
    model: String,
    selector: Value,
}

/// Lists a file's contents and its mesh's faults.
pub fn info(_: &mut Models, file: File, watch: &Watch) -> Result<Answer, EngineError> {
    Ok(Answer::json(&inspect(&file.file, file.weld()?, watch)?.to_json()))
}

/// Opens a file.
pub fn open(models: &mut Models, file: File, watch: &Watch) -> Result<Answer, EngineError> {
    models.check_room()?;
    let weld = file.weld()?;
    let loaded = pliant_engine::load(&file.file, &weld, watch)?;
    pliant_engine::check_not_empty(&file.file, &loaded.model)?;
    let model = std::sync::Arc::clone(&loaded.model);
    let notes = loaded.scene.notes().to_vec();
    let name = models.add(Opened {
        loaded,
        weld,
        watch: watch.clone(),
        bent: None,
    });
    let components = model.topology.components();
    Ok(Answer::json(&json!({
        "model": name,
        "vertices": model.drawn.file_vertex_count(),
        "welded_vertices": model.surface.positions.len(),
        "triangles": model.surface.triangles.len(),
        "bounding_box": model.bounds().map(box_of),
        "components": components.len(),
        "notes": notes,
    })))
}

/// Closes a model.
pub fn close(models: &mut Models, named: Named, _: &Watch) -> Result<Answer, EngineError> {
    models.remove(&named.model)?;
    Ok(Answer::text(format!("{} is closed", named.model)))
}

/// Describes the vertices that a selector selects.
pub fn select(models: &mut Models, given: Select, watch: &Watch) -> Result<Answer, EngineError> {
    let opened = models.get(&given.model)?;
    let model = &opened.loaded.model;
    let selector = Given::Contents(given.selector, "selector").selector(watch)?;
    let selection = selector.evaluate(model).map_err(refused)?;
    let vertices: Vec<SurfaceVertex> = selection.iter().collect();
    let positions: Vec<DVec3> = vertices
        .iter()
        .map(|vertex| model.surface.positions[vertex.index()])
        .collect();
    let mean = positions.iter().sum::<DVec3>() / positions.len().max(1) as f64;
    let file_vertices = model.first_file_vertices();
    let mut numbers: Vec<u32> = vertices.iter().map(|vertex| file_vertices[vertex.index()].0).collect();
    numbers.sort_unstable();
    let ranges = ranges(&numbers);
    Ok(Answer::json(&json!({
        "selected": vertices.len(),
        "of": model.surface.positions.len(),
        "mean": (!positions.is_empty()).then(|| mean.to_array()),
        "bounding_box": bounding_box(&positions).map(box_of),
        "ranges": &ranges[..ranges.len().min(LISTED_RANGES)],
        "more_ranges": ranges.len().saturating_sub(LISTED_RANGES),
    })))
}

fn refused(source: EditError) -> EngineError {
    EngineError::Edit {
        edit: "selector".into(),
        source,
    }
}

fn box_of(bounds: Bounds) -> Value {
    json!({ "min": bounds.min.to_array(), "max": bounds.max.to_array() })
}

/// Ascending numbers as ranges, both ends included.
fn ranges(numbers: &[u32]) -> Vec<[u32; 2]> {
    let mut ranges: Vec<[u32; 2]> = Vec::new();
    for &number in numbers {
        match ranges.last_mut() {
            Some([_, last]) if number <= last.saturating_add(1) => *last = number,
            _ => ranges.push([number, number]),
        }
    }
    ranges
}
