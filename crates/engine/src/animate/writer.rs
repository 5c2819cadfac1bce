//! The writing of an animation, frame by frame: numbered files, a point cache, or morph targets of a glTF.

use std::collections::BTreeSet;
use std::path::Path;
use std::time::Instant;

use glam::DVec3;
use pliant_io::{FewTargets, MorphAnimation, PointCache, ShapeDirections};
use pliant_mesh::{DrawnVertex, Progress, SurfaceVertex};

use super::kind::Kind;
use super::report::MorphReport;
use crate::EngineError;
use crate::files::{Destination, NewFile, Staged, Staging};
use crate::frames::Frames;
use crate::loading::Loaded;
use crate::report::ms_since;
use crate::saving::{self, SaveAs};
use crate::watch::Watch;

/// The place and the look of an animation's files.
#[derive(Clone, Copy)]
pub(crate) struct AnimationFiles<'a> {
    /// The file that is animated.
    pub loaded: &'a Loaded,
    /// The name of the output.
    pub output: &'a Path,
    /// The name of the animation in a glTF; its morph targets have numbers after it.
    pub name: &'a str,
    /// The largest error of a glTF's frames, as a share of the diagonal of the shape's box.
    pub tolerance: f64,
    /// The frames a second.
    pub fps: f64,
    /// The number of frames.
    pub count: usize,
    /// The frames' times in seconds, if the rate does not give them.
    pub times: Option<&'a [f64]>,
    /// True if a glTF shows each frame until the next, without a way between them.
    pub holds: bool,
    /// The vertices whose displacements a frame has.
    pub moved: MovedVertices,
    /// The connected parts that are turned inside out.
    pub inside_out: &'a BTreeSet<u32>,
    /// Other colours of the drawn vertices, if there are some.
    pub colours: Option<&'a [[u16; 4]]>,
    /// The file of the report.
    pub beside: Option<&'a Destination>,
}

/// The vertices whose displacements a frame has.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum MovedVertices {
    /// Those of the surface.
    Surface,
    /// The drawn ones, which may part where the surface is welded.
    Drawn,
}

/// An animation that is being written.
pub(crate) struct AnimationWriter<'a> {
    files: AnimationFiles<'a>,
    watch: &'a Watch,
    staging: &'a Staging,
    frames: Frames,
    sink: Sink,
    next: usize,
    rest: Vec<DVec3>,
    positions: Vec<DVec3>,
    written: Written,
}

/// The course of the writing.
#[derive(Default)]
pub(crate) struct Written {
    /// The time of all saves, in milliseconds.
    pub save_ms: f64,
    /// Sentences that a person should know, each once.
    pub warnings: Vec<String>,
    /// The morph targets of a glTF.
    pub morph: Option<MorphReport>,
}

/// The frames so far.
enum Sink {
    Files(Option<Staged>),
    /// A cache, and the drawn vertex at which each of its points is.
    Cache(PointCache, Vec<Option<DrawnVertex>>),
    Morphs(Box<ShapeDirections>),
}

impl<'a> AnimationWriter<'a> {
    /// Begins to write.
    ///
    /// # Errors
    /// The name of the output is not one of an animation.
    pub fn new(files: AnimationFiles<'a>, watch: &'a Watch, staging: &'a Staging) -> Result<Self, EngineError> {
        let model = &files.loaded.model;
        let sink = match Kind::of(files.output)? {
            Kind::Files => Sink::Files(None),
            Kind::Morphs => Sink::Morphs(Box::new(ShapeDirections::within(files.bound()))),
            Kind::Cache(format) => {
                // A vertex of the file that is seen through several nodes is at the first of its places.
                let mut shown_at = vec![None; model.drawn.file_vertex_count()];
                for (vertex, file_vertex) in (0..).zip(model.drawn.file_vertices()) {
                    shown_at[file_vertex.index()].get_or_insert(DrawnVertex(vertex));
                }
                let points = u32::try_from(shown_at.len()).unwrap_or(u32::MAX);
                let cache = PointCache::new(format, files.count as u32, points, files.fps);
                Sink::Cache(cache, shown_at)
            }
        };
        Ok(Self {
            frames: Frames::of(files.output, files.count.saturating_sub(1)),
            rest: model.rest_positions(),
            files,
            watch,
            staging,
            sink,
            next: 0,
            positions: Vec::new(),
            written: Written::default(),
        })
    }

