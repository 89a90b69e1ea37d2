//! The analysis as JSON. What does not exist (a range of nothing, a ratio to zero) is `null`.

use evenlight::analyse::caps::CapReport;
use evenlight::analyse::continuity::Jumps;
use evenlight::analyse::curvature::{Range, RingCurvature};
use evenlight::analyse::defect::Defect;
use serde::Serialize;

use super::{Analysis, Point, growth};
use crate::options::rules_name;

/// The JSON document.
#[derive(Serialize)]
pub struct Document {
    rings: usize,
    schemes: Vec<SchemeRecord>,
}

/// What was measured with one scheme.
#[derive(Serialize)]
struct SchemeRecord {
    scheme: &'static str,
    /// `null` for schemes without tables.
    rules: Option<&'static str>,
    /// `cc`, `half` or a number.
    contraction: String,
    /// One record per extraordinary vertex, then per centre of an n-gon.
    points: Vec<PointRecord>,
    /// The largest jumps across all patch borders of the surface.
    jumps: JumpRecord,
}

/// What was measured around one extraordinary point.
#[derive(Serialize)]
struct PointRecord {
    /// `null` at the centre of an n-gon, whose number is then in `face`.
    vertex: Option<u32>,
    face: Option<u32>,
    valence: usize,
    level: usize,
    /// Gauss curvature over all rings, in 1/unit^2.
    gauss: RangeRecord,
    /// Mean curvature over all rings, in 1/unit.
    mean: RangeRecord,
    /// The range of the mean curvature in the last ring over that in the first.
    mean_span_growth: f64,
    /// The largest principal curvature on the outer border of ring 1, in 1/unit: the unit of the
    /// two oscillations.
    curvature_scale: f64,
    /// How much the mean curvature rises and falls in vain along rays to the point.
    mean_oscillation_along_rays: f64,
    /// How much more it varies around the point than on the outer border of ring 1.
    mean_oscillation_around_rings: f64,
    /// The integral of the squared gradient of the mean curvature over rings 1 to 4, in 1/unit^2.
    shape_energy: f64,
    /// The largest jump of the mean curvature across a border between rings, in 1/unit.
    mean_jump_across_rings: f64,
    /// The largest jumps across the borders of all patches around the point.
    jumps: JumpRecord,
    rings: Vec<RingRecord>,
    /// The cap behind these rings; `null` without --cap, and where there is none.
    cap: Option<CapRecord>,
}

/// What was measured of a cap.
#[derive(Serialize)]
struct CapRecord {
    degree: usize,
    /// So many patches stand along each side of a sector.
    split: usize,
    lines: DefectRecord,
    inside: DefectRecord,
    ring: DefectRecord,
    gauss: RangeRecord,
    mean: RangeRecord,
    /// How far the mean curvature leaves its range over the last two rings, over the largest
    /// curvature of the cap; `null` without rings.
    mean_outside: Option<f64>,
}

/// The largest jumps across some borders of a cap.
#[derive(Serialize)]
struct DefectRecord {
    /// In units of the cage.
    position: f64,
    /// The angle between the normals, in radians.
    tangent_plane: f64,
    /// Of the principal curvatures, over the largest of the cap.
    curvature: f64,
}

/// The ranges in one ring.
#[derive(Serialize)]
struct RingRecord {
    ring: usize,
    gauss: RangeRecord,
    mean: RangeRecord,
}

/// A range; both ends are `null` if there is no value.
#[derive(Serialize)]
struct RangeRecord {
    min: f64,
    max: f64,
}

/// The largest jumps.
#[derive(Serialize)]
struct JumpRecord {
    /// In units of the cage.
    position: f64,
    /// The angle between the normals, in radians.
    tangent_plane: f64,
    /// Of the principal curvatures, in 1/unit.
    curvature: f64,
    /// Of the derivatives up to order two in matched parameters, relative to the patch.
    parametric: f64,
}

impl Document {
    /// The document on `analyses` over `rings` rings.
    pub fn new(analyses: &[Analysis], rings: usize) -> Self {
        Self { rings, schemes: analyses.iter().map(SchemeRecord::new).collect() }
    }
}

impl SchemeRecord {
    fn new(analysis: &Analysis) -> Self {
        Self {
            scheme: analysis.scheme(),
            rules: rules_name(analysis.surface.options()),
            contraction: analysis.surface.options().contraction.to_string(),
            points: analysis.points().map(PointRecord::new).collect(),
            jumps: analysis.report.jumps.into(),
        }
    }
}

impl PointRecord {
    fn new(Point { place, report, shape, cap }: Point) -> Self {
        let ring = |(k, r): (usize, &RingCurvature)| RingRecord {
            ring: k + 1,
            gauss: r.gauss.into(),
            mean: r.mean.into(),
        };
        Self {
            vertex: place.vertex().map(|v| v.0),
            face: place.face().map(|f| f.0),
            valence: place.valence,
            level: place.level,
            gauss: report.total.gauss.into(),
            mean: report.total.mean.into(),
            mean_span_growth: growth(report),
            curvature_scale: shape.scale,
            mean_oscillation_along_rays: shape.along_rays,
            mean_oscillation_around_rings: shape.around_rings,
            shape_energy: shape.energy,
            mean_jump_across_rings: report.mean_jump_across_rings,
            jumps: report.jumps.into(),
            rings: report.rings.iter().enumerate().map(ring).collect(),
            cap: cap.map(CapRecord::new),
        }
    }
}

impl CapRecord {
    fn new(cap: &CapReport) -> Self {
        Self {
            degree: cap.degree,
            split: cap.split,
            lines: cap.lines.into(),
            inside: cap.inside.into(),
            ring: cap.ring.into(),
            gauss: cap.curvature.gauss.into(),
            mean: cap.curvature.mean.into(),
            mean_outside: cap.excess(),
        }
    }
}

impl From<Defect> for DefectRecord {
    fn from(defect: Defect) -> Self {
        let Defect { position, tangent_plane, curvature } = defect;
        Self { position, tangent_plane, curvature }
    }
}

impl From<Range> for RangeRecord {
    fn from(range: Range) -> Self {
        Self { min: range.min, max: range.max }
    }
}

impl From<Jumps> for JumpRecord {
    fn from(jumps: Jumps) -> Self {
        let Jumps { defect: Defect { position, tangent_plane, curvature }, parametric } = jumps;
        Self { position, tangent_plane, curvature, parametric }
    }
}
