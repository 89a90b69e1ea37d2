//! d-nets as input.

mod common;

use common::Random;
use evenlight::net::{CNet, DNet, Spline};
use evenlight::point::{norm, sub};
use evenlight::rings::Rings;
use evenlight::{RuleSet, SchemeKind};

fn random_cnet(n: usize, random: &mut Random) -> CNet {
    let mut point = || [0, 1, 2].map(|_| random.unit() - 0.5);
    CNet { center: point(), sectors: (0..n).map(|_| std::array::from_fn(|_| point())).collect() }
}

/// The schemes that work on d-nets, with what the nodes are control points of.
fn schemes() -> impl Iterator<Item = (SchemeKind, Spline)> {
    SchemeKind::ALL.into_iter().filter_map(|scheme| Some((scheme, scheme.spline()?)))
}

#[test]
fn the_dnet_of_a_cnet_gives_the_surface_of_the_cnet() {
    let mut random = Random::new(2);
    for n in [3, 5, 6, 7, 8, 9, 10, 13, 16] {
        let cnet = random_cnet(n, &mut random);
        for (scheme, spline) in schemes() {
            let of_cnet = Rings::from_cnet(&cnet, scheme, RuleSet::Generated).unwrap();
            let dnet = DNet::from_cnet(&cnet, spline);
            let of_dnet = Rings::from_dnet(&dnet, scheme, RuleSet::Generated).unwrap();
            assert!(norm(sub(of_cnet.center(), of_dnet.center())) < 1e-13);
            for ring in 0..6 {
                for (p, q) in
                    of_cnet.patches(ring).unwrap().iter().zip(&of_dnet.patches(ring).unwrap())
                {
                    let near = |(a, b): (&[f64; 3], &[f64; 3])| norm(sub(*a, *b)) < 1e-11;
                    assert!(p.coefs().iter().zip(q.coefs()).all(near), "{}", scheme.name());
                }
            }
        }
    }
}

#[test]
fn a_general_dnet_keeps_its_border_and_shrinks_to_its_centre() {
    let mut random = Random::new(4);
    for n in [3, 5, 8] {
        for (scheme, spline) in schemes() {
            let mut dnet = DNet::from_cnet(&random_cnet(n, &mut random), spline);
            for p in dnet.sectors.iter_mut().flatten() {
                p[2] += random.unit();
            }
            let rings = Rings::from_dnet(&dnet, scheme, RuleSet::Generated).unwrap();
            // The outer corner of ring 0 is on the regular spline, at d_11's knot: (1,2,1)/4 of
            // its neighbours in both variables for bi-4 [KP23-EG, eq. 6], (1,4,1)/6 for bi-3.
            let side = if spline == Spline::BiQuartic { 0.25 } else { 1.0 / 6.0 };
            let mask = [side, 1.0 - 2.0 * side, side];
            for s in 0..n {
                let d = &dnet.sectors[s];
                let row =
                    |j: usize, k: usize| (0..3).map(|i| mask[i] * d[4 * j + i][k]).sum::<f64>();
                let corner = [0, 1, 2].map(|k| (0..3).map(|j| mask[j] * row(j, k)).sum());
                let found = rings.eval(s, 1.0, 1.0).unwrap().jet.p;
                assert!(norm(sub(found, corner)) < 1e-14, "{}: {found:?}", scheme.name());
            }
            let deep = rings.eval(0, 0.5_f64.powi(60), 0.0).unwrap().jet.p;
            assert!(norm(sub(deep, dnet.center(spline).unwrap())) < 1e-11);
        }
    }
}

#[test]
fn schemes_without_dnets_and_valences_without_rules_say_so() {
    let net = |n: usize| DNet { sectors: vec![[[0.0; 3]; 12]; n] };
    assert!(Rings::from_dnet(&net(5), SchemeKind::CatmullClark, RuleSet::Generated).is_none());
    assert!(Rings::from_dnet(&net(17), SchemeKind::EvolvingGuide, RuleSet::Generated).is_none());
    assert!(Rings::from_dnet(&net(11), SchemeKind::EvolvingGuide, RuleSet::Published).is_none());
}
