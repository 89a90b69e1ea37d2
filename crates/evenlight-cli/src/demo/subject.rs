//! What the demonstration is about: the cage, and its most telling vertices.

use std::fmt::Write;
use std::sync::Arc;

use evenlight::point::{dot, norm, scale, sub};
use evenlight::rings::Rings;
use evenlight::surface::Sector;
use evenlight::{Cage, Point, SchemeKind, Surface, SurfaceOptions, Vector};

use serde_json::json;

use crate::analyze::Analysis;
use crate::error::Failure;
use crate::input::{self, Source};
use crate::surface;

/// The schemes that are compared.
pub const SCHEMES: [SchemeKind; 3] =
    [SchemeKind::CatmullClark, SchemeKind::EvolvingGuide, SchemeKind::Qas4];

/// The rings that are analysed.
pub const RINGS: usize = 6;

/// How often the points on the way to a vertex halve their distance.
const HALVINGS: i32 = 10;

/// How far the edited quadratic is pushed, as a multiple of the distance from q_1 to q_3.
const DEPTH: f64 = 0.4;

/// Roughly the direction of the eye in the default view.
const EYE: Vector = [0.45, -0.78, 0.42];

/// The cage, and what was measured on its surfaces.
pub struct Subject {
    /// The cage.
    pub cage: Arc<Cage>,
    /// With [`SCHEMES`].
    pub analyses: [Analysis; 3],
}

/// An extraordinary vertex that gets a picture of its own.
pub struct CloseUp {
    /// The vertex, from 0.
    pub vertex: u32,
    /// Its valence.
    pub valence: usize,
    /// The magnification that shows the faces around it.
    pub zoom: f64,
}

/// The vertex whose quadratic is edited.
pub struct Handle {
    /// The vertex, from 0.
    pub vertex: u32,
    /// Its valence.
    pub valence: usize,
    /// Its limit point.
    pub position: Point,
    /// The magnification that shows the faces around it.
    pub zoom: f64,
    /// The largest absolute mean curvature around it, rounded up to a tenth.
    pub largest_mean: f64,
    /// How its quadratic is moved: inwards.
    pub push: Vector,
}

impl Handle {
    /// The file that moves the quadratic.
    pub fn edit(&self) -> String {
        let Self { vertex, push, .. } = self;
        format!("[{}]\n", json!({"vertex": vertex, "affine": {"translation": push}}))
    }
}

impl Subject {
    /// Reads the cage in `source` and analyses its surfaces.
    pub fn new(source: &Source) -> Result<Self, Failure> {
        let cage = input::read_cage(&source.clone().into())?;
        let analyse = |scheme| -> Result<Analysis, Failure> {
            let options = SurfaceOptions { scheme, ..SurfaceOptions::default() };
            let surface = surface::build(Arc::clone(&cage), options, source)?;
            Analysis::of(surface, RINGS)
        };
        let [cc, eg, qas4] = SCHEMES.map(analyse);
        let analyses = [cc?, eg?, qas4?];
        Ok(Self { cage, analyses })
    }

    fn surface(&self) -> &Surface {
        self.analyses[2].surface()
    }

    /// One vertex of every valence, the lowest first: that at which the mean curvature of
    /// Catmull-Clark varies most in the last ring.
    pub fn close_ups(&self) -> Vec<CloseUp> {
        let points = self.surface().extraordinary_points();
        let mut valences: Vec<usize> = points.iter().map(|p| p.valence).collect();
        valences.sort_unstable();
        valences.dedup();
        valences.into_iter().filter_map(|valence| self.close_up(valence)).collect()
    }

    fn close_up(&self, valence: usize) -> Option<CloseUp> {
        let points =
            self.surface().extraordinary_points().iter().zip(self.analyses[0].last_spans());
        let candidates = points.filter_map(|(p, span)| Some((p, p.vertex()?, span)));
        let of_valence = candidates.filter(|(p, ..)| p.valence == valence);
        // The first of all that are equal to rounding, as in a symmetric cage.
        let better = |best: f64, span: f64| span > best * (1.0 + 1e-6);
        let (point, vertex, _) =
            of_valence.reduce(|best, other| if better(best.2, other.2) { other } else { best })?;
        let k = self.surface().extraordinary_points().iter().position(|p| p == point)?;
        let zoom = zoom(self.surface(), k);
        Some(CloseUp { vertex: vertex.0, valence, zoom })
    }

