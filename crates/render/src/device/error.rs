//! Errors. Each message is one sentence that names the cause and the remedy.

/// The reason why no device can draw.
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
        /// The driver's message, in one line.
        reason: String,
    },
    /// The device was opened, but creating the renderer on it failed.
    #[error("drawing can't start on the graphics device {name}: {reason}")]
    Unusable {
        /// The adapter's name.
        name: String,
        /// The fault, in one sentence.
        reason: String,
    },
}

/// The reason why drawing or uploading failed; the earlier picture is still there.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum RenderError {
    /// A slice whose length differs from the number of vertices.
    #[error("{what}: {found} entries for {expected} vertices; give one entry a vertex")]
    Length {
        /// The slice's name.
        what: &'static str,
        /// The number of vertices.
        expected: usize,
        /// The slice's length.
        found: usize,
    },
    /// A triangle with a vertex index out of range.
    #[error("triangle {triangle} names vertex {vertex}, but there are only {vertices} vertices")]
    NoSuchVertex {
        /// The triangle's number.
        triangle: usize,
        /// The vertex index.
        vertex: u32,
        /// The number of vertices.
        vertices: usize,
    },
    /// A group, material or texture index out of range.
    #[error("{what} {number} does not exist: there are {count}")]
    NoSuch {
        /// The kind of index.
        what: &'static str,
        /// The index.
        number: usize,
        /// The number of entries.
        count: usize,
    },
    /// An image whose number of bytes does not match its size.
    #[error("texture {texture} of {width} by {height} pixels has {found} bytes; four a pixel are needed")]
    TextureBytes {
        /// The texture's index.
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
        /// The buffer's contents.
        what: &'static str,
        /// The buffer's size in bytes.
        bytes: u64,
        /// The device's limit in bytes.
        limit: u64,
    },
    /// A picture that does not fit in memory, or a view beyond the device's texture limit.
    #[error("a picture of {width} by {height} pixels is too large for this device; ask for a smaller one")]
    PictureTooLarge {
        /// Requested width in pixels.
        width: u32,
        /// Requested height in pixels.
        height: u32,
    },
    /// A picture without pixels.
    #[error("a picture needs at least one pixel a side, not {width} by {height}")]
    EmptyPicture {
        /// Requested width in pixels.
        width: u32,
        /// Requested height in pixels.
        height: u32,
    },
    /// The device lacks the primitive index in shaders, which picking needs.
    #[error("this graphics device can't number triangles; pick with a ray instead")]
    NoTriangleNumbers,
    /// The device is out of memory.
    #[error("the graphics device ran out of memory {doing}; close other programs or open a smaller mesh")]
    OutOfMemory {
        /// The renderer's activity.
        doing: &'static str,
    },
    /// The device was lost or does not respond.
    #[error("the graphics device stopped answering while {doing}; reopen the view")]
    Lost {
        /// The renderer's activity.
        doing: &'static str,
    },
    /// The device rejected a command, which is a bug in this crate.
    #[error("the graphics device refused a command {doing}: {reason}")]
    Refused {
        /// The renderer's activity.
        doing: &'static str,
        /// The device's message.
        reason: String,
    },
}
