//! Each handle's target in world space: a transform from rest, or a position for each of its vertices.

use glam::{DAffine3, DMat3, DVec3};
use pliant_deform::Method;
use pliant_editor::{EDIT_VERSION, EditFile, HandleTransform, Setup};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyTuple};
use serde_json::json;

use crate::arrays::{points, reals};
use crate::refusal::refused;
use crate::values::value;

/// A handle's target.
#[derive(Debug)]
pub enum Goal {
    /// A map of world positions, from rest.
    Map(DAffine3),
    /// A position for each of the handle's vertices.
    Rows(Vec<DVec3>),
}

/// A goal for each handle of the setup, from an array, a list, a goal for the only handle, or a dict by names. A handle
/// that a dict does not name is at rest. `vertex_count` gives the number of rows of a handle's positions.
///
/// # Errors
/// `ValueError` naming the handle.
pub fn goals(
    any: &Bound<'_, PyAny>,
    setup: &Setup,
    vertex_count: impl Fn(usize) -> Option<usize>,
) -> PyResult<Vec<Goal>> {
    let handles = &setup.handles;
    let pivot = |handle: usize| handles[handle].pivot;
    if let Ok(by_name) = any.cast::<PyDict>()
        && !is_transform(by_name)?
    {
        let mut all: Vec<Goal> = handles.iter().map(|_| Goal::Map(DAffine3::IDENTITY)).collect();
        for (name, own) in by_name {
            let name: String = name
                .extract()
                .map_err(|_| refused(format!("transforms has the key {name}: a handle's name is a string")))?;
            let Some(handle) = handles.iter().position(|handle| handle.name == name) else {
                let known: Vec<String> = handles.iter().map(|handle| format!("{:?}", handle.name)).collect();
                return Err(refused(format!(
                    "transforms names the unknown handle {name:?}: known are {}",
                    known.join(", ")
                )));
            };
            all[handle] = goal(&own, &format!("transforms[{name:?}]"), pivot(handle))?;
        }
        return Ok(all);
    }
    let is_dict = any.is_instance_of::<PyDict>() || is_rotation_and_translation(any)?;
    if handles.len() == 1 && (is_dict || stands_alone(any, || vertex_count(0))?) {
        return Ok(vec![goal(any, "transforms", pivot(0))?]);
    }
    let each: Vec<Bound<'_, PyAny>> = any
        .try_iter()
        .map_err(|_| refused("transforms must be an array, a list or a dict: give one 4×4 matrix for each handle"))?
        .collect::<PyResult<_>>()?;
    if each.len() != handles.len() || is_dict {
        return Err(refused(format!(
            "transforms has {} entries, but there are {} handles: give one 4×4 matrix for each",
            if is_dict { 1 } else { each.len() },
            handles.len()
        )));
    }
    let each = each.iter().enumerate();
    each.map(|(handle, own)| goal(own, &format!("transforms[{handle}]"), pivot(handle)))
        .collect()
}

/// Whether a value is the only handle's goal, and not a list of one goal.
fn stands_alone(any: &Bound<'_, PyAny>, vertex_count: impl Fn() -> Option<usize>) -> PyResult<bool> {
    let Ok((shape, _)) = reals(any, "") else {
        return Ok(false);
    };
    if shape == [1, 3] && any.is_instance_of::<PyList>() && vertex_count() == Some(1) {
        return Err(refused(
            "transforms is one row of three numbers, for a handle of one vertex: give {name: [[x, y, z]]} for its position, \
             or {name: [x, y, z]} for a translation",
        ));
    }
    Ok(match shape[..] {
        [1, 3] => vertex_count() == Some(1),
        [_, 3] | [3] | [3, 1] | [3, 4] | [4, 4] => true,
        _ => false,
    })
}

/// Whether a dict is a transform of the edit format rather than goals by name.
fn is_transform(dict: &Bound<'_, PyDict>) -> PyResult<bool> {
    for member in ["translation", "rotation", "scale", "pivot", "matrix"] {
        if dict.contains(member)? {
            let is_nested = dict.get_item(member)?.is_some_and(|own| is_whole(&own));
            return Ok(!is_nested);
        }
    }
    Ok(false)
}

