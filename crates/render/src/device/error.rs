//! What can go wrong, each in one sentence that names the culprit and the remedy.

/// No device to draw with.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum NoGpu {
    /// No adapter of any backend, not even a software one.
    #[error("no graphics device was found; install a Vulkan driver (a software one such as Mesa's lavapipe is enough)")]
    NoAdapter,
    /// An adapter was found, but it gave no device.
    #[error("the graphics device {name} can't be used ({reason}); update its driver")]
    Refused {
        /// The adapter's name.
        name: String,
        /// What it said, in one line.
        reason: String,
    },
    /// The device was opened, but our pipelines could not be made on it.
    #[error("drawing can't start on the graphics device {name}: {reason}")]
    Unusable {
        /// The adapter's name.
        name: String,
        /// What went wrong, in one sentence.
        reason: String,
    },
}

/// A drawing or an upload that failed; what was drawn before still stands.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum RenderError {
    /// A slice whose length contradicts the number of vertices.
    #[error("{what}: {found} entries for {expected} vertices; give one entry a vertex")]
    Length {
        /// Which slice.
        what: &'static str,
        /// The number of vertices.
        expected: usize,
        /// The slice's length.
        found: usize,
    },
    /// A triangle that names a vertex which does not exist.
    #[error("triangle {triangle} names vertex {vertex}, but there are only {vertices} vertices")]
    NoSuchVertex {
        /// The triangle's number.
        triangle: usize,
        /// The vertex it names.
        vertex: u32,
        /// The number of vertices.
        vertices: usize,
    },
    /// A group, material or texture number out of range.
    #[error("{what} {number} does not exist, there are {count}")]
    NoSuch {
        /// What is numbered.
        what: &'static str,
        /// The number given.
        number: usize,
        /// How many there are.
        count: usize,
    },
    /// An image whose bytes contradict its size.
    #[error("texture {texture} of {width} by {height} pixels has {found} bytes; four a pixel are needed")]
    TextureBytes {
        /// The texture's number.
        texture: usize,
        /// Its width in pixels.
        width: u32,
        /// Its height in pixels.
        height: u32,
        /// The bytes given.
        found: usize,
    },
    /// A buffer that this device can't hold.
    #[error("{what} need {bytes} bytes, but this device's buffers end at {limit}; open a smaller mesh")]
    TooLarge {
        /// What the buffer holds.
        what: &'static str,
        /// Bytes needed.
        bytes: u64,
        /// The device's limit in bytes.
        limit: u64,
    },
    /// A picture larger than memory, or a view larger than the device can draw.
    #[error("a picture of {width} by {height} pixels is too large for this device; ask for a smaller one")]
    PictureTooLarge {
        /// Width asked for, in pixels.
        width: u32,
        /// Height asked for, in pixels.
        height: u32,
    },
    /// A picture without pixels.
    #[error("a picture needs at least one pixel a side, not {width} by {height}")]
    EmptyPicture {
        /// Width asked for, in pixels.
        width: u32,
        /// Height asked for, in pixels.
        height: u32,
    },
    /// The device can't number triangles, so nothing can be picked through it.
    #[error("this graphics device can't number triangles; pick with a ray instead")]
    NoTriangleNumbers,
    /// Out of memory on the device.
    #[error("the graphics device ran out of memory {doing}; close other programs or open a smaller mesh")]
    OutOfMemory {
        /// What we were doing.
        doing: &'static str,
    },
    /// The device was lost or could not answer.
    #[error("the graphics device stopped answering while {doing}; reopen the view")]
    Lost {
        /// What we were doing.
        doing: &'static str,
    },
    /// The device refused a command: a fault of ours.
    #[error("the graphics device refused a command {doing}: {reason}")]
    Refused {
        /// What we were doing.
        doing: &'static str,
        /// The device's words.
        reason: String,
    },
}
