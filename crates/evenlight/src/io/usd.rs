//! USD as text (`.usda`): one `UsdGeomMesh`, with its subdivision rules and primvars, in and out.
//!
//! The whole text grammar is read, and of it these parts are understood:
//!
//! ```text
//! #usda 1.0
//! def Xform "World" {
//!     double3 xformOp:translate = (0, 0, 1)             all of xformOpOrder is applied to points
//!     uniform token[] xformOpOrder = ["xformOp:translate"]
//!     def Mesh "Cage" {
//!         point3f[] points = [(0, 0, 0), ...]           needed
//!         int[] faceVertexCounts = [4, ...]             needed
//!         int[] faceVertexIndices = [0, 1, 2, 3, ...]   needed
//!         uniform token orientation = "leftHanded"      faces are turned round
//!         uniform token interpolateBoundary = "edgeAndCorner"            or edgeOnly, none
//!         uniform token faceVaryingLinearInterpolation = "cornersPlus1"  and the other five
//!         int[] creaseIndices, creaseLengths; float[] creaseSharpnesses
//!         int[] cornerIndices; float[] cornerSharpnesses; int[] holeIndices
//!         texCoord2f[] primvars:st = [...] (interpolation = "faceVarying")   or vertex, varying
//!         int[] primvars:st:indices = [...]
//!     }
//! }
//! ```
//!
//! A scheme other than `catmullClark`, smooth triangles, primvars that are constant, uniform or no
//! numbers, and composition (references, payloads, variants ...) are reported, not followed. Of
//! values over time the first counts if there is no other. Primvars of corners without indices
//! are joined where a vertex has the same value. `displayColor` is the primvar `color`, and
//! `evenlight:creaseMethod` (`uniform` or `chaikin`) is our own.
//!
//! Numbers are read with 64 bits, though the types of USD say 32. Vertices and faces are counted
//! from 0. Reading stops at the first fault.

use std::fmt;
use std::io::Write;

use super::lines::Lines;
use crate::mesh::Mesh;

mod attributes;
mod cage;
mod lexer;
mod parse;
mod scene;
mod transform;
mod write;

/// What a USD file says of one mesh.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Usd {
    /// The path of the mesh, as in `/World/Cage`.
    pub path: String,
    /// The mesh, in the coordinates of the stage.
    pub mesh: Mesh,
    /// Where its points stand.
    pub lines: Lines,
    /// What was skipped or changed, in sentences.
    pub remarks: Vec<String>,
}

/// Why a file cannot be read: its first fault.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UsdError {
    /// The line of the fault, from 1.
    pub line: usize,
    /// What is wrong and what to do, in a sentence.
    pub message: String,
}

impl fmt::Display for UsdError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}: {}", self.line, self.message)
    }
}

impl std::error::Error for UsdError {}

/// Reads the mesh at the path `prim` (or the only one below it) of a USD file, or the only mesh of
/// the file. Time and memory are linear in its length.
///
/// The mesh is not checked, but every number in it is of something that exists.
///
/// # Errors
///
/// The first fault: of the text, or of an attribute; no mesh or several where one is asked for.
///
/// ```
/// use evenlight::io::usd;
///
/// let text = "#usda 1.0\ndef Mesh \"Cage\" {\n\
///     point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, .5)]\n\
///     int[] faceVertexCounts = [3]\nint[] faceVertexIndices = [0, 1, 2]\n}\n";
/// let usd = usd::read(text.as_bytes(), None)?;
/// assert_eq!((usd.path.as_str(), usd.mesh.positions[2]), ("/Cage", [0.0, 1.0, 0.5]));
///
/// let error = usd::read(text.replace("1, 2]", "1, 3]").as_bytes(), None).unwrap_err();
/// assert!(error.to_string().starts_with("line 5: `faceVertexIndices` asks for vertex 3"));
/// # Ok::<(), usd::UsdError>(())
/// ```
pub fn read(bytes: &[u8], prim: Option<&str>) -> Result<Usd, UsdError> {
    let layer = parse::read(bytes)?;
    let found = scene::find_mesh(&layer, prim)?;
    cage::read(&found)
}

/// Writes `mesh` as the only prim, `/Cage`, of a USD file. [`omitted`] tells what this leaves out.
///
/// The same mesh always gives the same bytes, and [`read`] returns it, except that NaN is not
/// equal to itself.
///
/// # Errors
///
/// Those of `out`.
pub fn write(mesh: &Mesh, out: &mut impl Write) -> std::io::Result<()> {
    write::write(mesh, out)
}

/// What [`write()`] leaves out of `mesh`, in sentences: primvars whose names or sizes are not fit
/// for primvars.
pub fn omitted(mesh: &Mesh) -> Vec<String> {
    write::omitted(mesh)
}
