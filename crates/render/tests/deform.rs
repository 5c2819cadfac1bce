//! The law of deforming on the device: positions and normals are the processor's, up to the rounding of f32.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may fail by panicking")]

mod rig;

use glam::{DAffine3, DQuat, DVec3, Quat, Vec3};
use pliant_render::{Deformer, DeformerData, RenderError, StoredNormals, Style, Surface, View};
use rig::{Shape, draw, renderer};

/// A deformation by two handles: weights that blend from one end of the ring to the other, some vertices still.
struct Bend {
    shape: Shape,
    row_of_vertex: Vec<u32>,
    rows: Vec<[f32; 4]>,
    motions: Vec<[DVec3; 4]>,
    normal_groups: Vec<u32>,
}

fn bend(scale: f32, turn_rad: f64) -> Bend {
    let mut shape = Shape::open_ring(160, 60);
    for position in &mut shape.positions {
        *position = position.map(|coordinate| coordinate * scale);
    }
    let scale = f64::from(scale);
    let maps = [
        DAffine3::from_rotation_translation(
            DQuat::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), turn_rad),
            DVec3::Y * scale,
        ),
        DAffine3::from_scale_rotation_translation(
            DVec3::new(1.2, 0.9, 1.1),
            DQuat::from_rotation_z(-0.4),
            DVec3::X * 0.3 * scale,
        ),
    ];
    let centres = [DVec3::new(0.8, 0.1, 0.0) * scale, DVec3::new(-0.7, -0.3, 0.1) * scale];
    let (mut row_of_vertex, mut rows) = (Vec::new(), Vec::new());
    for &[x, y, z] in &shape.positions {
        let p = DVec3::new(f64::from(x), f64::from(y), f64::from(z));
        let share = (0.5 + 0.6 * p.x / scale).clamp(0.0, 1.0);
        if p.y < -0.9 * scale {
            row_of_vertex.push(DeformerData::STILL);
            continue;
        }
        row_of_vertex.push(rows.len() as u32 / 2);
        for (centre, weight) in centres.iter().zip([share, 1.0 - share]) {
            let q = (p - *centre) / scale * weight;
            rows.push([q.x as f32, q.y as f32, q.z as f32, weight as f32]);
        }
    }
    let motions = maps.iter().zip(centres).map(|(map, centre)| {
        let linear = (map.matrix3 - glam::DMat3::IDENTITY) * scale;
        [
            linear.x_axis,
            linear.y_axis,
            linear.z_axis,
            map.transform_point3(centre) - centre,
        ]
    });
    Bend {
        motions: motions.collect(),
        normal_groups: (0..shape.positions.len() as u32).collect(),
        shape,
        row_of_vertex,
        rows,
    }
}

impl Bend {
    /// What the device is given, without normals of the file's own.
    fn data(&self) -> DeformerData<'_> {
        DeformerData {
            rest: &self.shape.positions,
            row_of_vertex: &self.row_of_vertex,
            rows: &self.rows,
            handle_count: 2,
            triangles: &self.shape.triangles,
            normal_groups: &self.normal_groups,
            stored: None,
        }
    }

    /// The positions in f64.
    fn positions(&self) -> Vec<DVec3> {
        let of_vertex = self.shape.positions.iter().zip(&self.row_of_vertex);
        of_vertex
            .map(|(&[x, y, z], &row)| {
                let mut p = DVec3::new(f64::from(x), f64::from(y), f64::from(z));
                if row != DeformerData::STILL {
                    for (handle, columns) in self.motions.iter().enumerate() {
                        let weights = self.rows[2 * row as usize + handle];
                        for (column, weight) in columns.iter().zip(weights) {
                            p += *column * f64::from(weight);
                        }
                    }
                }
                p
            })
            .collect()
    }

    fn motions(&self) -> Vec<[[f32; 3]; 4]> {
        self.motions
            .iter()
            .map(|columns| columns.map(|column| column.as_vec3().to_array()))
            .collect()
    }
}

fn normals(shape: &Shape, positions: &[DVec3]) -> Vec<Vec3> {
    let mut sums = vec![DVec3::ZERO; positions.len()];
    for triangle in &shape.triangles {
        let [a, b, c] = triangle.map(|v| positions[v as usize]);
        for &vertex in triangle {
            sums[vertex as usize] += (b - a).cross(c - a);
        }
    }
    sums.into_iter()
        .map(|sum| sum.normalize_or(DVec3::Z).as_vec3())
        .collect()
}

