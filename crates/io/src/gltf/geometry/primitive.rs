//! Meshes' primitives as the file names them.

use std::collections::HashMap;

use pliant_mesh::Cancel;

use crate::gltf::document::Document;
use crate::gltf::document::fault::Fault;
use crate::gltf::document::json::At;
use crate::gltf::uv_sets::{MaterialMaps, UvTransform};

/// The shapes that a primitive's corners make.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Mode {
    Points,
    Lines,
    LineLoop,
    LineStrip,
    Triangles,
    Strip,
    Fan,
}

impl Mode {
    /// Returns true if it makes triangles, not lines or points.
    pub fn makes_triangles(self) -> bool {
        matches!(self, Self::Triangles | Self::Strip | Self::Fan)
    }
}

/// The members of a primitive that are read; every index is in range.
#[derive(Clone, Debug)]
pub(crate) struct Primitive {
    pub at: At,
    /// `None`: a mode that glTF does not have.
    pub mode: Option<Mode>,
    pub position: Option<usize>,
    pub normal: Option<usize>,
    pub tangent: Option<usize>,
    /// The first vertex colour.
    pub colour: Option<usize>,
    /// The texture coordinates of the material's base colour image.
    pub uv: Option<usize>,
    /// The transform of these on the way.
    pub uv_transform: UvTransform,
    /// The second set of texture coordinates, for the material's other images.
    pub second_uv: Option<usize>,
    pub indices: Option<usize>,
    pub material: Option<usize>,
    pub targets: Vec<Target>,
    /// The accessors of joints and of their weights, set by set; empty for a primitive that isn't bound to joints.
    pub influences: Vec<(usize, usize)>,
}

/// A morph target: displacements of the base's numbers.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(crate) struct Target {
    pub position: Option<usize>,
    pub normal: Option<usize>,
}

/// The accessors, morph targets, influences and transform of texture coordinates of a primitive's vertices.
type Attributes<'a> = ([Option<usize>; 6], &'a [Target], &'a [(usize, usize)], Option<[u32; 5]>);

/// The primitives that are drawn, with their number and mode: those that make triangles, then lines and points.
pub(crate) fn triangles_first(primitives: &[Primitive]) -> impl Iterator<Item = (usize, &Primitive, Mode)> {
    let pass = |wanted: bool| {
        let all = primitives.iter().enumerate();
        let drawn = all.filter_map(|(number, primitive)| Some((number, primitive, primitive.mode?)));
        drawn.filter(move |(.., mode)| mode.makes_triangles() == wanted)
    };
    pass(true).chain(pass(false))
}

/// For each primitive of a mesh the first one with the same vertices, which may be itself.
pub(crate) fn first_alike(primitives: &[Primitive]) -> Vec<usize> {
    let mut first: HashMap<Attributes<'_>, usize> = HashMap::new();
    let all = primitives.iter().enumerate();
    all.map(|(number, primitive)| *first.entry(primitive.attributes()).or_insert(number))
        .collect()
}

/// The primitives of every mesh, in the file's order.
pub(crate) fn primitives(document: &Document, cancel: &Cancel) -> Result<Vec<Vec<Primitive>>, Fault> {
    let json = &document.json;
    let of_mesh = |(mesh, &at): (usize, &At)| {
        let list = json.member(at, "primitives");
        let primitives = list.into_iter().flat_map(|list| json.elements(list)).enumerate();
        primitives
            .map(|(number, at)| {
                cancel.check()?;
                Ok(Primitive::read(document, at, || {
                    format!("mesh {mesh} primitive {number}")
                })?)
            })
            .collect()
    };
    document.meshes_at.iter().enumerate().map(of_mesh).collect()
}

