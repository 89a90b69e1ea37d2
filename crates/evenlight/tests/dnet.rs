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

#[test]
fn a_degree_raised_cnet_gives_the_surface_of_the_cnet() {
    let mut random = Random::new(2);
    for n in [3, 5, 6, 7, 8, 9, 10, 13, 16] {
        let cnet = random_cnet(n, &mut random);
        let (eg, set) = (SchemeKind::EvolvingGuide, RuleSet::Generated);
        let of_cnet = Rings::from_cnet(&cnet, eg, set).unwrap();
        let of_dnet =
            Rings::from_dnet(&DNet::from_cnet(&cnet, Spline::BiQuartic), eg, set).unwrap();
        assert!(norm(sub(of_cnet.center(), of_dnet.center())) < 1e-14);
        for ring in 0..6 {
            for (p, q) in of_cnet.patches(ring).iter().zip(&of_dnet.patches(ring)) {
                assert!(p.coefs().iter().zip(q.coefs()).all(|(a, b)| norm(sub(*a, *b)) < 1e-13));
            }
        }
    }
}

#[test]
fn a_general_dnet_keeps_its_border_and_shrinks_to_its_centre() {
    let mut random = Random::new(4);
    for n in [3, 5, 8] {
        let mut dnet = DNet::from_cnet(&random_cnet(n, &mut random), Spline::BiQuartic);
        for p in dnet.sectors.iter_mut().flatten() {
            p[2] += random.unit();
        }
        let rings = Rings::from_dnet(&dnet, SchemeKind::EvolvingGuide, RuleSet::Generated).unwrap();
        // The outer corner of ring 0 is (d_00 + 2 d_10 + d_20 + ...) / 16 [KP23-EG, eq. 6].
        for s in 0..n {
            let d = &dnet.sectors[s];
            let row =
                |j: usize, k: usize| (d[4 * j][k] + 2.0 * d[4 * j + 1][k] + d[4 * j + 2][k]) / 4.0;
            let corner = [0, 1, 2].map(|k| (row(0, k) + 2.0 * row(1, k) + row(2, k)) / 4.0);
            let found = rings.eval(s, 1.0, 1.0).jet.p;
            assert!(norm(sub(found, corner)) < 1e-14, "{found:?} {corner:?}");
        }
        let deep = rings.eval(0, 0.5_f64.powi(60), 0.0).jet.p;
        assert!(norm(sub(deep, dnet.center(Spline::BiQuartic))) < 1e-12);
    }
}

#[test]
fn schemes_without_dnets_and_valences_without_rules_say_so() {
    let net = |n: usize| DNet { sectors: vec![[[0.0; 3]; 12]; n] };
    assert!(Rings::from_dnet(&net(5), SchemeKind::CatmullClark, RuleSet::Generated).is_none());
    assert!(Rings::from_dnet(&net(17), SchemeKind::EvolvingGuide, RuleSet::Generated).is_none());
    assert!(Rings::from_dnet(&net(11), SchemeKind::EvolvingGuide, RuleSet::Published).is_none());
}
