//! numpy's arrays in and out. Arrays of the right type are read and written without a copy.

use bytemuck::{cast_slice, cast_vec};
use glam::DVec3;
use numpy::ndarray::ArrayView2;
use numpy::prelude::*;
use numpy::{Element, PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2, PyReadwriteArray2};
use pliant_mesh::DrawnVertex;
use pyo3::prelude::*;

use crate::refusal::refused;

/// Any value that numpy can make an array of, as an array.
///
/// # Errors
/// `ValueError` naming `place`, for any other value.
pub fn array<'py>(any: &Bound<'py, PyAny>, place: &str) -> PyResult<Bound<'py, PyAny>> {
    let array = any.py().import("numpy")?.call_method1("asarray", (any,));
    array.map_err(|error| {
        refused(format!(
            "{place} is not an array ({}): give numbers",
            error.value(any.py())
        ))
    })
}

/// The kind of an array's elements, numpy's `dtype.kind`.
pub fn kind(array: &Bound<'_, PyAny>) -> PyResult<char> {
    array.getattr("dtype")?.getattr("kind")?.extract()
}

fn shape(array: &Bound<'_, PyAny>) -> PyResult<Vec<usize>> {
    array.getattr("shape")?.extract()
}

/// The array with elements of the type `name`; the same array if it already has them.
fn of_type<'py>(array: &Bound<'py, PyAny>, name: &str) -> PyResult<Bound<'py, PyAny>> {
    let options = pyo3::types::PyDict::new(array.py());
    options.set_item("copy", false)?;
    array.call_method("astype", (name,), Some(&options))
}

/// An array of the shape `[n, 3]` of real numbers.
///
/// # Errors
/// `ValueError` naming `place`, for another shape or other elements.
pub fn points(any: &Bound<'_, PyAny>, place: &str) -> PyResult<Vec<DVec3>> {
    let array = array(any, place)?;
    check(&array, place, 3, "fiu", "numbers")?;
    if let Ok(single) = array.extract::<PyReadonlyArray2<'_, f32>>() {
        return Ok(rows(single.as_array(), f64::from));
    }
    let array = of_type(&array, "float64")?;
    let double: PyReadonlyArray2<'_, f64> = array.extract()?;
    // `as_slice` also succeeds for an array in column order.
    match double.as_slice() {
        Ok(numbers) if double.is_c_contiguous() => Ok(cast_slice::<f64, DVec3>(numbers).to_vec()),
        _ => Ok(rows(double.as_array(), |number| number)),
    }
}

fn rows<T: Copy>(array: ArrayView2<'_, T>, number: impl Fn(T) -> f64) -> Vec<DVec3> {
    let rows = array.rows().into_iter();
    rows.map(|row| DVec3::new(number(row[0]), number(row[1]), number(row[2])))
        .collect()
}

/// An array of the shape `[m, 3]` of numbers below `vertex_count`. Without triangles it may have any shape.
///
/// # Errors
/// `ValueError` naming `place`, for another shape, other elements, or a number that no vertex has.
pub fn triangles(any: &Bound<'_, PyAny>, place: &str, vertex_count: usize) -> PyResult<Vec<[DrawnVertex; 3]>> {
    let array = array(any, place)?;
    if shape(&array)?.contains(&0) {
        return Ok(Vec::new());
    }
    check(&array, place, 3, "iu", "whole numbers")?;
    let array = of_type(&array, "int64")?;
    let numbers: PyReadonlyArray2<'_, i64> = array.extract()?;
    let numbers = numbers.as_array();
    let mut triangles = Vec::with_capacity(numbers.nrows());
    for (place_in, row) in numbers.rows().into_iter().enumerate() {
        let corner = |k: usize| {
            let known = u32::try_from(row[k]).ok().filter(|v| (*v as usize) < vertex_count);
            known.map(DrawnVertex).ok_or_else(|| {
                refused(format!(
                    "{place}[{place_in}] names vertex {}, but there are {vertex_count} vertices: use numbers from 0 to {}",
                    row[k],
                    vertex_count.saturating_sub(1)
                ))
            })
        };
        triangles.push([corner(0)?, corner(1)?, corner(2)?]);
    }
    Ok(triangles)
}

