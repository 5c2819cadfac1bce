//! Puts a pose of one mesh onto another, like `pliant transfer`.

use glam::DVec3;
use pliant_deform::PosedShape;
use pliant_engine::examples::positions_in_pose;
use pliant_engine::watch::Watch;
use pliant_engine::{EngineError, transferred};
use pliant_mesh::{Cancel, Drawn};
use pyo3::prelude::*;

use crate::arrays;
use crate::interruptible::interruptible;
use crate::mesh::Mesh;
use crate::refusal::{of_engine, refused};
use crate::shape::shape;
use crate::warned::warn;

#[doc = include_str!(concat!(env!("OUT_DIR"), "/transfer.txt"))]
#[pyfunction]
#[pyo3(signature = (source, pose, target, *, correspondences=None))]
pub fn transfer<'py>(
    py: Python<'py>,
    source: &Bound<'py, PyAny>,
    pose: &Bound<'py, PyAny>,
    target: &Bound<'py, PyAny>,
    correspondences: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let rest = shape(source, "source")?;
    let to = shape(target, "target")?;
    let own = rest.drawn();
    let posed = posed(source, pose, &own)?;
    let triangle_count = to.triangle_count();
    let partners = match correspondences {
        Some(pairs) => partners(pairs, own.triangles.len(), triangle_count)?,
        None if to.drawn().triangles == own.triangles => (0..triangle_count).map(Some).collect(),
        None => {
            return Err(refused(format!(
                "target has {triangle_count} triangles and source has {} different ones: give correspondences, pairs \
                 of a triangle of source and one of target",
                own.triangles.len()
            )));
        }
    };
    let bend = |cancel: &Cancel| {
        let model = to.model(cancel)?;
        let triangles: Vec<[usize; 3]> = own.triangles.iter().map(|own| own.map(|v| v.index())).collect();
        let posed = PosedShape {
            rest: &own.positions,
            posed: &posed,
            triangles: &triangles,
        };
        transferred(
            to.origin().name(),
            &model,
            &posed,
            &partners,
            &Watch::cancelled_by(cancel),
        )
        .map_err(|error| of_engine(&error))
    };
    let (positions, warnings) = interruptible(py, |pool, cancel| pool.install(|| bend(cancel)))??;
    warn(py, &warnings)?;
    Ok(arrays::of_points(py, positions)?.into_any())
}

/// The positions of the source's vertices in the pose.
fn posed(source: &Bound<'_, PyAny>, pose: &Bound<'_, PyAny>, own: &Drawn) -> PyResult<Vec<DVec3>> {
    let Ok(pose_mesh) = pose.cast::<Mesh>() else {
        let positions = arrays::points(pose, "pose")?;
        if positions.len() != own.positions.len() {
            return Err(refused(format!(
                "pose has {} rows, but source has {} vertices: give a row for each",
                positions.len(),
                own.positions.len()
            )));
        }
        arrays::check_finite(&positions, "pose")?;
        return Ok(positions);
    };
    let in_pose = pose_mesh.get().loaded();
    let drawn = in_pose.model.rest();
    let found = match source.cast::<Mesh>() {
        Ok(source) => {
            let source = source.get().loaded();
            positions_in_pose(
                (&in_pose.path, &in_pose.scene, &drawn),
                (&source.path, &source.scene, own),
            )
        }
        Err(_) if drawn.positions.len() == own.positions.len() => return Ok(drawn.positions),
        Err(_) => Err(EngineError::Unsupported(format!(
            "pose has {} vertices, but source has {}: give a pose of the same vertices",
            drawn.positions.len(),
            own.positions.len()
        ))),
    };
    found.map_err(|error| of_engine(&error))
}

/// The source's triangle for each triangle of the target.
fn partners(pairs: &Bound<'_, PyAny>, sources: usize, targets: usize) -> PyResult<Vec<Option<usize>>> {
    let mut partners = vec![None; targets];
    let pairs = arrays::pairs(pairs, "correspondences")?;
    if pairs.is_empty() {
        return Err(refused("correspondences is empty: name at least one pair"));
    }
    for (row, [source, target]) in pairs.into_iter().enumerate() {
        let below = |number: i64, count: usize| usize::try_from(number).ok().filter(|number| *number < count);
        let (Some(source), Some(partner)) = (
            below(source, sources),
            below(target, targets).map(|at| &mut partners[at]),
        ) else {
            return Err(refused(format!(
                "correspondences[{row}] is [{source}, {target}], but source has {sources} triangles and target \
                 {targets}: number them from 0"
            )));
        };
        if partner.replace(source).is_some() {
            return Err(refused(format!(
                "correspondences[{row}] names target's triangle {target} again: name it once"
            )));
        }
    }
    Ok(partners)
}
