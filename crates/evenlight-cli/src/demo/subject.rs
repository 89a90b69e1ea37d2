//! What the demonstration is about: the cage, and its most telling vertices.

use std::fmt::Write;
use std::sync::Arc;

use evenlight::point::{norm, sub};
use evenlight::surface::{ExtraordinaryPoint, Sector};
use evenlight::{Cage, Point, RuleSet, SchemeKind, Surface, SurfaceOptions};

use crate::analyze::Analysis;
use crate::error::Failure;
use crate::input::{self, Source};

/// The rings that are analysed.
pub const RINGS: usize = 6;

/// How often the points on the way to a vertex halve their distance.
const HALVINGS: i32 = 10;

/// The cage, and what was measured on its surfaces.
pub struct Subject {
    /// The cage.
    pub cage: Arc<Cage>,
    /// With Catmull-Clark, then with Evolving-Guide.
    pub analyses: [Analysis; 2],
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

impl Subject {
    /// Reads the cage in `source` and analyses its surfaces.
    pub fn new(source: &Source) -> Result<Self, Failure> {
        let cage = input::read_cage(source)?;
        let analyse = |scheme| {
            let options = SurfaceOptions { scheme, rules: RuleSet::Generated };
            Analysis::of(&cage, options, RINGS, source)
        };
        let analyses = [analyse(SchemeKind::CatmullClark)?, analyse(SchemeKind::EvolvingGuide)?];
        Ok(Self { cage, analyses })
    }

    fn surface(&self) -> &Surface {
        self.analyses[1].surface()
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
        let candidates = points.filter_map(|(p, span)| Some((p, p.vertex?, span)));
        let of_valence = candidates.filter(|(p, ..)| p.valence == valence);
        // The first of those that are equal but for rounding, as in a symmetric cage.
        let better = |best: f64, span: f64| span > best * (1.0 + 1e-6);
        let (point, vertex, _) =
            of_valence.reduce(|best, other| if better(best.2, other.2) { other } else { best })?;
        let zoom = zoom(self.surface(), point);
        Some(CloseUp { vertex: vertex.0, valence, zoom })
    }

    /// Rows `face,u,v` that halve the distance to each of the vertices along the diagonal of a
    /// face.
    pub fn points_towards(&self, close_ups: &[CloseUp]) -> String {
        let mut text = String::from("face,u,v,corner\n");
        for CloseUp { vertex, valence, .. } in close_ups {
            let points = self.surface().extraordinary_points();
            let point = points.iter().find(|p| p.vertex.is_some_and(|v| v.0 == *vertex));
            if let Some(sector) = point.and_then(|p| p.sectors.first()) {
                text += &format!("# towards vertex {vertex} of valence {valence}\n");
                text += &diagonal(self.surface(), sector);
            }
        }
        text
    }
}

fn diagonal(surface: &Surface, sector: &Sector) -> String {
    let (face, corner) = surface.face_of(sector.quad);
    let is_quad = surface.cage().topology().faces().corners(face).len() == 4;
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

/// The magnification at which the sectors around `point` fill the picture, in halves.
fn zoom(surface: &Surface, point: &ExtraordinaryPoint) -> f64 {
    let ends = point.sectors.iter().flat_map(|s| [[1.0, 0.0], [1.0, 1.0]].map(|ab| (s, ab)));
    let positions = ends.filter_map(|(sector, ab)| {
        let [u, v] = at(sector, ab);
        surface.eval(sector.quad, u, v).map(|p| p.jet.p)
    });
    let radius = positions.map(|p| norm(sub(p, point.position))).fold(0.0, f64::max);
    let ratio = 0.5 * extent(surface.cage().positions()) / radius;
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
