//! The name of a connected part: by its size beside the whole and by its place, because it has no name of its own.

use pliant_editor::UpAxis;
use pliant_mesh::{Bounds, Model, bounding_box};

/// The name of a component, such as "Small, top left" or "Large, in the middle".
pub(super) fn part_name(model: &Model, component: u32, up: UpAxis) -> String {
    let vertices = model.topology.vertices_of(component);
    let positions: Vec<_> = vertices.map(|vertex| model.surface.positions[vertex.index()]).collect();
    let (Some(whole), Some(part)) = (model.bounds(), bounding_box(&positions)) else {
        return format!("Part {}", component + 1);
    };
    format!("{}, {}", size(&whole, &part), place(&whole, &part, up))
}

fn size(whole: &Bounds, part: &Bounds) -> &'static str {
    match part.diagonal() / whole.diagonal() {
        0.3.. => "Large",
        0.1..0.3 => "Medium",
        0.03..0.1 => "Small",
        _ => "Tiny",
    }
}

/// The place of the part's middle, seen from the front: positions outside the middle third of each axis count.
fn place(whole: &Bounds, part: &Bounds, up: UpAxis) -> String {
    let offset = (part.centre() - whole.centre()) / whole.extent();
    // To the right, upwards and towards the eye.
    let [right, above, before] = match up {
        UpAxis::Y => [offset.x, offset.y, offset.z],
        UpAxis::Z => [offset.x, offset.z, -offset.y],
    };
    let word = |offset: f64, less: &'static str, more: &'static str| match offset {
        ..-0.167 => Some(less),
        0.167.. => Some(more),
        _ => None,
    };
    let words = [
        word(above, "bottom", "top"),
        word(right, "left", "right"),
        word(before, "back", "front"),
    ];
    let words: Vec<&str> = words.into_iter().flatten().collect();
    match words.is_empty() {
        true => "in the middle".to_owned(),
        false => words.join(" "),
    }
}

#[cfg(test)]
mod tests {
    use glam::{DAffine3, DVec3};
    use pliant_editor::UpAxis;
    use pliant_mesh::{Drawn, SurfaceVertex, shapes};

    use super::part_name;

    fn ball(radius: f64, centre: DVec3) -> Drawn {
        let place = DAffine3::from_translation(centre) * DAffine3::from_scale(DVec3::splat(radius));
        shapes::moved(&shapes::icosphere(2), place)
    }

    #[test]
    fn parts_are_named_by_size_and_place_seen_from_the_front() {
        let corners = [DVec3::splat(-10.0), DVec3::splat(10.0)].map(|corner| ball(0.1, corner));
        let [low, high] = corners;
        let parts = [
            low,
            high,
            ball(4.0, DVec3::ZERO),
            ball(1.0, DVec3::new(-8.0, 8.0, 0.0)),
            ball(2.0, DVec3::new(0.0, 0.0, 7.0)),
        ];
        let model = shapes::model(shapes::together(&parts));
        let name_at = |point: DVec3, up: UpAxis| {
            let vertices = (0..model.surface.positions.len() as u32).map(SurfaceVertex);
            let distance = |vertex: &SurfaceVertex| model.surface.positions[vertex.index()].distance(point);
            let nearest = vertices.min_by(|a, b| distance(a).total_cmp(&distance(b)));
            part_name(&model, nearest.map_or(0, |vertex| model.topology.component(vertex)), up)
        };
        let (left_top, before) = (DVec3::new(-8.0, 8.0, 0.0), DVec3::new(0.0, 0.0, 7.0));
        assert_eq!(name_at(DVec3::ZERO, UpAxis::Y), "Large, in the middle");
        assert_eq!(name_at(left_top, UpAxis::Y), "Small, top left");
        assert_eq!(name_at(before, UpAxis::Y), "Medium, front");
        assert_eq!(name_at(before, UpAxis::Z), "Medium, top");
        assert_eq!(name_at(left_top, UpAxis::Z), "Small, left back");
        assert_eq!(name_at(DVec3::splat(10.0), UpAxis::Y), "Tiny, top right front");
    }
}