/// Returns true if a value could be a handle's whole goal, for a handle that is called like a transform's member.
fn is_whole(any: &Bound<'_, PyAny>) -> bool {
    let is_array = || reals(any, "").is_ok_and(|(shape, _)| matches!(shape[..], [_, 3] | [3, 4] | [4, 4]));
    any.is_instance_of::<PyDict>() || is_array()
}

/// A pair of a 3×3 matrix and a vector.
fn is_rotation_and_translation(any: &Bound<'_, PyAny>) -> PyResult<bool> {
    Ok(any.cast::<PyTuple>().is_ok_and(|pair| {
        let shapes = pair.iter().map(|part| reals(&part, "").map(|(shape, _)| shape));
        let shapes: Vec<Vec<usize>> = shapes.filter_map(Result::ok).collect();
        matches!(&shapes[..], [rotation, translation] if *rotation == [3, 3] && is_vector(translation))
    }))
}

/// A flat vector, or a column.
fn is_vector(shape: &[usize]) -> bool {
    matches!(shape, [3] | [3, 1])
}

fn goal(any: &Bound<'_, PyAny>, place: &str, pivot: DVec3) -> PyResult<Goal> {
    if any.is_instance_of::<PyDict>() {
        return of_format(any, place, pivot).map(Goal::Map);
    }
    let map = if is_rotation_and_translation(any)? {
        let (_, rotation) = reals(&any.get_item(0)?, place)?;
        let (_, translation) = reals(&any.get_item(1)?, place)?;
        affine(|row, column| rotation[3 * row + column], &translation)
    } else {
        let unknown = |found: &str| {
            refused(format!(
                "{place} is not a transform{found}: give a 3×4 or 4×4 matrix, a translation, a pair of a 3×3 matrix \
                 and a translation, a dict, or a position for each of the handle's vertices"
            ))
        };
        let Ok((shape, numbers)) = reals(any, place) else {
            return Err(unknown(""));
        };
        match shape[..] {
            [3] | [3, 1] => DAffine3::from_translation(DVec3::from_slice(&numbers)),
            [_, 3] => return points(any, place).map(Goal::Rows),
            [3 | 4, 4] => of_matrix(&numbers, place)?,
            _ => return Err(unknown(&format!(" (an array of the shape {shape:?})"))),
        }
    };
    if !HandleTransform::Matrix(map).can_be_undone() {
        return Err(refused(format!(
            "{place} is not finite or flattens the handle: give one whose first three columns point in independent \
             directions"
        )));
    }
    Ok(Goal::Map(map))
}

/// The map of a matrix of four columns, row by row. A fourth row has no effect.
fn of_matrix(matrix: &[f64], place: &str) -> PyResult<DAffine3> {
    if matrix.len() > 12 && matrix[12..] != [0.0, 0.0, 0.0, 1.0] {
        return Err(refused(format!(
            "{place} has the last row {:?}: give a matrix whose last row is 0, 0, 0, 1",
            &matrix[12..]
        )));
    }
    Ok(affine(
        |row, column| matrix[4 * row + column],
        &[matrix[3], matrix[7], matrix[11]],
    ))
}

fn affine(entry: impl Fn(usize, usize) -> f64, translation: &[f64]) -> DAffine3 {
    let column = |column| DVec3::new(entry(0, column), entry(1, column), entry(2, column));
    DAffine3 {
        matrix3: DMat3::from_cols(column(0), column(1), column(2)),
        translation: DVec3::from_slice(translation),
    }
}

/// A transform in the edit format.
fn of_format(any: &Bound<'_, PyAny>, place: &str, pivot: DVec3) -> PyResult<DAffine3> {
    let edit = json!({
        "version": EDIT_VERSION,
        "method": { "name": Method::default().name() },
        "handles": [{ "select": "none", "transform": value(any, place)? }],
    });
    let edit = EditFile::from_value(&edit)
        .map_err(|error| refused(error.to_string().replacen("handles[0].transform", place, 1)))?;
    let transform = edit.handles.first().map(|handle| handle.transform).unwrap_or_default();
    Ok(transform.affine(pivot))
}
