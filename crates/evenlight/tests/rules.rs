//! Which schemes have rules at which valences: exactly those listed here, so that none is lost.
#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

mod common;

use common::Random;
use evenlight::net::CNet;
use evenlight::rings::Rings;
use evenlight::{Contraction, RuleSet, SchemeKind, Variant};

fn variants() -> Vec<Variant> {
    let contractions = [Contraction::CatmullClark, Contraction::Half, Contraction::Lambda(0.31)];
    let sets = [RuleSet::Generated, RuleSet::Published];
    let all = sets.into_iter().flat_map(|rules| {
        contractions.into_iter().map(move |contraction| Variant { rules, contraction })
    });
    all.collect()
}

fn cnet(n: usize) -> CNet {
    let mut random = Random::new(n as u64);
    let mut point = || [0.0; 3].map(|_: f64| random.unit() - 0.5);
    CNet { sectors: (0..n).map(|_| [0; 6].map(|_| point())).collect(), center: point() }
}

/// Whether the words of [`SchemeKind::valences`] have `n`: "none", or parts with "and" between
/// them, each a number or "A to B".
fn says(words: &str, n: usize) -> bool {
    let has = |part: &str| match part.split_once(" to ") {
        Some((first, last)) => (first.parse().unwrap()..=last.parse().unwrap()).contains(&n),
        None => part.parse() == Ok(n),
    };
    words != "none" && words.split(" and ").any(has)
}

#[test]
fn schemes_have_rules_at_the_listed_valences_and_no_others() {
    for scheme in SchemeKind::ALL {
        for variant in variants() {
            for n in (0..=40).chain([1023, 1024, 1025]) {
                let expected = common::has_rules(scheme, variant, n);
                let name = format!("{}, {variant:?}, n = {n}", scheme.name());
                assert_eq!(scheme.has_rules(variant, n), expected, "{name}");
                assert_eq!(says(scheme.valences(variant), n), expected, "{name}");
            }
        }
    }
}

#[test]
fn there_are_rings_where_there_are_rules() {
    for scheme in SchemeKind::ALL {
        for variant in variants() {
            // Deriving rules takes longer the higher the valence: three of them have to do.
            let is_derived = scheme.name().starts_with("guided")
                && variant.contraction != Contraction::CatmullClark;
            let valences = if is_derived { vec![3, 4, 33] } else { (0..=17).collect() };
            for n in valences.into_iter().filter(|&n| n != 1 && n != 17) {
                let is_there = Rings::from_cnet(&cnet(n), scheme, variant).is_some();
                let expected = common::has_rules(scheme, variant, n);
                assert_eq!(is_there, expected, "{}, {variant:?}, n = {n}", scheme.name());
            }
        }
    }
}
