//! Quadratics of a file, put into surfaces.

use std::collections::BTreeMap;

use evenlight::mesh::isolation::Place;
use evenlight::net::Quadratic;
use evenlight::point::{dot, sub};
use evenlight::rings::Rings;
use evenlight::surface::PointRule;
use evenlight::{FaceId, Surface, Vector, VertexId};

use super::file::{self, Change, Entry};
use crate::error::{Failure, warn};
use crate::input::{Source, WHY_OMITTED};

/// The quadratics of a file, or none.
#[derive(Clone, Debug, Default)]
pub struct Edits {
    /// The name of the file.
    name: String,
    entries: Vec<Entry>,
}

impl Edits {
    /// Reads `text`, which comes from `source`.
    pub fn parse(source: &Source, text: &str) -> Result<Self, Failure> {
        let name = source.to_string();
        let entries =
            file::parse(text).map_err(|fault| Failure::Unusable(format!("{name}: {fault}")))?;
        Ok(Self { name, entries })
    }

    /// Puts the quadratics into `surface`, if its scheme has any.
    ///
    /// # Errors
    ///
    /// If an entry is not about an extraordinary point of the surface, or about the same one as
    /// another, or does not have as many sectors.
    pub fn apply(&self, surface: &mut Surface) -> Result<(), Failure> {
        if !surface.options().scheme.has_quadratic() {
            return Ok(());
        }
        let mut numbers = BTreeMap::new();
        for (entry, number) in self.entries.iter().zip(1..) {
            let named =
                |fault| Failure::Unusable(format!("{}: entry {number}: {fault}", self.name));
            let point = find(surface, entry.place).map_err(named)?;
            if let Some(first) = numbers.insert(point, number) {
                let name = name(entry.place);
                let fault = format!("{name} is that of entry {first} too: keep one of the two");
                return Err(named(fault));
            }
            let q = quadratic(surface, point, &entry.change).map_err(named)?;
            surface.set_quadratic(point, &q);
            if surface.rings(point).is_some_and(|rings| rings.normal()[0].is_nan()) {
                let name = name(entry.place);
                warn(format_args!(
                    "{}: entry {number}: with this q there is no tangent plane at {name}",
                    self.name
                ));
            }
        }
        Ok(())
    }
}

/// The new quadratic of a point.
fn quadratic(surface: &Surface, point: usize, change: &Change) -> Result<Quadratic, String> {
    let place = &surface.extraordinary_points()[point];
    let valence = place.valence;
    let Some(default) = surface.rings(point).and_then(Rings::quadratic) else {
        let (rule, reason) = match place.rule {
            PointRule::CatmullClark(reason) => ("Catmull-Clark's rule", reason.to_string()),
            PointRule::FairCrease(reason) => ("the fair rule beside a crease", reason.to_string()),
            PointRule::Scheme => ("Catmull-Clark's rule", "no quadratic".to_owned()),
        };
        return Err(format!("the point has {rule} ({reason}), which has no q"));
    };
    let q = match change {
        Change::Affine { matrix, translation } => moved(default, *matrix, *translation),
        Change::Coefficients(coefs) => Quadratic { coefs: *coefs },
        Change::Sectors(sectors) if sectors.len() == valence => Quadratic::from_proposals(sectors),
        Change::Sectors(sectors) => {
            return Err(format!(
                "sectors has {} lists, but the point has valence {valence}: give one per sector",
                sectors.len()
            ));
        }
    };
    let all = (0..valence).flat_map(|s| q.in_sector(valence, s).coefs);
    let is_finite = all.flatten().all(f64::is_finite);
    if is_finite { Ok(q) } else { Err("the numbers are too large to compute with".to_owned()) }
}

/// The image under x -> p + M (x - p) + t about the centre p.
fn moved(q: &Quadratic, matrix: [Vector; 3], translation: Vector) -> Quadratic {
    let p = q.center();
    let image = matrix.map(|row| dot(row, p));
    q.transformed(matrix, [0, 1, 2].map(|k| sub(p, image)[k] + translation[k]))
}

/// The extraordinary point at `place`, or why there is none.
fn find(surface: &Surface, place: Place) -> Result<usize, String> {
    let points = surface.extraordinary_points();
    let is_there = points.iter().position(|p| p.place == place);
    is_there.ok_or_else(|| match place {
        Place::Vertex(v) => not_a_vertex(surface, v),
        Place::FaceCentre(f) => not_a_face(surface, f),
    })
}

fn not_a_vertex(surface: &Surface, vertex: VertexId) -> String {
    let topology = surface.topology();
    let (v, count) = (vertex.0, topology.num_vertices());
    if vertex.index() >= count {
        return format!("there is no vertex {v}: the cage has the vertices 0 to {}", count - 1);
    }
    if !topology.is_used(vertex) {
        return format!("vertex {v} is in no face: take one that is");
    }
    if topology.ring(vertex).all(|h| surface.is_omitted(topology.face(h))) {
        return format!("all faces at vertex {v} are left out ({WHY_OMITTED}): take another");
    }
    format!("vertex {v} has valence {}: {ONLY_EXTRAORDINARY}", topology.valence(vertex))
}

fn not_a_face(surface: &Surface, face: FaceId) -> String {
    let faces = surface.topology().faces();
    let (f, count) = (face.0, faces.len());
    if face.index() >= count {
        return format!("there is no face {f}: the cage has the faces 0 to {}", count - 1);
    }
    if faces.corners(face).len() == 4 {
        return format!("face {f} is a quad: {ONLY_EXTRAORDINARY}");
    }
    format!("face {f} is left out ({WHY_OMITTED}): take another")
}

const ONLY_EXTRAORDINARY: &str = "only extraordinary vertices, and centres of faces that are no \
                                  quads, have a q ('evenlight q' lists them)";

fn name(place: Place) -> String {
    match place {
        Place::Vertex(v) => format!("vertex {}", v.0),
        Place::FaceCentre(f) => format!("the centre of face {}", f.0),
    }
}
