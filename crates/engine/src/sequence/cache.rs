//! The frames of a point cache: the positions of a mesh's vertices, in the order of its file.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use glam::DVec3;
use pliant_io::{CacheFrames, PointCacheFormat};
use pliant_mesh::{Model, SurfaceVertex};

use crate::EngineError;
use crate::file_error::FileError;
use crate::loading::Loaded;
use crate::path_text::shown;

/// A point cache on a mesh.
#[derive(Debug)]
pub(super) struct Cache {
    path: PathBuf,
    frames: CacheFrames,
    /// The point at which each surface vertex is.
    point_of_vertex: Vec<u32>,
    /// The surface vertex that moves each point.
    vertex_of_point: Vec<Option<SurfaceVertex>>,
}

/// The bytes of a frame, and its shape.
#[derive(Debug)]
pub(super) struct CacheFrame {
    pub bytes: Vec<u8>,
    /// The position of each surface vertex.
    pub positions: Vec<DVec3>,
}

impl Cache {
    /// Reads the header of a cache of a mesh's vertices.
    ///
    /// # Errors
    /// A file that can't be read, is no cache, or has another number of points than the mesh has vertices.
    pub fn of(path: &Path, format: PointCacheFormat, mesh: &Loaded) -> Result<Self, EngineError> {
        let refuse = |error| EngineError::from(FileError::reading(path, error));
        let mut file = File::open(path).map_err(refuse)?;
        let length = file.metadata().map_err(refuse)?.len();
        let mut header = vec![0; CacheFrames::HEADER.min(length as usize)];
        file.read_exact(&mut header).map_err(refuse)?;
        let frames = CacheFrames::read(format, &header, length);
        let frames = frames.map_err(|what| EngineError::Unsupported(format!("{} {what}", shown(path))))?;
        let (points, vertices) = (frames.point_count(), mesh.model.drawn.file_vertex_count());
        if points != vertices {
            return Err(EngineError::Unsupported(format!(
                "{} has {points} points, and {} has {vertices} vertices: give the mesh that the cache was made of",
                shown(path),
                shown(&mesh.path)
            )));
        }
        Ok(Self {
            path: path.to_owned(),
            frames,
            point_of_vertex: point_of_vertex(&mesh.model),
            vertex_of_point: vertex_of_point(&mesh.model),
        })
    }

    /// The number of frames.
    pub fn count(&self) -> usize {
        self.frames.frame_count()
    }

    /// The bytes before the first frame.
    ///
    /// # Errors
    /// The system's.
    pub fn header(&self) -> Result<Vec<u8>, EngineError> {
        self.read_at(0, self.frames.start())
    }

    /// Reads a frame.
    ///
    /// # Errors
    /// A file that can't be read, or a point without a finite position.
    pub fn frame(&self, frame: usize) -> Result<CacheFrame, EngineError> {
        let length = self.frames.frame_length();
        let bytes = self.read_at(self.frames.start() as u64 + frame as u64 * length as u64, length)?;
        let points = self.frames.positions(&bytes);
        if let Some(point) = points.iter().position(|point| !point.is_finite()) {
            return Err(EngineError::Unsupported(format!(
                "{}: point {point} has no finite position in frame {frame}: repair the cache",
                shown(&self.path)
            )));
        }
        let positions = self.point_of_vertex.iter().map(|point| points[*point as usize]);
        Ok(CacheFrame {
            positions: positions.collect(),
            bytes,
        })
    }

    /// A frame's bytes, displaced with the surface. Points that don't move keep their bytes.
    pub fn displaced(&self, frame: CacheFrame, displacements: &[DVec3]) -> Vec<u8> {
        let points = self.frames.positions(&frame.bytes);
        let mut bytes = frame.bytes;
        for (point, (position, vertex)) in points.into_iter().zip(&self.vertex_of_point).enumerate() {
            let way = vertex.map_or(DVec3::ZERO, |vertex| displacements[vertex.index()]);
            if way != DVec3::ZERO {
                self.frames.put(&mut bytes, point, position + way);
            }
        }
        bytes
    }

    fn read_at(&self, start: u64, length: usize) -> Result<Vec<u8>, EngineError> {
        let mut bytes = vec![0; length];
        let mut read = || {
            // Each frame opens the file for itself, because frames are read side by side.
            let mut file = File::open(&self.path)?;
            file.seek(SeekFrom::Start(start))?;
            file.read_exact(&mut bytes)
        };
        match read() {
            Ok(()) => Ok(bytes),
            Err(error) => Err(FileError::reading(&self.path, error).into()),
        }
    }
}

fn point_of_vertex(model: &Model) -> Vec<u32> {
    model.first_file_vertices().iter().map(|point| point.0).collect()
}

fn vertex_of_point(model: &Model) -> Vec<Option<SurfaceVertex>> {
    let mut vertex_of_point = vec![None; model.drawn.file_vertex_count()];
    for (point, vertex) in model.drawn.file_vertices().zip(model.drawn.surface_vertices()) {
        vertex_of_point[point.index()] = vertex_of_point[point.index()].or(vertex);
    }
    vertex_of_point
}
