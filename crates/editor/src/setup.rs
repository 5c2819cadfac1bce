//! An edit resolved on a model: what every surface vertex does, how stiff it is and how each handle moves.

use glam::{DAffine3, DVec3};
use pliant_deform::{Loose, Method, Role};
use pliant_mesh::{Model, SurfaceVertex};

use crate::HandleTransform;
use crate::edit_error::EditError;
use crate::edit_file::{EditFile, StiffnessEntry};

/// What [`pliant_deform::Problem`] needs of an edit, and the handles' transforms.
#[derive(Clone, PartialEq, Debug)]
pub struct Setup {
    /// What each surface vertex does.
    pub roles: Vec<Role>,
    /// The handles; [`Role::Handle`] is the index.
    pub handles: Vec<HandleSetup>,
    /// The stiffness of each surface vertex, 1 where nothing was said.
    pub stiffness: Vec<f64>,
    /// What components that nothing holds do.
    pub loose: Loose,
    /// The method and its options.
    pub method: Method,
}

/// A handle on a model.
#[derive(Clone, PartialEq, Debug)]
pub struct HandleSetup {
    /// Its name, for a person.
    pub name: String,
    /// Its target.
    pub transform: HandleTransform,
    /// The pivot that its transform names, or else the mean of its rest positions.
    pub pivot: DVec3,
}

impl Setup {
    /// How many vertices are solved for.
    pub fn free_count(&self) -> usize {
        self.roles.iter().filter(|&&role| role == Role::Free).count()
    }

    /// Where the handles are at the share `t` of the way, 0 at rest and 1 at their targets.
    pub fn targets(&self, t: f64) -> Vec<DAffine3> {
        self.handles
            .iter()
            .map(|handle| handle.transform.at(t, handle.pivot))
            .collect()
    }
}

impl EditFile {
    /// Resolves the edit on a model.
    ///
    /// Vertices outside of `region` and those in `fixed` are fixed, and a handle wins over both.
    ///
    /// # Errors
    /// A vertex or component that the model does not have, a handle that selects nothing, a vertex in two handles, a
    /// stiffness field of another length.
    pub fn resolve(&self, model: &Model) -> Result<Setup, EditError> {
        if self.handles.len() > usize::from(u16::MAX) {
            return Err(EditError::TooManyHandles(self.handles.len()));
        }
        let mut roles = vec![Role::Fixed; model.surface.positions.len()];
        for vertex in self.region.evaluate_at(model, "region")?.iter() {
            roles[vertex.index()] = Role::Free;
        }
        for vertex in self.fixed.evaluate_at(model, "fixed")?.iter() {
            roles[vertex.index()] = Role::Fixed;
        }
        let mut handles = Vec::with_capacity(self.handles.len());
        for (index, entry) in self.handles.iter().enumerate() {
            let selection = entry.select.evaluate_at(model, &format!("handles[{index}].select"))?;
            let (mut sum, mut count) = (DVec3::ZERO, 0.0);
            let mut shared: Vec<(SurfaceVertex, u16)> = Vec::new();
            for vertex in selection.iter() {
                if let Role::Handle(other) = roles[vertex.index()] {
                    shared.push((vertex, other));
                }
                roles[vertex.index()] = Role::Handle(index as u16);
                sum += model.surface.positions[vertex.index()];
                count += 1.0;
            }
            if let Some(&(vertex, other)) = shared.first() {
                return Err(EditError::SharedVertex {
                    first: self.handles[usize::from(other)].name.clone(),
                    second: entry.name.clone(),
                    shared: shared.iter().filter(|&&(_, o)| o == other).count(),
                    file_vertex: first_file_vertex(model, vertex),
                });
            }
            if count == 0.0 {
                return Err(EditError::EmptyHandle {
                    handle: entry.name.clone(),
                    index,
                });
            }
            handles.push(HandleSetup {
                name: entry.name.clone(),
                transform: entry.transform,
                pivot: entry.transform.pivot_or(sum / count),
            });
        }
        let stiffness = self.stiffness_on(model)?;
        Ok(Setup {
            roles,
            handles,
            stiffness,
            loose: self.loose,
            method: self.method.clone(),
        })
    }

    fn stiffness_on(&self, model: &Model) -> Result<Vec<f64>, EditError> {
        let mut stiffness = vec![1.0; model.surface.positions.len()];
        for (index, entry) in self.stiffness.iter().enumerate() {
            match entry {
                StiffnessEntry::Select { select, value } => {
                    for vertex in select.evaluate_at(model, &format!("stiffness[{index}].select"))?.iter() {
                        stiffness[vertex.index()] = *value;
                    }
                }
                StiffnessEntry::PerVertex(values) => {
                    let (found, count) = (values.len(), model.drawn.file_vertex_count);
                    if found != count {
                        let place = format!("stiffness[{index}].per_vertex");
                        return Err(EditError::FieldLength { place, found, count });
                    }
                    for (vertex, file_vertex) in lowest_file_vertices(model).into_iter().enumerate() {
                        stiffness[vertex] = values[file_vertex as usize];
                    }
                }
            }
        }
        Ok(stiffness)
    }
}

/// The lowest file vertex behind each surface vertex.
fn lowest_file_vertices(model: &Model) -> Vec<u32> {
    let mut lowest = vec![u32::MAX; model.surface.positions.len()];
    for (surface_vertex, file_vertex) in model.surface_of_drawn.iter().zip(&model.drawn.file_vertex) {
        if let Some(surface_vertex) = surface_vertex {
            let slot = &mut lowest[surface_vertex.index()];
            *slot = file_vertex.0.min(*slot);
        }
    }
    lowest
}

fn first_file_vertex(model: &Model, vertex: SurfaceVertex) -> u32 {
    let behind = model.surface_of_drawn.iter().zip(&model.drawn.file_vertex);
    behind
        .filter(|(surface_vertex, _)| **surface_vertex == Some(vertex))
        .map(|(_, file)| file.0)
        .min()
        .unwrap_or(0)
}
