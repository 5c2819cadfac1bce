//! Events: pointer, keys, commands, results of jobs and opened files.
//!
//! Events are data, so that tests, scripts and the window drive the program through the same function,
//! [`Editor::handle`](crate::Editor::handle).

use std::sync::Arc;

use glam::DVec2;
use pliant_deform::Method;
use pliant_mesh::Model;

use crate::Beginning;
use crate::command::{Command, KeyMap};
use crate::document::{SaveMark, SavedAs};
use crate::input::{Button, Key, Modifiers, Pointer};
use crate::jobs::JobDone;
use crate::snapshot::Snapshot;

/// One thing that happened. No event carries the time: the editor has no clock.
#[derive(Debug)]
pub enum Event {
    /// The 3D view has this size, in points. Sent before the first pointer event and whenever it changes.
    Viewport {
        /// Width and height in points, both positive.
        size_px: DVec2,
    },
    /// The pointer moved within the view, or anywhere while a button is held.
    PointerMoved(Pointer),
    /// The pointer has stood still over the view for a moment: it means what lies under it.
    PointerRested,
    /// The pointer left the view: nothing is hovered any more.
    PointerLeft,
    /// A button went down over the view.
    PointerPressed(Pointer, Button),
    /// A button went up.
    PointerReleased(Pointer, Button),
    /// The wheel turned or two fingers scrolled by `lines` (positive: towards the surface).
    Wheel {
        /// Where the pointer stands.
        pointer: Pointer,
        /// Notches of a mouse wheel; fractions for smooth scrolling.
        lines: f64,
    },
    /// Two fingers pinched: `factor` above 1 comes closer.
    Pinch {
        /// Where the pointer stands.
        pointer: Pointer,
        /// The ratio of the fingers' distances since the last event.
        factor: f64,
    },
    /// How hard the pen presses, 0 to 1; `None` for a device that reports no force.
    Pressure(Option<f64>),
    /// A key went down (repeats of a held key included). Characters come in lower case, one event a key.
    Key(Key, Modifiers),
    /// A key went up.
    KeyReleased(Key),
    /// Something a menu, a button or the command palette asks for.
    Command(Command),
    /// A person's choice of keys.
    Keys(KeyMap),
    /// The most memory in bytes that a person lets bindings take; `None`: what there is.
    Memory(Option<u64>),
    /// A widget is being dragged: the command's change is shown, and becomes one step of the history with all that
    /// follow until [`Event::Adjusted`].
    Adjust(Command),
    /// The widget was let go.
    Adjusted,
    /// A job that the executor was given has ended, or has an intermediate result.
    JobDone(JobDone),
    /// A file was loaded and welded; `beginning` is what is to be set up on it.
    Opened {
        /// What the file shows and its welded surface.
        model: Arc<Model>,
        /// The file's name, for the status line.
        name: String,
        /// Regions, handles and transforms to begin with; `None` begins afresh.
        beginning: Option<Beginning>,
    },
    /// Takes over another editor's document, except the method: the same handles, bent by `method`. The results of this
    /// editor's own jobs come by [`Event::JobDone`].
    Follow {
        /// What the other editor has.
        leader: Box<Snapshot>,
        /// By which method this one bends.
        method: Method,
    },
    /// The document was recovered from a session that ended without saving, or carried over to a file that another program
    /// has changed: no file has it, and such a one is needed.
    Recovered(SavedAs),
    /// The document was written to a file as it stood at the mark ([`Editor::save_mark`](crate::Editor::save_mark)).
    Saved(SavedAs, SaveMark),
}
