//! Events: pointer, keys, commands, results of jobs and opened files.
//!
//! Events are data, so that tests, scripts and the window drive the program through the same function,
//! [`Editor::handle`](crate::Editor::handle).

use std::sync::Arc;

use glam::{DVec2, DVec3};
use pliant_mesh::Model;

use crate::Beginning;
use crate::command::{Command, KeyMap};
use crate::document::{SaveMark, SavedAs};
use crate::input::{Button, Key, Modifiers, Pointer};
use crate::jobs::JobDone;
use crate::stitching::NewMesh;
use crate::timeline::{FollowedFrame, Following};

/// An event. No event carries the time: the editor has no clock.
#[derive(Debug)]
pub enum Event {
    /// The 3D view has this size, in points. It is sent before the first pointer event and after every change.
    Viewport {
        /// Width and height in points, both positive.
        size_px: DVec2,
    },
    /// The pointer moved within the view, or anywhere while a button is held.
    PointerMoved(Pointer),
    /// The pointer has rested over the view for a moment.
    PointerRested,
    /// The pointer left the view: nothing is hovered.
    PointerLeft,
    /// A button went down over the view.
    PointerPressed(Pointer, Button),
    /// A button went up.
    PointerReleased(Pointer, Button),
    /// The wheel turned or two fingers scrolled by `lines` (positive: towards the surface).
    Wheel {
        /// The pointer's position.
        pointer: Pointer,
        /// Notches of a mouse wheel; fractions for smooth scrolling.
        lines: f64,
    },
    /// Two fingers pinched: `factor` above 1 comes closer.
    Pinch {
        /// The pointer's position.
        pointer: Pointer,
        /// The ratio of the fingers' distances since the last event.
        factor: f64,
    },
    /// The pen's pressure, 0 to 1; `None` for a device that reports no force.
    Pressure(Option<f64>),
    /// A key went down (repeats of a held key included). Characters come in lower case, one event per key.
    Key(Key, Modifiers),
    /// A key went up.
    KeyReleased(Key),
    /// A command from a menu, a button or the command palette.
    Command(Command),
    /// A person's choice of keys.
    Keys(KeyMap),
    /// The most memory in bytes that a person allows for bindings; `None` is all available memory.
    Memory(Option<u64>),
    /// A widget is being dragged: the command's change is shown, and all changes until [`Event::Adjusted`] become one
    /// step of the history.
    Adjust(Command),
    /// The widget was let go.
    Adjusted,
    /// The window is about to draw a frame while an animation plays or events that have waited are handled.
    Tick,
    /// A job given to the executor has ended, or has an intermediate result.
    JobDone(JobDone),
    /// A file was loaded and welded; `beginning` is set up on it.
    Opened {
        /// The file's scene and its welded surface.
        model: Arc<Model>,
        /// The file's name, for the status line.
        name: String,
        /// Regions, handles and transforms to begin with; `None` begins afresh.
        beginning: Option<Beginning>,
    },
    /// The opened file is a frame of a sequence of so many frames, at least one: the others are asked for by
    /// [`SceneView::wanted_frame`](crate::SceneView::wanted_frame).
    OpenedSequence {
        /// The number of frames.
        count: usize,
        /// The frame to show; `None` is the document's own.
        shown: Option<usize>,
        /// The frames a second at which it is played; `None` is the document's own.
        fps: Option<f64>,
    },
    /// A frame of the sequence was read: the displacements of its surface vertices from the file's shape, or the reason
    /// why it can't be shown, in one sentence.
    Frame(usize, Result<Arc<Vec<DVec3>>, String>),
    /// A frame of the other sequence that leads handles, by the sequence's name and its number: the displacements of its
    /// surface vertices from the file's shape, or the reason why it can't be read, in one sentence.
    MixFrame(String, usize, Result<Arc<Vec<DVec3>>, String>),
    /// All frames of the sequence were followed, as [`SceneView::wants_following`](crate::SceneView::wants_following)
    /// asks, with the handles of [`Editor::following`](crate::Editor::following), or the reason why they can't be, in one sentence.
    Followed(Following, Result<Vec<FollowedFrame>, String>),
    /// A change of the mesh ([`Editor::take_stitch`](crate::Editor::take_stitch)) has ended: the new mesh, or the reason
    /// why there is none, in one sentence.
    Stitched(Result<Box<NewMesh>, String>),
    /// The document was recovered from a session that ended without saving, or carried over to a file that another
    /// program has changed: no file has it, and one is needed.
    Recovered(SavedAs),
    /// The document was written to a file in the state of the mark ([`Editor::save_mark`](crate::Editor::save_mark)).
    Saved(SavedAs, SaveMark),
}