    /// Rows `face,u,v` that halve the distance to each of the vertices along the diagonal of a
    /// face.
    pub fn points_towards(&self, close_ups: &[CloseUp]) -> String {
        let mut text = String::from("face,u,v,corner\n");
        for CloseUp { vertex, valence, .. } in close_ups {
            let points = self.surface().extraordinary_points();
            let point = points.iter().find(|p| p.vertex().is_some_and(|v| v.0 == *vertex));
            if let Some(sector) = point.and_then(|p| p.sectors.first()) {
                text += &format!("# towards vertex {vertex} of valence {valence}\n");
                text += &diagonal(self.surface(), sector);
            }
        }
        text
    }

    /// The vertex of the highest valence whose normal points most to the eye of the default view.
    pub fn handle(&self) -> Option<Handle> {
        let points = self.surface().extraordinary_points().iter().enumerate();
        let vertices = points.filter(|(_, p)| p.vertex().is_some());
        let with_rings = vertices.filter_map(|(k, p)| Some((k, p, self.surface().rings(k)?)));
        let facing = |rings: &Rings| dot(rings.normal(), EYE);
        let (k, point, rings) = with_rings.reduce(|a, b| {
            let is_level = b.1.valence == a.1.valence;
            let is_better = b.1.valence > a.1.valence || is_level && facing(b.2) > facing(a.2);
            if is_better { b } else { a }
        })?;
        let q = rings.quadratic()?;
        let depth = DEPTH * norm(sub(q.coefs[2], q.center()));
        Some(Handle {
            vertex: point.vertex()?.0,
            valence: point.valence,
            position: rings.center(),
            zoom: zoom(self.surface(), k),
            largest_mean: (10.0 * self.analyses[2].largest_mean(k)).ceil() / 10.0,
            push: scale(-depth, rings.normal()),
        })
    }
}

fn diagonal(surface: &Surface, sector: &Sector) -> String {
    let (face, corner) = surface.face_of(sector.quad).expect("sectors are in quads");
    let is_quad = surface.topology().faces().corners(face).len() == 4;
    let corner = if is_quad { String::new() } else { corner.to_string() };
    let mut rows = String::new();
    for k in 0..=HALVINGS {
        let [u, v] = at(sector, [0.5_f64.powi(k); 2]);
        writeln!(rows, "{},{u},{v},{corner}", face.0).expect("a string takes any text");
    }
    rows
}

/// The parameters at (a,b) of a sector.
fn at(sector: &Sector, [a, b]: [f64; 2]) -> [f64; 2] {
    [0, 1].map(|k| sector.center[k] + a * sector.along[0][k] + b * sector.along[1][k])
}

/// The magnification at which the sectors around a point, by its index, fill the picture, in
/// halves.
fn zoom(surface: &Surface, point: usize) -> f64 {
    let center = surface.rings(point).map_or([0.0; 3], Rings::center);
    let point = &surface.extraordinary_points()[point];
    let ends = point.sectors.iter().flat_map(|s| [[1.0, 0.0], [1.0, 1.0]].map(|ab| (s, ab)));
    let positions = ends.filter_map(|(sector, ab)| {
        let [u, v] = at(sector, ab);
        surface.eval(sector.quad, u, v).map(|p| p.jet.p)
    });
    let radius = positions.map(|p| norm(sub(p, center))).fold(0.0, f64::max);
    let ratio = 0.5 * extent(surface.positions()) / radius;
    ((2.0 * ratio).round() / 2.0).clamp(1.0, 100.0)
}

/// The largest side of the box around `points`.
fn extent(points: &[Point]) -> f64 {
    let side = |k: usize| {
        let coordinates = || points.iter().map(move |p| p[k]);
        coordinates().fold(f64::MIN, f64::max) - coordinates().fold(f64::MAX, f64::min)
    };
    (0..3).map(side).fold(0.0, f64::max)
}
