//! The three vertex sets' id types.

macro_rules! vertex_id {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug, Default)]
        #[repr(transparent)]
        pub struct $name(pub u32);

        impl $name {
            /// The id as an index into a table of its own vertex set.
            #[inline]
            pub const fn index(self) -> usize {
                self.0 as usize
            }
        }
    };
}

vertex_id! {
    /// A vertex as the file numbers it (`docs/edit-format.md`): an OBJ `v` line, a PLY or OFF vertex, an STL
    /// corner, an element of a glTF POSITION accessor.
    FileVertex
}
vertex_id! {
    /// A file vertex seen through one node. Drawn vertices are rendered and picked.
    DrawnVertex
}
vertex_id! {
    /// A welded vertex in world space. The solver works on surface vertices.
    SurfaceVertex
}
