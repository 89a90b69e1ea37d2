//! Patches as JSON, one object per patch.
//!
//! ```text
//! { "scheme": "qas4", "rules": "generated", "contraction": "cc", "rings": 6, "patches": [
//!   { "role": "ring-1",                  "regular", "ring-1", "ring-2", ... or "cap"
//!     "face": 4,                         numbers count from 0
//!     "corner": null,                    of the face, if that is an n-gon
//!     "vertex": 7,                       the extraordinary vertex; null for regular patches
//!     "centre_of": null,                 the n-gon around whose centre the patch lies
//!     "sector": 0, "ring": 1,
//!     "domain": [[0.0, 0.5], [0.5, 1.0]],    [[u0, u1], [v0, v1]] in the face's unit square
//!     "degree": [4, 4],
//!     "coefficients": [[x, y, z], ...]   (du + 1) (dv + 1) points, v index fastest
//!   }, ... ] }
//! ```
//!
//! The file has no blanks and no line ends but the last. `rules` is `null` for schemes without
//! tables.

use std::fmt::{self, Write as _};
use std::io::{self, Write};

use super::digits::JsonNumber;
use crate::Surface;
use crate::scheme::{RuleSet, SchemeKind};
use crate::surface::{PlacedPatch, Role, SurfaceOptions};

/// Writes all regular patches, `rings` rings and, if it is closed, the caps of `surface`
/// ([`Surface::patches`]).
///
/// Patches are made and written one by one: there can be millions. Coordinates are in the units of
/// the cage, with the fewest digits from which the same `f64` is read again; what is no finite
/// number is `null`. Writes many small pieces: give it something with a buffer.
///
/// # Errors
///
/// Those of `out`.
///
/// ```
/// use evenlight::io::{load::Format, patch_json};
/// use evenlight::{Surface, SurfaceOptions};
///
/// let quad = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
/// let surface = Surface::build(Format::Obj.read_cage(quad)?.0, SurfaceOptions::default())?;
/// let mut text = Vec::new();
/// patch_json::write(&surface, 1, &mut text)?;
/// assert!(text.starts_with(br#"{"scheme":"qas4","rules":"generated","contraction":"cc""#));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write(surface: &Surface, rings: usize, out: &mut impl Write) -> io::Result<()> {
    let options = surface.options();
    write!(
        out,
        r#"{{"scheme":"{}","rules":{},"contraction":"{}","rings":{rings},"patches":["#,
        options.scheme.name(),
        Json(rules(options).map(Quoted)),
        options.contraction,
    )?;
    for (k, patch) in surface.patches(rings).enumerate() {
        let comma = if k > 0 { "," } else { "" };
        write!(out, "{comma}{}", Record { surface, placed: &patch })?;
    }
    out.write_all(b"]}\n")
}

/// The tables; `None` for a scheme without.
fn rules(options: SurfaceOptions) -> Option<RuleSet> {
    (options.scheme != SchemeKind::CatmullClark).then_some(options.rules)
}

/// The object of one patch.
struct Record<'a> {
    surface: &'a Surface,
    placed: &'a PlacedPatch,
}

impl fmt::Display for Record<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { surface, placed: PlacedPatch { place, patch } } = self;
        let (face, corner) = surface.face_of(place.quad).ok_or(fmt::Error)?;
        let is_quad = surface.topology().faces().corners(face).len() == 4;
        let center = place.point.map(|i| &surface.extraordinary_points()[i]);
        let [du, dv] = patch.degree();
        write!(
            f,
            r#"{{"role":"{}","face":{},"corner":{},"vertex":{},"centre_of":{},"sector":{},"ring":{}"#,
            place.role,
            face.0,
            Json((!is_quad).then_some(corner)),
            Json(center.and_then(|p| p.vertex()).map(|v| v.0)),
            Json(center.and_then(|p| p.face()).map(|f| f.0)),
            Json(place.sector),
            Json(ring(place.role)),
        )?;
        f.write_str(r#","domain":"#)?;
        write_rows(f, &place.domain)?;
        write!(f, r#","degree":[{du},{dv}],"coefficients":"#)?;
        write_rows(f, patch.coefs())?;
        f.write_char('}')
    }
}

/// `[[x, y, ...], ...]`.
fn write_rows<const N: usize>(f: &mut fmt::Formatter<'_>, rows: &[[f64; N]]) -> fmt::Result {
    f.write_char('[')?;
    for (k, row) in rows.iter().enumerate() {
        f.write_str(if k > 0 { ",[" } else { "[" })?;
        for (k, &x) in row.iter().enumerate() {
            write!(f, "{}{}", if k > 0 { "," } else { "" }, JsonNumber(x))?;
        }
        f.write_char(']')?;
    }
    f.write_char(']')
}

/// The number of a ring in files, where rings count from 1.
fn ring(role: Role) -> Option<usize> {
    match role {
        Role::Ring(k) => Some(k + 1),
        Role::Regular | Role::Cap => None,
    }
}

/// A value, or `null`.
struct Json<T>(Option<T>);

impl<T: fmt::Display> fmt::Display for Json<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.0 {
            Some(value) => value.fmt(f),
            None => f.write_str("null"),
        }
    }
}

/// A word without characters that JSON must escape.
struct Quoted(RuleSet);

impl fmt::Display for Quoted {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "\"{}\"", self.0)
    }
}
