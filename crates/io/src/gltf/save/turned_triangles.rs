//! The triangles of parts that are turned inside out, by the primitives that store them.

use std::collections::BTreeMap;

use crate::gltf::geometry::Pieces;
use crate::save::moved::Moved;
use crate::save::turned::triangle_wound_back;

/// The triangles of a primitive, some of them with reversed winding: elements of its attributes.
pub(crate) type Turned = BTreeMap<(usize, usize), Vec<[u32; 3]>>;

/// For each mesh and primitive with turned triangles, all its triangles. Nodes that show the same mesh turn the same
/// triangles.
pub(crate) fn turned(pieces: &Pieces, moved: &Moved<'_>) -> Turned {
    let mut turned = Turned::new();
    if !moved.turns_any() {
        return turned;
    }
    for piece in &pieces.pieces {
        let instance = &pieces.instances[piece.instance];
        let triangles = &moved.drawn.triangles[piece.triangles.start as usize..piece.triangles.end as usize];
        let key = (instance.mesh, piece.primitive);
        if turned.contains_key(&key) || !triangles.iter().any(|&[first, ..]| moved.turns(first)) {
            continue;
        }
        let is_mirrored = instance.pose.is_mirrored();
        let stored = triangles.iter().map(|&triangle| {
            // A mirrored node reverses the stored winding.
            let is_as_drawn = is_mirrored == moved.turns(triangle[0]);
            let triangle = if is_as_drawn {
                triangle
            } else {
                triangle_wound_back(triangle)
            };
            triangle.map(|vertex| vertex.0 - instance.vertices.start)
        });
        turned.insert(key, stored.collect());
    }
    turned
}
