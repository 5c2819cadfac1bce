//! Parts that are turned inside out: the winding of their faces and their normals are reversed.
//!
//! A face keeps its first corner and takes the others in reverse, so that turning it again gives it back.

use pliant_mesh::DrawnVertex;

/// A face's corners, with reversed winding.
pub(crate) fn wound_back<T>(corners: &[T]) -> impl Iterator<Item = &T> {
    let (first, others) = corners.split_at(corners.len().min(1));
    first.iter().chain(others.iter().rev())
}

/// A triangle, with reversed winding.
pub(crate) fn triangle_wound_back([a, b, c]: [DrawnVertex; 3]) -> [DrawnVertex; 3] {
    [a, c, b]
}

/// Appends a number's text with the opposite sign. Digits stay, so that turning it again restores it.
pub(crate) fn push_negated(number: &[u8], out: &mut Vec<u8>) {
    match number.first() {
        Some(b'-') => out.extend_from_slice(&number[1..]),
        Some(b'+') => {
            out.push(b'-');
            out.extend_from_slice(&number[1..]);
        }
        _ => {
            out.push(b'-');
            out.extend_from_slice(number);
        }
    }
}