    /// Takes the next frame: the displacement of each moved vertex since rest.
    ///
    /// # Errors
    /// A file that can't be written.
    pub fn push(&mut self, displacements: &[DVec3]) -> Result<(), EngineError> {
        let place = self.frames.at(self.next);
        self.next += 1;
        if let Sink::Morphs(directions) = &mut self.sink {
            directions.push(displacements);
            return Ok(());
        }
        match self.files.moved {
            MovedVertices::Surface => self
                .files
                .loaded
                .model
                .drawn_positions(displacements, &mut self.positions),
            MovedVertices::Drawn => {
                let moved = self.rest.iter().zip(displacements);
                self.positions.clear();
                self.positions
                    .extend(moved.map(|(rest, way)| match *way == DVec3::ZERO {
                        true => *rest,
                        false => *rest + *way,
                    }));
            }
        }
        if let Sink::Cache(cache, shown_at) = &mut self.sink {
            let positions = &self.positions;
            let place = |shown: &Option<DrawnVertex>| shown.map_or(DVec3::ZERO, |vertex| positions[vertex.index()]);
            cache.push(shown_at.iter().map(place));
        } else if let Some(place) = place {
            let positions = std::mem::take(&mut self.positions);
            let saved = self.saved(&SaveAs {
                inside_out: self.files.inside_out,
                colours: self.files.colours,
                beside: self.files.beside.map(|report| ("--report", report)),
                ..SaveAs::shape(&positions, &place)
            })?;
            self.positions = positions;
            if let Sink::Files(staged) = &mut self.sink {
                *staged = Some(match staged.take() {
                    Some(staged) => staged.and(saved),
                    None => saved,
                });
            }
        }
        Ok(())
    }

    /// The files, ready to be committed, and the course of the writing.
    ///
    /// # Errors
    /// A file that can't be written.
    pub fn finish(mut self) -> Result<(Staged, Written), EngineError> {
        let staged = match std::mem::replace(&mut self.sink, Sink::Files(None)) {
            Sink::Files(staged) => staged.ok_or(EngineError::Interrupted),
            Sink::Cache(cache, _) => self.cache(cache),
            Sink::Morphs(directions) => self.morphs(*directions),
        };
        Ok((staged?, self.written))
    }

    /// The same where no frame differs from the file's own animation: a glTF then stays as it is.
    ///
    /// # Errors
    /// A file that can't be written.
    pub fn finish_unchanged(mut self) -> Result<(Staged, Written), EngineError> {
        if !matches!(self.sink, Sink::Morphs(_)) {
            return self.finish();
        }
        let rest = std::mem::take(&mut self.rest);
        let staged = self.saved(&SaveAs {
            beside: self.files.beside.map(|report| ("--report", report)),
            ..SaveAs::shape(&rest, self.files.output)
        })?;
        Ok((staged, self.written))
    }

    fn cache(&mut self, cache: PointCache) -> Result<Staged, EngineError> {
        let start = Instant::now();
        let file = NewFile {
            to: Destination::of(self.files.output)?,
            bytes: &cache.into_bytes(),
        };
        let staged = self
            .staging
            .stage_watched(&[file], None, &Progress::new(), &self.watch.cancel);
        self.written.save_ms += ms_since(start);
        staged
    }

    /// Writes a glTF with an animation of morph targets.
    fn morphs(&mut self, directions: ShapeDirections) -> Result<Staged, EngineError> {
        self.watch.begin("finding morph targets");
        let FewTargets {
            targets,
            weights,
            error,
        } = directions.targets();
        let targets: Vec<Vec<DVec3>> = match self.files.moved {
            MovedVertices::Drawn => targets,
            MovedVertices::Surface => targets.iter().map(|target| self.of_drawn(target)).collect(),
        };
        let steady = || {
            (0..self.files.count)
                .map(|frame| frame as f64 / self.files.fps)
                .collect()
        };
        let times: Vec<f64> = self.files.times.map_or_else(steady, <[f64]>::to_vec);
        let animation = MorphAnimation {
            name: self.files.name,
            times: &times,
            weights: &weights,
            targets: &targets,
            holds: self.files.holds,
        };
        self.written.morph = Some(MorphReport {
            targets: animation.target_names().len(),
            bound: self.files.bound(),
            largest_error: error,
            diagonal: self.files.diagonal(),
        });
        let rest = std::mem::take(&mut self.rest);
        let save = SaveAs {
            inside_out: self.files.inside_out,
            colours: self.files.colours,
            animation: Some(&animation),
            beside: self.files.beside.map(|report| ("--report", report)),
            ..SaveAs::shape(&rest, self.files.output)
        };
        let progress = self.watch.begin("saving");
        let staged = self.saved(&save);
        progress.set(1.0);
        staged
    }

    /// The displacements of the drawn vertices.
    fn of_drawn(&self, of_surface: &[DVec3]) -> Vec<DVec3> {
        let mut out = Vec::new();
        let way = |vertex: SurfaceVertex| of_surface[vertex.index()];
        let model = &self.files.loaded.model;
        model.spread(way, |_, vertex| vertex.map_or(DVec3::ZERO, way), &mut out);
        out
    }

    /// Stages one save, and keeps its warnings and its time.
    fn saved(&mut self, save: &SaveAs<'_>) -> Result<Staged, EngineError> {
        let start = Instant::now();
        let cancel = &self.watch.cancel;
        let saved = saving::stage(self.files.loaded, save, self.staging, &Progress::new(), cancel)?;
        self.written.save_ms += ms_since(start);
        for warning in saved.warnings {
            if !self.written.warnings.contains(&warning) {
                self.written.warnings.push(warning);
            }
        }
        Ok(saved.staged)
    }
}

impl AnimationFiles<'_> {
    fn diagonal(&self) -> f64 {
        self.loaded.model.bounds().map_or(0.0, |bounds| bounds.diagonal())
    }

    /// The largest error of a glTF's frames, in world units.
    fn bound(&self) -> f64 {
        self.tolerance * self.diagonal()
    }
}
