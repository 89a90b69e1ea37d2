//! Building a surface: rules for every valence, positions of the refined levels, the c-net of
//! every extraordinary point.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use super::place::from_sector_parameters;
use super::{ExtraordinaryPoint, PointRule, QuadId, Sector, SurfaceOptions};
use crate::mesh::isolation::{Extraordinary, Place, Plan};
use crate::mesh::{Cage, Fan, VertexId, cnet_vertices, fan_vertices};
use crate::net::CNet;
use crate::point::Point;
use crate::rings::{Rings, ValenceRules};
use crate::scheme::{
    Contraction, ContractionError, MAX_CATMULL_CLARK_VALENCE, SchemeKind, Variant,
};

/// Why no surface could be built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SurfaceError {
    /// The scheme has no such contraction.
    #[error(transparent)]
    Contraction(#[from] ContractionError),
    /// Not even Catmull-Clark has rules for the valence of these points.
    #[error(
        "there are rules for valences up to {MAX_CATMULL_CLARK_VALENCE}, but {}; \
         split such a vertex or face into several of lower valence",
        list_places(points)
    )]
    NoRules {
        /// The points and their valences.
        points: Vec<(Place, usize)>,
    },
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

/// The rules of every point, shared by all that are alike.
pub(super) fn rules_of_points(
    cage: &Cage,
    plan: &Plan,
    options: SurfaceOptions,
) -> Result<Vec<(PointRule, Arc<ValenceRules>)>, SurfaceError> {
    options.scheme.check_contraction(options.contraction)?;
    let without = plan.points.iter().filter(|p| p.fan.faces > MAX_CATMULL_CLARK_VALENCE);
    let points: Vec<_> = without.map(|p| (p.place, p.valence)).collect();
    if !points.is_empty() {
        return Err(SurfaceError::NoRules { points });
    }
    let mut made: BTreeMap<Fan, Arc<ValenceRules>> = BTreeMap::new();
    let of_point = |point: &Extraordinary| {
        let rule = PointRule::of(cage, point, options);
        let rules = made.entry(point.fan).or_insert_with(|| kept(rule, point.fan, options));
        (rule, rules.clone())
    };
    Ok(plan.points.iter().map(of_point).collect())
}

/// [`make`], which depends on nothing else, kept for the next surface if that may well ask for it:
/// to make rules takes longer than the rest of a small surface.
fn kept(rule: PointRule, fan: Fan, options: SurfaceOptions) -> Arc<ValenceRules> {
    /// The rules of more faces are rare, and large.
    const LARGEST: usize = 8;
    /// So many rules are kept; there are hardly as many.
    const MOST: usize = 256;
    type Key = (PointRule, Fan, SurfaceOptions);
    static KEPT: Mutex<Vec<(Key, Arc<ValenceRules>)>> = Mutex::new(Vec::new());
    let lock = || KEPT.lock().unwrap_or_else(PoisonError::into_inner);
    let key = (rule, fan, options);
    if let Some((_, rules)) = lock().iter().find(|(other, _)| *other == key) {
        return rules.clone();
    }
    let rules = Arc::new(make(rule, fan, options));
    let is_common = fan.faces <= LARGEST && !matches!(options.contraction, Contraction::Lambda(_));
    let mut all = lock();
    if is_common && all.len() < MOST {
        all.push((key, rules.clone()));
    }
    rules
}

fn make(rule: PointRule, fan: Fan, options: SurfaceOptions) -> ValenceRules {
    let rules = match rule {
        PointRule::FairCrease(_) => ValenceRules::of_fair_fan(fan),
        PointRule::CatmullClark(_) if !fan.is_smooth() => Some(ValenceRules::of_fan(fan)),
        PointRule::Scheme => ValenceRules::new(options.scheme, options.variant(), fan.faces),
        PointRule::CatmullClark(_) => {
            ValenceRules::new(SchemeKind::CatmullClark, Variant::default(), fan.faces)
        }
    };
    rules.expect("it was asked before whether there are rules, and Catmull-Clark has all")
}

pub(super) fn refined_positions(cage: &Cage, plan: &Plan) -> Vec<Vec<Point>> {
    let mut refined: Vec<Vec<Point>> = Vec::new();
    for (k, level) in plan.levels.iter().enumerate() {
        let coarse = refined.last().map_or(cage.positions(), Vec::as_slice);
        let topology = plan.topology(cage.topology(), k);
        refined.push(level.values(topology, &plan.sharpness[k], coarse));
    }
    refined
}

/// The rings around a point, over its net at the level at which it is isolated.
pub(super) fn rings(
    cage: &Cage,
    plan: &Plan,
    refined: &[Vec<Point>],
    point: usize,
    rules: &Arc<ValenceRules>,
) -> Rings {
    if plan.points[point].fan.is_smooth() {
        return Rings::with_rules(&gather(cage, plan, refined, point), rules.clone(), None);
    }
    let level = plan.points[point].level;
    let positions = if level == 0 { cage.positions() } else { &refined[level - 1] };
    let net = fan_vertices(plan.topology(cage.topology(), level), plan.placed_fan(point));
    let net: Vec<Point> = net.into_iter().map(|v| positions[v.index()]).collect();
    Rings::over_fan(&net, rules.clone()).expect("these are the rules of a fan")
}

/// The c-net of a point, at the level at which it is isolated.
fn gather(cage: &Cage, plan: &Plan, refined: &[Vec<Point>], point: usize) -> CNet {
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

pub(super) fn describe(
    plan: &Plan,
    point: usize,
    rule: PointRule,
    rings: &Rings,
) -> ExtraordinaryPoint {
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
        fan: found.fan,
        rule,
        level: found.level,
        position: rings.center(),
        normal: rings.normal(),
        sectors,
    }
}
