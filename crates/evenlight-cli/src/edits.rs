//! `--q`: quadratics of a file, put into surfaces.

mod file;

use std::collections::BTreeMap;

use clap::Args;
use evenlight::mesh::isolation::Place;
use evenlight::net::Quadratic;
use evenlight::point::{dot, sub};
use evenlight::rings::Rings;
use evenlight::surface::PointRule;
use evenlight::{FaceId, SchemeKind, Surface, Vector, VertexId};

use crate::error::{Failure, warn};
use crate::input::{self, Source, WHY_OMITTED};
use file::{Change, Entry};

/// The option `--q`.
#[derive(Args, Clone, Debug)]
pub struct QArg {
    /// JSON file with quadratics that replace the default ones (qas3, qas4); `-` for stdin
    ///
    /// A list (or {"points": LIST}) of objects with "vertex": ID, or "face": ID for the centre
    /// of a face that is no quad, numbered from 0, and one of:
    ///
    /// "affine": {"matrix": [[3], [3], [3]], "translation": [3]}: the default q moved, about its
    /// own centre p: x -> p + M (x - p) + t. The matrix M has rows; without it, M is the
    /// identity; without translation, t is 0.
    ///
    /// "coefficients": [6 points]: q_1 to q_6 in sector 0, as `evenlight q --json` prints them.
    ///
    /// "sectors": [n lists of 6 points]: one proposal per sector, as `evenlight q --sectors`
    /// prints them; their mean is taken.
    #[arg(long = "q", value_name = "FILE")]
    pub file: Option<Source>,
}

impl QArg {
    /// The quadratics for surfaces over `cage` with the given schemes.
    ///
    /// # Errors
    ///
    /// Wrong usage if none of the schemes has a quadratic, or cage and quadratics would both come
    /// from stdin; else if the file cannot be read or understood.
    pub fn read(&self, cage: &Source, schemes: &[SchemeKind]) -> Result<Edits, Failure> {
        let Some(source) = &self.file else { return Ok(Edits::default()) };
        if !schemes.iter().any(|scheme| scheme.has_quadratic()) {
            let names: Vec<&str> = schemes.iter().map(|scheme| scheme.name()).collect();
            return Err(no_quadratic("--q", &names.join(", ")));
        }
        input::refuse_shared_stdin(&[("cage", cage), ("--q", source)])?;
        Edits::parse(source, &source.read_text()?)
    }
}

/// The failure of something that needs a quadratic.
pub fn no_quadratic(what: &str, scheme: &str) -> Failure {
    let with = SchemeKind::ALL.into_iter().filter(|scheme| scheme.has_quadratic());
    let with: Vec<&str> = with.map(SchemeKind::name).collect();
    Failure::Usage(format!(
        "{what}: the scheme {scheme} has no quadratic; choose --scheme {}",
        with.join(" or ")
    ))
}

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
            _ => ("another rule", "not that of the scheme".to_owned()),
        };
        return Err(format!("the point has {rule} ({reason}), which has no q"));
    };
    let q = match change {
        Change::Affine { matrix, translation } => moved(default, *matrix, *translation),
        Change::Coefficients(coefs) => Quadratic { coefs: *coefs },
        Change::Sectors(sectors) => {
            let right = Some(sectors).filter(|sectors| sectors.len() == valence);
            right.and_then(|sectors| Quadratic::from_proposals(sectors)).ok_or_else(|| {
                format!(
                    "sectors has {} lists, but the point has valence {valence}: give one per sector",
                    sectors.len()
                )
            })?
        }
    };
    let all = (0..valence).filter_map(|s| q.in_sector(valence, s)).flat_map(|q| q.coefs);
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
    let mut around = topology.ring(vertex).filter_map(|h| topology.get(h));
    if around.all(|h| surface.is_omitted(h.face())) {
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
