//! Triangle meshes as binary STL.
//!
//! An 80-byte header, the number of triangles as `u32`, and for each triangle 50 bytes: its
//! normal and its three corners as little-endian `f32`, and two bytes of zero. STL knows no
//! shared vertices and no units: coordinates are those of the cage, rounded to `f32` alike in
//! all triangles of a vertex, so that what was watertight stays so.

use std::io::{self, Write};

use crate::point::{Point, Vector, cross, sub, unit};
use crate::tessellate::TriangleMesh;

/// Must not begin with `solid`: by that word readers recognise the text form.
const HEADER: &[u8; 80] =
    b"Binary STL by Evenlight; coordinates in the units of the cage                   ";

/// Writes `mesh` as binary STL. Writes many small pieces: give it something with a buffer.
///
/// The normals are normals of the flat triangles (`0 0 0` if the corners are on a line), as the
/// format demands, not of the surface.
///
/// # Errors
///
/// What `out` reports; and `InvalidInput`, before anything is written, for 2^32 triangles or
/// more and for coordinates that are too large for 32 bits.
pub fn write(mesh: &TriangleMesh, out: &mut impl Write) -> io::Result<()> {
    let count = triangle_count(mesh.triangles.len())?;
    check_coordinates(&mesh.positions)?;
    out.write_all(HEADER)?;
    out.write_all(&count.to_le_bytes())?;
    for triangle in &mesh.triangles {
        let corners = triangle.map(|v| mesh.positions[v as usize]);
        for x in [facet_normal(corners)].iter().chain(&corners).flatten() {
            out.write_all(&(*x as f32).to_le_bytes())?;
        }
        out.write_all(&[0; 2])?;
    }
    Ok(())
}

fn facet_normal([a, b, c]: [Point; 3]) -> Vector {
    let normal = unit(cross(sub(b, a), sub(c, a)));
    if normal[0].is_nan() { [0.0; 3] } else { normal }
}

fn triangle_count(len: usize) -> io::Result<u32> {
    u32::try_from(len)
        .map_err(|_| invalid(format!("{len} triangles are too many for STL (fewer than 2^32)")))
}

fn check_coordinates(positions: &[Point]) -> io::Result<()> {
    if positions.iter().flatten().all(|&x| (x as f32).is_finite()) {
        return Ok(());
    }
    Err(invalid("a coordinate is too large for the 32 bits of STL: scale the cage".to_owned()))
}

fn invalid(message: String) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidInput, message)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normals_are_right_handed_or_zero() {
        let (o, x, y) = ([0.0; 3], [2.0, 0.0, 0.0], [0.0, 3.0, 0.0]);
        assert_eq!(facet_normal([o, x, y]), [0.0, 0.0, 1.0]);
        assert_eq!(facet_normal([o, x, x]), [0.0; 3]);
    }

    #[test]
    fn the_number_of_triangles_must_fit() {
        assert_eq!(triangle_count(u32::MAX as usize).unwrap(), u32::MAX);
        assert!(triangle_count(1 << 32).is_err());
    }

    #[test]
    fn coordinates_must_fit() {
        let largest = f64::from(f32::MAX);
        assert!(check_coordinates(&[[0.0, -largest, largest]]).is_ok());
        // Half a unit in the last place more is rounded to infinity.
        for x in [1e300, -1e39, f64::from_bits(largest.to_bits() + (1 << 28)), f64::NAN] {
            let error = check_coordinates(&[[0.0; 3], [0.0, x, 0.0]]).unwrap_err();
            assert!(error.to_string().contains("too large for the 32 bits of STL"));
        }
    }
}
