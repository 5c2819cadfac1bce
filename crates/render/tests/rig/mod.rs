//! Test rig for drawing: a shared device, simple shapes, views and colours.
#![allow(dead_code, reason = "each test file uses its own part")]

pub mod golden;

use std::sync::{Mutex, MutexGuard, OnceLock};

use glam::{Mat4, Vec3};
use pliant_render::{Frame, Headless, Image, Overlay, Renderer, Samples, Style, Surface, SurfaceData, View};

/// Size of test pictures: small, and not a multiple of the row alignment.
pub const SIZE_PX: [u32; 2] = [150, 100];

/// The renderer that all tests share; `None`, with a message, if there is no device.
pub fn renderer() -> Option<MutexGuard<'static, Headless>> {
    static HEADLESS: OnceLock<Option<Mutex<Headless>>> = OnceLock::new();
    let shared = HEADLESS.get_or_init(|| match Headless::new() {
        Ok(headless) => Some(Mutex::new(headless)),
        Err(error) => {
            #[expect(clippy::print_stderr, reason = "a skipped test says so")]
            {
                eprintln!("skipped: pictures ({error})");
            }
            None
        }
    });
    // A test that failed while drawing does not break the renderer.
    shared
        .as_ref()
        .map(|headless| headless.lock().unwrap_or_else(|poisoned| poisoned.into_inner()))
}

/// A triangle mesh.
#[derive(Clone, Default)]
pub struct Shape {
    pub positions: Vec<[f32; 3]>,
    pub normals: Vec<[f32; 3]>,
    pub triangles: Vec<[u32; 3]>,
}

impl Shape {
    /// The unit sphere: an octahedron whose faces are split in four `levels` times.
    pub fn sphere(levels: u32) -> Self {
        let corners = [Vec3::X, Vec3::Y, Vec3::Z, -Vec3::X, -Vec3::Y, -Vec3::Z];
        let faces = [
            [0, 1, 2],
            [1, 3, 2],
            [3, 4, 2],
            [4, 0, 2],
            [1, 0, 5],
            [3, 1, 5],
            [4, 3, 5],
            [0, 4, 5],
        ];
        let mut triangles: Vec<[Vec3; 3]> = faces.map(|face| face.map(|corner: usize| corners[corner])).to_vec();
        for _ in 0..levels {
            triangles = triangles
                .iter()
                .flat_map(|&[a, b, c]| {
                    let middle = |p: Vec3, q: Vec3| (p + q).normalize();
                    let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
                    [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
                })
                .collect();
        }
        let mut shape = Self::default();
        for triangle in triangles {
            let first = shape.positions.len() as u32;
            shape.triangles.push([first, first + 1, first + 2]);
            shape.positions.extend(triangle.map(|corner| corner.to_array()));
        }
        shape.normals = shape.positions.clone();
        shape
    }

    /// A torus around the z axis of `around` by `across` quads without its last eighth, so that its inside and its
    /// border are visible.
    pub fn open_ring(around: u32, across: u32) -> Self {
        let mut shape = Self::default();
        let kept = around - around / 8;
        for i in 0..=kept {
            let turn = std::f32::consts::TAU * i as f32 / around as f32;
            let outward = Vec3::new(turn.cos(), turn.sin(), 0.0);
            for k in 0..across {
                let lap = std::f32::consts::TAU * k as f32 / across as f32;
                let normal = outward * lap.cos() + Vec3::Z * lap.sin();
                shape.positions.push((outward * 0.85 + normal * 0.4).to_array());
                shape.normals.push(normal.to_array());
            }
        }
        for i in 0..kept {
            for k in 0..across {
                let v = |i: u32, k: u32| i * across + k % across;
                shape.triangles.push([v(i, k), v(i + 1, k), v(i + 1, k + 1)]);
                shape.triangles.push([v(i, k), v(i + 1, k + 1), v(i, k + 1)]);
            }
        }
        shape
    }

    /// A square in the plane z = `z` that faces +z, `half` units to each side of (`x`, 0).
    pub fn square(x: f32, z: f32, half: f32) -> Self {
        let positions = [
            [x - half, -half, z],
            [x + half, -half, z],
            [x + half, half, z],
            [x - half, half, z],
        ];
        Self {
            positions: positions.to_vec(),
            normals: vec![[0.0, 0.0, 1.0]; 4],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
        }
    }

    /// The same seen from inside.
    pub fn turned_inside_out(mut self) -> Self {
        for triangle in &mut self.triangles {
            triangle.swap(1, 2);
        }
        for normal in &mut self.normals {
            *normal = normal.map(|component| -component);
        }
        self
    }

    pub fn data(&self) -> SurfaceData<'_> {
        SurfaceData {
            positions: &self.positions,
            normals: &self.normals,
            triangles: &self.triangles,
            ..Default::default()
        }
    }

