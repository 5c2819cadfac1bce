//! The handles' transforms: where each is to go, from rest, in world space.

use glam::{DAffine3, DMat3, DVec3};
use pliant_editor::{EDIT_VERSION, EditFile, HandleTransform, Setup};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use serde_json::json;

use crate::arrays::reals;
use crate::refusal::refused;
use crate::values::value;

/// One for each handle of the setup: an array of the shape `[handles, 4, 4]`, a list, one transform for the only
/// handle, or a dict by names. A handle that a dict does not name is at rest.
///
/// # Errors
/// `ValueError` naming the handle.
pub fn transforms(any: &Bound<'_, PyAny>, setup: &Setup) -> PyResult<Vec<DAffine3>> {
    let handles = &setup.handles;
    let pivot = |handle: usize| handles[handle].pivot;
    if let Ok(by_name) = any.cast::<PyDict>()
        && !is_transform(by_name)?
    {
        let mut all = vec![DAffine3::IDENTITY; handles.len()];
        for (name, own) in by_name {
            let name: String = name
                .extract()
                .map_err(|_| refused(format!("transforms has the key {name}: a handle's name is a string")))?;
            let Some(handle) = handles.iter().position(|handle| handle.name == name) else {
                let known: Vec<String> = handles.iter().map(|handle| format!("{:?}", handle.name)).collect();
                return Err(refused(format!(
                    "transforms names the handle {name:?}, which there is not: known are {}",
                    known.join(", ")
                )));
            };
            all[handle] = transform(&own, &format!("transforms[{name:?}]"), pivot(handle))?;
        }
        return Ok(all);
    }
    let is_one = any.is_instance_of::<PyDict>() || is_rotation_and_translation(any)?;
    if handles.len() == 1 && (is_one || matrix_of(any).is_some()) {
        return Ok(vec![transform(any, "transforms", pivot(0))?]);
    }
    let each: Vec<Bound<'_, PyAny>> = any
        .try_iter()
        .map_err(|_| refused("transforms must be an array, a list or a dict: give one 4×4 matrix for each handle"))?
        .collect::<PyResult<_>>()?;
    if each.len() != handles.len() || is_one {
        return Err(refused(format!(
            "transforms has {} entries, but there are {} handles: give one 4×4 matrix for each",
            if is_one { 1 } else { each.len() },
            handles.len()
        )));
    }
    let each = each.iter().enumerate();
    each.map(|(handle, own)| transform(own, &format!("transforms[{handle}]"), pivot(handle)))
        .collect()
}

/// Whether a dict is a transform of the edit format rather than transforms by name.
fn is_transform(dict: &Bound<'_, PyDict>) -> PyResult<bool> {
    for member in ["translation", "rotation", "scale", "pivot", "matrix"] {
        if dict.contains(member)? {
            let is_nested = dict.get_item(member)?.is_some_and(|own| is_transform_like(&own));
            return Ok(!is_nested);
        }
    }
    Ok(false)
}

/// Whether a value could be a handle's whole transform, for a handle that is called like a transform's member.
fn is_transform_like(any: &Bound<'_, PyAny>) -> bool {
    any.is_instance_of::<PyDict>() || matrix_of(any).is_some()
}

/// A pair of a 3×3 matrix and a vector.
fn is_rotation_and_translation(any: &Bound<'_, PyAny>) -> PyResult<bool> {
    Ok(any.cast::<PyTuple>().is_ok_and(|pair| {
        let shapes = pair.iter().map(|part| reals(&part, "").map(|(shape, _)| shape));
        let shapes: Vec<Vec<usize>> = shapes.filter_map(Result::ok).collect();
        shapes == [vec![3, 3], vec![3]]
    }))
}

fn matrix_of(any: &Bound<'_, PyAny>) -> Option<Vec<f64>> {
    let (shape, numbers) = reals(any, "").ok()?;
    (shape == [4, 4]).then_some(numbers)
}

fn transform(any: &Bound<'_, PyAny>, place: &str, pivot: DVec3) -> PyResult<DAffine3> {
    if any.is_instance_of::<PyDict>() {
        return of_format(any, place, pivot);
    }
    let affine = if is_rotation_and_translation(any)? {
        let (_, rotation) = reals(&any.get_item(0)?, place)?;
        let (_, translation) = reals(&any.get_item(1)?, place)?;
        affine(|row, column| rotation[3 * row + column], &translation)
    } else {
        let Some(matrix) = matrix_of(any) else {
            return Err(refused(format!(
                "{place} is no transform: give a 4×4 matrix, a pair of a 3×3 matrix and a translation, or a dict"
            )));
        };
        if matrix[12..] != [0.0, 0.0, 0.0, 1.0] {
            return Err(refused(format!(
                "{place} has the last row {:?}: give a matrix whose last row is 0, 0, 0, 1",
                &matrix[12..]
            )));
        }
        affine(
            |row, column| matrix[4 * row + column],
            &[matrix[3], matrix[7], matrix[11]],
        )
    };
    if !HandleTransform::Matrix(affine).can_be_undone() {
        return Err(refused(format!(
            "{place} is not finite or flattens the handle: give one whose first three columns point in independent \
             directions"
        )));
    }
    Ok(affine)
}

fn affine(entry: impl Fn(usize, usize) -> f64, translation: &[f64]) -> DAffine3 {
    let column = |column| DVec3::new(entry(0, column), entry(1, column), entry(2, column));
    DAffine3 {
        matrix3: DMat3::from_cols(column(0), column(1), column(2)),
        translation: DVec3::from_slice(translation),
    }
}

/// A transform as the edit format has it.
fn of_format(any: &Bound<'_, PyAny>, place: &str, pivot: DVec3) -> PyResult<DAffine3> {
    let edit = json!({
        "version": EDIT_VERSION,
        "method": { "name": "bilaplacian" },
        "handles": [{ "select": "none", "transform": value(any, place)? }],
    });
    let edit = EditFile::from_value(&edit)
        .map_err(|error| refused(error.to_string().replacen("handles[0].transform", place, 1)))?;
    let transform = edit.handles.first().map(|handle| handle.transform).unwrap_or_default();
    Ok(transform.affine(pivot))
}