#[test]
fn positions_and_normals_are_the_processors_to_the_rounding_of_f32() {
    let Some(mut headless) = renderer() else { return };
    let renderer = &mut headless.renderer;
    for (scale, turn_rad) in [(1.0, 0.9), (1000.0, 2.5), (1e-3, -0.2)] {
        let bend = bend(scale, turn_rad);
        let mut surface = bend.shape.upload(renderer);
        let rest: Vec<DVec3> = bend.shape.positions.iter().map(|&p| Vec3::from(p).as_dvec3()).collect();
        let at_rest: Vec<[f32; 3]> = normals(&bend.shape, &rest).iter().map(|n| n.to_array()).collect();
        // A file's normals that are not the geometric ones.
        let leaning: Vec<[f32; 3]> = at_rest
            .iter()
            .map(|&n| (Quat::from_rotation_x(0.2) * Vec3::from(n)).to_array())
            .collect();
        let wanted = bend.positions();
        let geometric = normals(&bend.shape, &wanted);
        let size = wanted.iter().fold(0.0, |most: f64, p| most.max(p.abs().max_element()));
        let shortest = bend
            .shape
            .triangles
            .iter()
            .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        let lengths = shortest.map(|[a, b]| wanted[a as usize].distance(wanted[b as usize]));
        let shortest = lengths.fold(f64::INFINITY, f64::min);
        let rounding = size * f64::from(f32::EPSILON);
        for stored in [
            None,
            Some(StoredNormals {
                stored: &leaning,
                at_rest: &at_rest,
            }),
        ] {
            let data = DeformerData { stored, ..bend.data() };
            let deformer = Deformer::new(renderer, &surface, &data).unwrap();
            deformer.run(renderer, &mut surface, &bend.motions()).unwrap();
            let [positions, turned] = surface.read_shape(renderer).unwrap();
            for (vertex, (found, &wanted)) in positions.iter().zip(&wanted).enumerate() {
                let off = (Vec3::from(*found).as_dvec3() - wanted).length();
                assert!(off < 6.0 * rounding, "vertex {vertex} is off by {off}");
            }
            for (vertex, found) in turned.iter().enumerate() {
                let wanted = match stored {
                    None => geometric[vertex],
                    Some(_) => {
                        Quat::from_rotation_arc(Vec3::from(at_rest[vertex]), geometric[vertex])
                            * Vec3::from(leaning[vertex])
                    }
                };
                // An edge of rounded ends turns by their rounding over its length.
                let off = f64::from(Vec3::from(*found).distance(wanted));
                assert!(off < 12.0 * rounding / shortest, "normal {vertex} is off by {off}");
            }
        }
    }
}

#[test]
fn what_the_device_has_deformed_is_drawn_as_if_it_had_been_uploaded() {
    let Some(mut headless) = renderer() else { return };
    let renderer = &mut headless.renderer;
    let bend = bend(1.0, 0.9);
    let mut surface = bend.shape.upload(renderer);
    let deformer = Deformer::new(renderer, &surface, &bend.data()).unwrap();
    deformer.run(renderer, &mut surface, &bend.motions()).unwrap();
    let [positions, normals] = surface.read_shape(renderer).unwrap();
    let uploaded = Shape {
        positions,
        normals,
        triangles: bend.shape.triangles.clone(),
    };
    let uploaded = uploaded.upload(renderer);
    let view_from_world = View::look_at(Vec3::new(1.6, 2.0, 5.6), Vec3::new(0.3, 0.6, 0.0), Vec3::Y);
    let view = View::perspective(0.7, 1.5, 0.01, view_from_world);
    let mut of = |surface: &Surface| draw(renderer, &view, &Style::default(), &[surface], &[]);
    assert_eq!(of(&surface), of(&uploaded));
}

#[test]
fn what_contradicts_the_surface_is_refused() {
    let Some(mut headless) = renderer() else { return };
    let renderer = &mut headless.renderer;
    let square = Shape::square(0.0, 0.0, 1.0);
    let mut surface = square.upload(renderer);
    let data = DeformerData {
        rest: &square.positions,
        row_of_vertex: &[0, 1, DeformerData::STILL, DeformerData::STILL],
        rows: &[[0.0, 0.0, 0.0, 1.0]; 2],
        handle_count: 1,
        triangles: &square.triangles,
        normal_groups: &[0; 4],
        stored: None,
    };
    let refused = |data: &DeformerData<'_>| {
        Deformer::new(renderer, &surface, data)
            .err()
            .map(|error| error.to_string())
    };
    assert!(
        refused(&DeformerData {
            rest: &square.positions[1..],
            ..data
        })
        .unwrap()
        .contains("rest positions")
    );
    assert!(
        refused(&DeformerData {
            row_of_vertex: &[0, 1, 2, 0],
            ..data
        })
        .unwrap()
        .contains("row 2")
    );
    let deformer = Deformer::new(renderer, &surface, &data).unwrap();
    let refused = deformer.run(renderer, &mut surface, &[]);
    assert!(matches!(
        refused,
        Err(RenderError::Length {
            expected: 1,
            found: 0,
            ..
        })
    ));
}
