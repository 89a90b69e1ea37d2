//! The rules of fairness-optimal subdivision, which is ours.
//!
//! fair4 and fair3 have the layout of Quadratic-Attraction rules ([`super::qas`]), fair4d that of
//! Evolving-Guide rules ([`super::eg`]). No paper prints them.

mod fair3_n03;
mod fair3_n05;
mod fair3_n06;
mod fair3_n07;
mod fair3_n08;
mod fair3_n09;
mod fair3_n10;
mod fair3_n11;
mod fair3_n12;
mod fair3_n13;
mod fair3_n14;
mod fair3_n15;
mod fair3_n16;
mod fair4_n03;
mod fair4_n05;
mod fair4_n06;
mod fair4_n07;
mod fair4_n08;
mod fair4_n09;
mod fair4_n10;
mod fair4_n11;
mod fair4_n12;
mod fair4_n13;
mod fair4_n14;
mod fair4_n15;
mod fair4_n16;
mod fair4d_n03;
mod fair4d_n05;
mod fair4d_n06;
mod fair4d_n07;
mod fair4d_n08;
mod fair4d_n09;
mod fair4d_n10;
mod fair4d_n11;
mod fair4d_n12;
mod fair4d_n13;
mod fair4d_n14;
mod fair4d_n15;
mod fair4d_n16;

use super::eg::EgWeights;
use super::forms::{EgTable, QasTable};
use super::qas::QasWeights;
use super::table_index;
use crate::net::Spline;

/// The tables of [`VALENCES`](super::VALENCES) for bi-3 splines.
static FAIR3: [&QasTable; 13] = [
    &fair3_n03::TABLE,
    &fair3_n05::TABLE,
    &fair3_n06::TABLE,
    &fair3_n07::TABLE,
    &fair3_n08::TABLE,
    &fair3_n09::TABLE,
    &fair3_n10::TABLE,
    &fair3_n11::TABLE,
    &fair3_n12::TABLE,
    &fair3_n13::TABLE,
    &fair3_n14::TABLE,
    &fair3_n15::TABLE,
    &fair3_n16::TABLE,
];

/// The tables of [`VALENCES`](super::VALENCES) for bi-4 splines.
static FAIR4: [&QasTable; 13] = [
    &fair4_n03::TABLE,
    &fair4_n05::TABLE,
    &fair4_n06::TABLE,
    &fair4_n07::TABLE,
    &fair4_n08::TABLE,
    &fair4_n09::TABLE,
    &fair4_n10::TABLE,
    &fair4_n11::TABLE,
    &fair4_n12::TABLE,
    &fair4_n13::TABLE,
    &fair4_n14::TABLE,
    &fair4_n15::TABLE,
    &fair4_n16::TABLE,
];

/// The tables of [`VALENCES`](super::VALENCES) for bi-4 splines without a quadratic.
static FAIR4D: [&EgTable; 13] = [
    &fair4d_n03::TABLE,
    &fair4d_n05::TABLE,
    &fair4d_n06::TABLE,
    &fair4d_n07::TABLE,
    &fair4d_n08::TABLE,
    &fair4d_n09::TABLE,
    &fair4d_n10::TABLE,
    &fair4d_n11::TABLE,
    &fair4d_n12::TABLE,
    &fair4d_n13::TABLE,
    &fair4d_n14::TABLE,
    &fair4d_n15::TABLE,
    &fair4d_n16::TABLE,
];

/// The weights of fair4 (bi-4) or fair3 (bi-3) at one valence, to 1 ulp; `None` without a table.
pub(crate) fn fair_weights(valence: usize, spline: Spline) -> Option<QasWeights> {
    let tables = match spline {
        Spline::BiQuartic => &FAIR4,
        Spline::BiCubic => &FAIR3,
    };
    Some(tables[table_index(valence, false)?].weights(false))
}

/// The weights of fair4d at one valence, to 1 ulp; `None` without a table.
pub(crate) fn fair_evolving_weights(valence: usize) -> Option<EgWeights> {
    Some(FAIR4D[table_index(valence, false)?].weights(false))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scheme::tables::{Mirror, NODES, RULES, VALENCES};

    #[test]
    fn every_valence_has_its_own_table_and_no_more_rows_than_it_needs() {
        for (k, n) in VALENCES.into_iter().enumerate() {
            for table in [FAIR3[k], FAIR4[k]] {
                assert_eq!(table.valence, n);
                assert_eq!(table.kappa_21.len(), 21);
                assert_eq!((table.mu_4.len(), table.mu_5.len()), (n.div_ceil(2) + 1, n / 2 + 1));
            }
            assert_eq!((FAIR4D[k].valence, FAIR4D[k].rule_21.len()), (n, n));
        }
        assert!([0, 1, 2, 4, 17].iter().all(|&n| fair_evolving_weights(n).is_none()));
    }

    #[test]
    fn mirror_images_are_equal_to_the_last_digit() {
        for (k, n) in VALENCES.into_iter().enumerate() {
            for rule in RULES {
                let (mirror, image) = Mirror::of_rule(rule);
                for (r, node) in (0..n as isize).flat_map(|r| (0..NODES).map(move |k| (r, k))) {
                    let other = mirror.image((r, node));
                    let table = FAIR4D[k];
                    assert_eq!(table.numerator(rule, (r, node)), table.numerator(image, other));
                    for table in [FAIR3[k], FAIR4[k]] {
                        assert_eq!(table.kappa(rule, (r, node)), table.kappa(image, other));
                    }
                }
            }
        }
    }
}
