//! Intrinsic mollification [SC20, section 4.5]: edges made longer if a triangle is too flat for cotangents.

use crate::Remedy;

/// The excess of two edges of a triangle over the third after mollification, in units of the longest.
const MOLLIFICATION: f64 = 1e-5;

/// A triangle's edge lengths with which its cotangents are computed: its own, or all longer by the same length if it is
/// too flat.
pub fn mollified_lengths(lengths: [f64; 3]) -> [f64; 3] {
    let lack = lack(lengths).max(0.0);
    lengths.map(|length| length + lack)
}

/// The increase of each edge of a triangle with which any two exceed the third by 1e-5 of the longest; negative if they
/// already do.
pub(crate) fn lack(lengths: [f64; 3]) -> f64 {
    let sum = lengths[0] + lengths[1] + lengths[2];
    let longest = lengths[0].max(lengths[1]).max(lengths[2]);
    MOLLIFICATION * longest - (sum - 2.0 * longest)
}

/// The sentence about triangles too flat for cotangents.
pub(crate) fn repairs(mollified_faces: usize) -> Option<String> {
    let space = Remedy::OfSpace;
    let done = match mollified_faces {
        0 => return None,
        1 => "1 degenerate triangle was given the smallest safe shape".to_owned(),
        count => format!("{count} degenerate triangles were given the smallest safe shape"),
    };
    Some(format!(
        "{done}: if they bend badly, take {space}, which needs no triangles"
    ))
}