fn check(array: &Bound<'_, PyAny>, place: &str, columns: usize, kinds: &str, what: &str) -> PyResult<()> {
    let shape = shape(array)?;
    let is_of_kind = kinds.contains(kind(array)?);
    if shape.len() == 2 && shape[1] == columns && is_of_kind {
        return Ok(());
    }
    let dtype = array.getattr("dtype")?;
    Err(refused(format!(
        "{place} is an array of the shape {shape:?} and type {dtype}: give {what} in the shape [n, {columns}]"
    )))
}

/// A sentence on positions that are not finite, if there are any: the parts that use them can't be solved.
pub fn not_finite(positions: &[DVec3], place: &str) -> Option<String> {
    let mut rows = (0..).zip(positions).filter(|(_, position)| !position.is_finite());
    let (first, DVec3 { x, y, z }) = rows.next()?;
    let stays = match 1 + rows.count() {
        1 => ": it stays as it is, without the triangles that use it".to_owned(),
        count => {
            format!(", the first of {count} such rows: they stay as they are, without the triangles that use them")
        }
    };
    Some(format!("{place}[{first}] is not finite ({x}, {y}, {z}){stays}"))
}

/// Refuses positions that are not finite.
///
/// # Errors
/// `ValueError` naming `place` and the first such row.
pub fn check_finite(positions: &[DVec3], place: &str) -> PyResult<()> {
    match positions.iter().position(|position| !position.is_finite()) {
        None => Ok(()),
        Some(row) => {
            let DVec3 { x, y, z } = positions[row];
            Err(refused(format!(
                "{place}[{row}] is not finite ({x}, {y}, {z}): give finite positions"
            )))
        }
    }
}

/// An array of the shape `[p, 2]` of whole numbers.
///
/// # Errors
/// `ValueError` naming `place`, for another shape or other elements.
pub fn pairs(any: &Bound<'_, PyAny>, place: &str) -> PyResult<Vec<[i64; 2]>> {
    let array = array(any, place)?;
    if shape(&array)?.contains(&0) {
        return Ok(Vec::new());
    }
    check(&array, place, 2, "iu", "whole numbers")?;
    let array = of_type(&array, "int64")?;
    let numbers: PyReadonlyArray2<'_, i64> = array.extract()?;
    let rows = numbers.as_array();
    Ok(rows.rows().into_iter().map(|row| [row[0], row[1]]).collect())
}

/// Numbers of vertices in the given order: from a flat array of them, or from a mask of `vertex_count` switches.
///
/// Whole numbers are also a mask if there is one for each vertex and all are 0 or 1: as numbers of vertices they would
/// name two vertices again and again. For up to two vertices they are numbers.
///
/// # Errors
/// `ValueError` naming `place`.
pub fn numbers(any: &Bound<'_, PyAny>, place: &str, vertex_count: usize) -> PyResult<Vec<i64>> {
    let array = array(any, place)?;
    let shape = shape(&array)?;
    if shape == [0] {
        return Ok(Vec::new());
    }
    match (&shape[..], kind(&array)?) {
        ([length], 'b') if *length == vertex_count => {
            let mask: PyReadonlyArray1<'_, bool> = array.extract()?;
            let mask = mask.as_array();
            let selected = mask.iter().zip(0..).filter(|(is, _)| **is);
            Ok(selected.map(|(_, number)| number).collect())
        }
        ([length], 'b') => Err(refused(format!(
            "{place} is a mask of {length} values, but there are {vertex_count} vertices: give one value for each"
        ))),
        ([_], 'i' | 'u') => {
            let array = of_type(&array, "int64")?;
            let numbers: PyReadonlyArray1<'_, i64> = array.extract()?;
            let numbers = numbers.as_array();
            let is_mask =
                numbers.len() == vertex_count && vertex_count > 2 && numbers.iter().all(|n| matches!(n, 0 | 1));
            if is_mask {
                let selected = numbers.iter().zip(0..).filter(|(is, _)| **is == 1);
                return Ok(selected.map(|(_, number)| number).collect());
            }
            Ok(numbers.to_vec())
        }
        _ => Err(refused(format!(
            "{place} is an array of the shape {shape:?} and type {}: give numbers of vertices, a mask, or a selector",
            array.getattr("dtype")?
        ))),
    }
}

