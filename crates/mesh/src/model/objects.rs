//! The triangles and vertices of a file's objects.

use crate::{Model, Object, SurfaceVertex};

impl Model {
    /// The same with the file's objects. A model without any is one object.
    #[must_use]
    pub fn with_objects(self, objects: Vec<Object>) -> Self {
        Self { objects, ..self }
    }

    /// The objects, at least one.
    pub fn all_objects(&self) -> Vec<Object> {
        if !self.objects.is_empty() {
            return self.objects.clone();
        }
        vec![Object {
            triangles: std::iter::once(0..self.drawn.triangle_count() as u32).collect(),
            ..Object::default()
        }]
    }

    /// For each of [`crate::Drawn::triangles`], the value of `holds` for its object's number.
    pub fn triangles_of_objects(&self, holds: impl Fn(usize) -> bool) -> Vec<bool> {
        let mut chosen = vec![false; self.drawn.triangle_count()];
        for (number, object) in self.all_objects().iter().enumerate() {
            if holds(number) {
                for run in &object.triangles {
                    if let Some(run) = chosen.get_mut(run.start as usize..run.end as usize) {
                        run.fill(true);
                    }
                }
            }
        }
        chosen
    }

    /// The number of the object that a triangle of the surface belongs to.
    pub fn object_of(&self, surface_triangle: u32) -> Option<usize> {
        let drawn = *self.drawn.triangle_of_surface().get(surface_triangle as usize)?;
        self.all_objects()
            .iter()
            .position(|object| object.triangles.iter().any(|run| run.contains(&drawn)))
    }

    /// The surface's vertices of some of [`crate::Drawn::triangles`]: a flag each.
    pub fn vertices_of_triangles(&self, chosen: &[bool]) -> Vec<bool> {
        let mut of = vec![false; self.surface.positions.len()];
        let corners = self.surface.triangles.iter().zip(self.drawn.triangle_of_surface());
        for (corners, &drawn) in corners {
            if chosen.get(drawn as usize) == Some(&true) {
                for &SurfaceVertex(vertex) in corners {
                    of[vertex as usize] = true;
                }
            }
        }
        of
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that can't go on fails")]
mod tests {
    use crate::{Cancel, Model, Object, Progress, WeldOptions, shapes};

    #[test]
    fn objects_share_out_the_triangles_and_vertices_between_two_belong_to_both() {
        let drawn = shapes::grid(4, 4);
        let count = drawn.triangles.len() as u32;
        let weld = |drawn| Model::weld(drawn, &WeldOptions::default(), &Progress::new(), &Cancel::new()).unwrap();
        let whole = weld(drawn.clone());
        assert_eq!(whole.all_objects().len(), 1);
        assert!(
            whole
                .triangles_of_objects(|object| object == 0)
                .iter()
                .all(|&chosen| chosen)
        );
        let object = |triangles| Object {
            triangles,
            ..Object::default()
        };
        let halves = weld(drawn).with_objects(vec![
            object(std::iter::once(0..count / 2).collect()),
            object(vec![count / 2..count - 2, count - 2..count]),
        ]);
        assert_eq!(halves.object_of(0), Some(0));
        assert_eq!(halves.object_of(count - 1), Some(1));
        let vertices = [0, 1].map(|half| halves.vertices_of_triangles(&halves.triangles_of_objects(|o| o == half)));
        let both = vertices[0].iter().zip(&vertices[1]).filter(|(a, b)| **a && **b).count();
        assert!(vertices[0].iter().zip(&vertices[1]).all(|(a, b)| *a || *b));
        assert_eq!(both, 5, "the row between the halves");
    }
}
