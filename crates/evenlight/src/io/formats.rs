//! The formats that surfaces are written in, by the endings of their names.
//!
//! ```text
//! surface --tessellate--> triangles --MeshFormat::write---> .obj .ply .stl .glb
//!    +--------------------------------PatchFormat::write--> .bv .json
//! ```

use std::io::{self, Write};
use std::path::Path;

use super::{bv, glb, obj_out, patch_json, ply_out, stl};
use crate::Surface;
use crate::mesh::Primvar;
use crate::tessellate::{CornerPrimvars, TriangleMesh};

/// Files that hold triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum MeshFormat {
    /// Wavefront OBJ with normals, hard at infinitely sharp edges, texture coordinates and colours.
    Obj,
    /// PLY with one normal, Gauss and mean curvature and colour per vertex, texture coordinates.
    Ply,
    /// Binary STL.
    Stl,
    /// Binary glTF with normals, hard at infinitely sharp edges, Gauss and mean curvature, all sets
    /// of texture coordinates, and colours.
    Glb,
}

impl MeshFormat {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Obj, Self::Ply, Self::Stl, Self::Glb];

    /// How the names of such files end, without the point.
    pub fn extension(self) -> &'static str {
        match self {
            Self::Obj => "obj",
            Self::Ply => "ply",
            Self::Stl => "stl",
            Self::Glb => "glb",
        }
    }

    /// The format of files that end in `.extension`, in small or capital letters.
    ///
    /// ```
    /// use evenlight::io::MeshFormat;
    ///
    /// assert_eq!(MeshFormat::from_extension("GLB"), Some(MeshFormat::Glb));
    /// assert_eq!(MeshFormat::from_extension("step"), None);
    /// ```
    pub fn from_extension(extension: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|format| format.extension().eq_ignore_ascii_case(extension))
    }

    /// The format that the ending of a file's name tells, if it does.
    pub fn from_path(path: impl AsRef<Path>) -> Option<Self> {
        Self::from_extension(path.as_ref().extension()?.to_str()?)
    }

    /// Whether such a file can hold texture coordinates or colours.
    pub fn has_primvars(self) -> bool {
        self != Self::Stl
    }

    /// Writes `mesh` with those of its `primvars` that the format can hold. Writes many small
    /// pieces: give it something with a buffer.
    ///
    /// # Errors
    ///
    /// Those of `out`; and a mesh that is too large for the format.
    pub fn write(
        self,
        mesh: &TriangleMesh,
        primvars: &CornerPrimvars,
        out: &mut impl Write,
    ) -> io::Result<()> {
        match self {
            Self::Obj => obj_out::write_textured(mesh, primvars, out),
            Self::Ply => ply_out::write_textured(mesh, primvars, out),
            Self::Stl => stl::write(mesh, out),
            Self::Glb => glb::write_textured(mesh, primvars, out),
        }
    }

    /// What of the cage of `surface` [`MeshFormat::write`] leaves out of a file with `mesh` and
    /// `primvars`, in sentences.
    pub fn omitted(
        self,
        surface: &Surface,
        mesh: &TriangleMesh,
        primvars: &CornerPrimvars,
    ) -> Vec<String> {
        let mut sentences = match self {
            Self::Obj => obj_out::omitted(mesh, primvars),
            Self::Ply => ply_out::omitted(mesh, primvars),
            Self::Stl | Self::Glb => Vec::new(),
        };
        let others = other_primvars(surface, primvars);
        if !others.is_empty() {
            sentences.push(format!("{}: {} left out", self.held(), others.join(", ")));
        }
        sentences
    }

    /// What such files hold beside positions and normals.
    fn held(self) -> &'static str {
        match self {
            Self::Stl => "STL holds nothing but triangles",
            Self::Obj | Self::Ply | Self::Glb => {
                "of the primvars, the file has those of two numbers (texture coordinates) and the \
                 first named `color` or `displayColor` of three or four"
            }
        }
    }
}

/// The names of the primvars of the cage that are not in `primvars`.
fn other_primvars(surface: &Surface, primvars: &CornerPrimvars) -> Vec<String> {
    let is_carried = |primvar: &&Primvar| {
        let mut carried = primvars.uv_sets.iter().chain(&primvars.color);
        carried.any(|values| values.name == primvar.name)
    };
    let others = surface.primvars().iter().filter(|primvar| !is_carried(primvar));
    others.map(|primvar| format!("`{}`", primvar.name)).collect()
}

/// Files that hold patches.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum PatchFormat {
    /// BezierView: one group per role, patches of type 5 ([`bv`]).
    Bv,
    /// JSON, one object per patch ([`patch_json`]).
    Json,
}

impl PatchFormat {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Bv, Self::Json];

    /// How the names of such files end, without the point.
    pub fn extension(self) -> &'static str {
        match self {
            Self::Bv => "bv",
            Self::Json => "json",
        }
    }

    /// The format of files that end in `.extension`, in small or capital letters.
    pub fn from_extension(extension: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|format| format.extension().eq_ignore_ascii_case(extension))
    }

    /// The format that the ending of a file's name tells, if it does.
    pub fn from_path(path: impl AsRef<Path>) -> Option<Self> {
        Self::from_extension(path.as_ref().extension()?.to_str()?)
    }

    /// Writes all regular patches, `rings` rings and, if it is closed, the caps of `surface`.
    /// Writes many small pieces: give it something with a buffer.
    ///
    /// # Errors
    ///
    /// Those of `out`.
    pub fn write(self, surface: &Surface, rings: usize, out: &mut impl Write) -> io::Result<()> {
        match self {
            Self::Bv => bv::write(surface.patches(rings), out),
            Self::Json => patch_json::write(surface, rings, out),
        }
    }
}