/// Returns true if a flat list or array has names among its elements, such as "rigid".
pub fn has_names(any: &Bound<'_, PyAny>) -> PyResult<bool> {
    let array = array(any, "")?;
    Ok("UO".contains(kind(&array)?) && shape(&array)?.len() == 1)
}

/// Real numbers in any shape, in C order, and the shape.
///
/// # Errors
/// `ValueError` naming `place`, for other elements.
pub fn reals(any: &Bound<'_, PyAny>, place: &str) -> PyResult<(Vec<usize>, Vec<f64>)> {
    let array = array(any, place)?;
    if !"fiu".contains(kind(&array)?) {
        return Err(refused(format!(
            "{place} is of the type {}: give numbers",
            array.getattr("dtype")?
        )));
    }
    let flat = of_type(&array, "float64")?.call_method0("ravel")?;
    let flat: PyReadonlyArray1<'_, f64> = flat.extract()?;
    Ok((shape(&array)?, flat.as_array().to_vec()))
}

/// Rows of four numbers as a new array of the shape (n, 4).
///
/// # Errors
/// Python's own.
pub fn of_colours(py: Python<'_>, colours: Vec<[f64; 4]>) -> PyResult<Bound<'_, PyArray2<f64>>> {
    let count = colours.len();
    PyArray1::from_vec(py, cast_vec::<[f64; 4], f64>(colours)).reshape([count, 4])
}

/// Points as an array of the shape `[n, 3]`, without a copy.
///
/// # Errors
/// If numpy is missing.
pub fn of_points(py: Python<'_>, points: Vec<DVec3>) -> PyResult<Bound<'_, PyArray2<f64>>> {
    let count = points.len();
    PyArray1::from_vec(py, cast_vec::<DVec3, f64>(points)).reshape([count, 3])
}

/// Triangles as an array of the shape `[m, 3]`.
///
/// # Errors
/// If numpy is missing.
pub fn of_triangles<'py>(py: Python<'py>, triangles: &[[DrawnVertex; 3]]) -> PyResult<Bound<'py, PyArray2<u32>>> {
    let corners: Vec<u32> = triangles.iter().flatten().map(|vertex| vertex.0).collect();
    PyArray1::from_vec(py, corners).reshape([triangles.len(), 3])
}

/// Writes points into an existing array of the shape `[n, 3]`, of f64 or f32.
///
/// # Errors
/// `ValueError` for another shape or type, or an array that can't be written to.
pub fn write(points: &[DVec3], out: &Bound<'_, PyAny>) -> PyResult<()> {
    let fits = if let Ok(double) = out.extract::<PyReadwriteArray2<'_, f64>>() {
        fill(points, double, |number| number)
    } else if let Ok(single) = out.extract::<PyReadwriteArray2<'_, f32>>() {
        fill(points, single, |number| number as f32)
    } else {
        false
    };
    if fits {
        return Ok(());
    }
    Err(refused(format!(
        "out must be a writable array of float64 or float32 in the shape [{}, 3]",
        points.len()
    )))
}

/// Writes the points into the array if it has their shape; returns whether it has.
fn fill<T: Element + Copy>(points: &[DVec3], mut out: PyReadwriteArray2<'_, T>, number: impl Fn(f64) -> T) -> bool {
    let mut out = out.as_array_mut();
    if out.dim() != (points.len(), 3) {
        return false;
    }
    for (mut row, point) in out.rows_mut().into_iter().zip(points) {
        for (to, from) in row.iter_mut().zip(point.to_array()) {
            *to = number(from);
        }
    }
    true
}