impl Primitive {
    fn read(document: &Document, at: At, what: impl Fn() -> String) -> Result<Self, String> {
        let json = &document.json;
        let mode = match json.member(at, "mode").map(|mode| json.number(mode)) {
            None => Some(Mode::Triangles),
            Some(Some(4.0)) => Some(Mode::Triangles),
            Some(Some(5.0)) => Some(Mode::Strip),
            Some(Some(6.0)) => Some(Mode::Fan),
            Some(Some(0.0)) => Some(Mode::Points),
            Some(Some(1.0)) => Some(Mode::Lines),
            Some(Some(2.0)) => Some(Mode::LineLoop),
            Some(Some(3.0)) => Some(Mode::LineStrip),
            _ => None,
        };
        let accessor = |object: At, key: &str| document.index(object, key, document.accessors.len(), &what);
        let attributes = json.member(at, "attributes");
        let attribute = |key: &str| attributes.map_or(Ok(None), |attributes| accessor(attributes, key));
        let material = document.index(at, "material", document.materials.len(), &what)?;
        let maps = material.map_or_else(MaterialMaps::default, |material| document.material_maps[material]);
        let targets = json.member(at, "targets");
        let mut influences = Vec::new();
        while let (Some(joints), Some(weights)) = (
            attribute(&format!("JOINTS_{}", influences.len()))?,
            attribute(&format!("WEIGHTS_{}", influences.len()))?,
        ) {
            influences.push((joints, weights));
        }
        Ok(Self {
            at,
            mode,
            position: attribute("POSITION")?,
            normal: attribute("NORMAL")?,
            tangent: attribute("TANGENT")?,
            colour: attribute("COLOR_0")?,
            uv: attribute(&format!("TEXCOORD_{}", maps.base_set))?,
            uv_transform: maps.base_transform,
            second_uv: match maps.second_set {
                Some(set) => attribute(&format!("TEXCOORD_{set}"))?,
                None => None,
            },
            indices: accessor(at, "indices")?,
            material,
            targets: targets
                .into_iter()
                .flat_map(|targets| json.elements(targets))
                .map(|target| {
                    Ok(Target {
                        position: accessor(target, "POSITION")?,
                        normal: accessor(target, "NORMAL")?,
                    })
                })
                .collect::<Result<_, String>>()?,
            influences,
        })
    }

    /// Returns true if its vertices are in the same places as the other's, for any weights of morph targets and any
    /// pose of the skin.
    pub fn moves_as(&self, other: &Self) -> bool {
        let is_bound_alike = self.influences == other.influences;
        self.position == other.position && self.targets == other.targets && is_bound_alike
    }

    /// All inputs of a primitive's drawn vertices: equal for two whose drawn vertices are the same.
    fn attributes(&self) -> Attributes<'_> {
        let accessors = [
            self.position,
            self.normal,
            self.tangent,
            self.colour,
            self.uv,
            self.second_uv,
        ];
        let transform = self.uv.map(|_| self.uv_transform.bits());
        (accessors, &self.targets, &self.influences, transform)
    }

    /// Refuses compressed accessors that could not be decoded.
    pub fn check_decoded(&self, document: &Document) -> Result<(), String> {
        if let Some(reason) = document.undecoded_primitives.get(&self.at) {
            return Err(format!("has {reason}"));
        }
        let read = [
            self.position,
            self.normal,
            self.tangent,
            self.colour,
            self.uv,
            self.second_uv,
            self.indices,
        ];
        let influences = self.influences.iter().flat_map(|&(joints, weights)| [joints, weights]);
        for accessor in read.into_iter().flatten().chain(influences) {
            let accessor = &document.accessors[accessor];
            let sparse = accessor
                .sparse
                .iter()
                .flat_map(|s| [s.indices.buffer_view, s.values.buffer_view]);
            for view in accessor.buffer_view.into_iter().chain(sparse) {
                if let Some(reason) = document.undecoded_views.get(&view.value()) {
                    return Err(format!(
                        "reads the compressed buffer view {}, which {reason}",
                        view.value()
                    ));
                }
            }
        }
        Ok(())
    }
}
