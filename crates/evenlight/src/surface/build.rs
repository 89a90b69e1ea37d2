//! Building a surface: rules for every valence, positions of the refined levels, the c-net of
//! every extraordinary point.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::place::from_sector_parameters;
use super::{ExtraordinaryPoint, QuadId, Sector, SurfaceOptions};
use crate::mesh::isolation::{Place, Plan, cnet_vertices};
use crate::mesh::{Cage, VertexId};
use crate::net::CNet;
use crate::point::Point;
use crate::rings::{Rings, ValenceRules};
use crate::scheme::{ContractionError, RuleSet, SchemeKind, Variant};

/// Why no surface could be built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SurfaceError {
    /// The scheme has no such contraction.
    #[error(transparent)]
    Contraction(#[from] ContractionError),
    /// The scheme has no rules for the valence of these points.
    #[error(
        "scheme {} has {}rules for valences {}, but {}; {}",
        scheme.name(),
        if variant.rules == RuleSet::Published { "published " } else { "" },
        scheme.valences(*variant),
        list_places(points),
        advice(*scheme, variant.rules, points)
    )]
    NoRules {
        /// The points and their valences.
        points: Vec<(Place, usize)>,
        /// The scheme.
        scheme: SchemeKind,
        /// Its tables and contraction.
        variant: Variant,
    },
}

/// What to do about points without rules.
fn advice(scheme: SchemeKind, rules: RuleSet, points: &[(Place, usize)]) -> String {
    let mut ways = Vec::new();
    if points.iter().any(|&(_, valence)| valence > 2) {
        ways.push("split such a vertex or face into several of lower valence");
    }
    if points.iter().any(|&(_, valence)| valence == 2) {
        ways.push("dissolve vertices with two edges into their faces");
    }
    if rules == RuleSet::Published {
        ways.push("use the generated rules");
    }
    if scheme != SchemeKind::CatmullClark {
        ways.push("use scheme cc");
    }
    ways.join(", or ")
}

/// The points of an error message, at most eight of them.
fn list_places(points: &[(Place, usize)]) -> String {
    let name = |&(place, valence): &(Place, usize)| match place {
        Place::Vertex(v) => {
            format!("vertex {} (number {} in a file) has valence {valence}", v.0, v.0 + 1)
        }
        Place::FaceCentre(f) => {
            format!("face {} (number {} in a file) has {valence} corners", f.0, f.0 + 1)
        }
    };
    let mut names: Vec<String> = points.iter().take(8).map(name).collect();
    if points.len() > names.len() {
        names.push(format!("{} more", points.len() - names.len()));
    }
    names.join(", ")
}

pub(super) fn rules_by_valence(
    plan: &Plan,
    options: SurfaceOptions,
) -> Result<BTreeMap<usize, Arc<ValenceRules>>, SurfaceError> {
    let (scheme, variant) = (options.scheme, options.variant());
    scheme.check_contraction(options.contraction)?;
    let without = plan.points.iter().filter(|p| !scheme.has_rules(variant, p.valence));
    let points: Vec<_> = without.map(|p| (p.place, p.valence)).collect();
    if !points.is_empty() {
        return Err(SurfaceError::NoRules { points, scheme, variant });
    }
    let mut rules = BTreeMap::new();
    for point in &plan.points {
        rules.entry(point.valence).or_insert_with(|| {
            let rules = ValenceRules::new(scheme, variant, point.valence);
            Arc::new(rules.expect("has_rules was asked before"))
        });
    }
    Ok(rules)
}

pub(super) fn refined_positions(cage: &Cage, plan: &Plan) -> Vec<Vec<Point>> {
    let mut refined: Vec<Vec<Point>> = Vec::new();
    for (k, level) in plan.levels.iter().enumerate() {
        let coarse = refined.last().map_or(cage.positions(), Vec::as_slice);
        let topology = plan.topology(cage.topology(), k);
        refined.push(level.positions(topology, coarse, k > 0));
    }
    refined
}

/// The c-net of a point, at the level at which it is isolated.
pub(super) fn gather(cage: &Cage, plan: &Plan, refined: &[Vec<Point>], point: usize) -> CNet {
    let level = plan.points[point].level;
    let positions = if level == 0 { cage.positions() } else { &refined[level - 1] };
    let topology = plan.topology(cage.topology(), level);
    let first = plan.first_half_edges[point];
    let at = |v: VertexId| positions[v.index()];
    CNet {
        center: at(topology.origin(first)),
        sectors: cnet_vertices(topology, first).into_iter().map(|s| s.map(at)).collect(),
    }
}

pub(super) fn describe(plan: &Plan, point: usize, rings: &Rings) -> ExtraordinaryPoint {
    let found = plan.points[point];
    let mut sectors: Vec<Sector> = plan.sectors[point]
        .iter()
        .map(|place| {
            let on_quad = |[a, b]: [f64; 2]| {
                let [u, v] = from_sector_parameters(place.corner as u8, [a, b]);
                [place.origin[0] + place.size * u, place.origin[1] + place.size * v]
            };
            let center = on_quad([0.0, 0.0]);
            let step = |end: [f64; 2]| [end[0] - center[0], end[1] - center[1]];
            let along = [step(on_quad([1.0, 0.0])), step(on_quad([0.0, 1.0]))];
            Sector { index: place.sector, quad: QuadId(place.quad), center, along }
        })
        .collect();
    sectors.sort_by_key(|s| s.index);
    let (vertex, face) = match found.place {
        Place::Vertex(v) => (Some(v), None),
        Place::FaceCentre(f) => (None, Some(f)),
    };
    ExtraordinaryPoint {
        vertex,
        face,
        valence: found.valence,
        level: found.level,
        position: rings.center(),
        normal: rings.normal(),
        sectors,
    }
}