    pub fn upload(&self, renderer: &Renderer) -> Surface {
        Surface::new(renderer.gpu(), &self.data()).expect("the shape is sound")
    }

    /// The first triangle that a ray hits, and the hit's distance from its edges (in barycentric coordinates).
    pub fn ray(&self, origin: Vec3, direction: Vec3) -> Option<(u32, f32)> {
        let mut nearest: Option<(f32, u32, f32)> = None;
        for (number, triangle) in self.triangles.iter().enumerate() {
            let [a, b, c] = triangle.map(|vertex| Vec3::from(self.positions[vertex as usize]));
            // [MT97].
            let (ab, ac) = (b - a, c - a);
            let p = direction.cross(ac);
            let determinant = ab.dot(p);
            if determinant == 0.0 {
                continue;
            }
            let from_a = origin - a;
            let v = from_a.dot(p) / determinant;
            let q = from_a.cross(ab);
            let w = direction.dot(q) / determinant;
            let distance = ac.dot(q) / determinant;
            let margin = v.min(w).min(1.0 - v - w);
            if margin >= 0.0 && distance > 0.0 && nearest.is_none_or(|(best, ..)| distance < best) {
                nearest = Some((distance, number as u32, margin));
            }
        }
        nearest.map(|(_, number, margin)| (number, margin))
    }
}

/// A perspective view from (0, 0, 4) towards the origin.
pub fn front_view() -> View {
    let view_from_world = View::look_at(Vec3::new(0.0, 0.0, 4.0), Vec3::ZERO, Vec3::Y);
    View::perspective(0.7, SIZE_PX[0] as f32 / SIZE_PX[1] as f32, 0.01, view_from_world)
}

/// [`front_view`] in orthographic projection.
pub fn parallel_front_view() -> View {
    let view_from_world = Mat4::from_translation(Vec3::new(0.0, 0.0, -4.0));
    View::orthographic(1.4, SIZE_PX[0] as f32 / SIZE_PX[1] as f32, 0.0, 10.0, view_from_world)
}

/// A view from the front, the right and above.
pub fn oblique_view() -> View {
    let view_from_world = View::look_at(Vec3::new(1.6, 2.0, 3.6), Vec3::new(0.0, -0.05, 0.0), Vec3::Y);
    View::perspective(0.62, SIZE_PX[0] as f32 / SIZE_PX[1] as f32, 0.01, view_from_world)
}

/// A picture of surfaces and overlays, seen from `view`.
pub fn draw(renderer: &mut Renderer, view: &View, style: &Style, surfaces: &[&Surface], overlays: &[Overlay]) -> Image {
    let frame = Frame {
        view,
        style,
        surfaces,
        grid: None,
        overlays,
    };
    renderer
        .draw_to_image(SIZE_PX, Samples::One, &frame)
        .expect("a small picture can be drawn")
}

/// The pixel where a point of the world is seen.
pub fn pixel_at(image: &Image, view: &View, position: [f32; 3]) -> [u8; 4] {
    let pixel = view
        .pixel_from_world(position.into(), SIZE_PX)
        .expect("the point is before the eye");
    image
        .pixel(pixel.x as u32, pixel.y as u32)
        .expect("the point is in the picture")
}

/// Mean of red, green and blue.
pub fn brightness(pixel: [u8; 4]) -> f32 {
    pixel[..3].iter().map(|&channel| f32::from(channel)).sum::<f32>() / 3.0
}

/// Returns true if two colours differ by at most `tolerance` in each channel.
pub fn is_near(a: [u8; 4], b: [u8; 4], tolerance: u8) -> bool {
    a.iter().zip(b).all(|(&a, b)| a.abs_diff(b) <= tolerance)
}
