//! Nested spaces of functions on a guided surface, and their elements.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::eigen::Eigenfunctions;
use super::slots::{Combination, LAYERS, Slots};
use super::{jet_of_patch, value_alone};
use crate::net::CNET_NODES;
use crate::patch::Jet;
use crate::rings::{MAX_RINGS, power, ring_of, scaled_up};
use crate::scheme::{Contraction, SchemeKind, guide_monomials};
use crate::sparse::Stencils;

/// A space V_m of C2 functions around one extraordinary point \[KP18-Guided, Section 6.4\]: free
/// splines on rings 0 to m-1, a free guide for all rings from m on.
///
/// ```text
///   border    ring 0     ring 1    ...   ring m-1  |  ring m, m+1, ...
///   18n       18n        18n             18n       |  17n + n* + 6: a guide, subdivided
/// ```
///
/// (bi-5; 24n and 36n with bi-6 rings). Every function is C2 everywhere except at the centre. Near
/// the centre the functions of rings vanish, and the guides are as smooth as the scheme. V_m lies
/// in V_(m+1), by the sparse matrix [`RefinableSpace::refinement`].
///
/// **Functions**, by number: those of the border (level 0), of ring 0 (level 1, then the ring's
/// own), of ring 1, ..., and the guides, which are the eigenfunctions in their order, scaled to be
/// of the same size on ring m. Functions of rings are products of B-splines with triple knots
/// (fourfold in bi-6): they are not negative, and their sum and function
/// [`RefinableSpace::constant`] are the same as 1.
///
/// A function of level l lives on rings l-1 and l, a function of one ring on that ring only. The
/// functions of level 0 live on ring 0 and, in the same way, beyond the border.
///
/// ```
/// use evenlight::SchemeKind;
/// use evenlight::basis::RefinableSpace;
///
/// let coarse = RefinableSpace::new(SchemeKind::Guided5, 5, 1).ok_or("guided5 has n = 5")?;
/// assert_eq!(coarse.dim(), 2 * 18 * 5 + (17 * 5 + 5 + 6));
///
/// // Some function of V_1, the same one in V_2.
/// let f: Vec<f64> = (0..coarse.dim()).map(|k| (k % 7) as f64).collect();
/// let fine = coarse.refined().ok_or("there may be more rings")?;
/// let g = coarse.refinement().apply_to_numbers(&f)?;
/// let a = coarse.eval_sum(&f, 2, 0.2, 0.1).ok_or("there is a sector 2")?;
/// let b = fine.eval_sum(&g, 2, 0.2, 0.1).ok_or("there is a sector 2")?;
/// assert!((a.p[0] - b.p[0]).abs() < 1e-12 && (a.duv[0] - b.duv[0]).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct RefinableSpace {
    common: Arc<Common>,
    rings: usize,
}

/// The data that the spaces V_0, V_1, ... share.
#[derive(Debug)]
struct Common {
    eigen: Eigenfunctions,
    layout: Slots,
    /// For each square and coefficient what determines it.
    patches: [Vec<Source>; 3],
}

/// What determines a coefficient of a ring; numbers are slots of [`Slots`].
#[derive(Debug)]
enum Source {
    /// The functions of the level before the ring.
    Outer(Combination),
    /// The functions of the ring and of the level of its hole, or the guide.
    Inner(Combination),
}

/// The place to which a function belongs, see [`RefinableSpace`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FunctionKind {
    /// A corner or edge of the hole of ring `level` - 1; level 0 is the outer border of ring 0.
    Level {
        /// The level.
        level: usize,
        /// The sector that numbers it.
        sector: usize,
    },
    /// An edge or a square of one ring (bi-6 only).
    Ring {
        /// The ring.
        ring: usize,
        /// The sector that numbers it.
        sector: usize,
    },
    /// A guide: eigenfunction number `eigenfunction`, without its outer border in ring m.
    Guide {
        /// Its number in [`RefinableSpace::eigenfunctions`].
        eigenfunction: usize,
    },
}

/// Where a function is not zero.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Support {
    /// The first ring.
    pub first_ring: usize,
    /// The last ring; `None` for guides, which live on all rings from the first.
    pub last_ring: Option<usize>,
    /// The sectors, one or two or all.
    pub sectors: Vec<usize>,
}

/// The functions that live on one patch of one ring, with their Bernstein-Bezier coefficients
/// there: the element of an analysis, its matrix the Bezier extraction.
#[derive(Clone, Debug, PartialEq)]
pub struct Element {
    /// The ring.
    pub ring: usize,
    /// The sector.
    pub sector: usize,
    /// The patch in its sector, as in [`Rings::patch_domain`](crate::rings::Rings::patch_domain).
    pub which: usize,
    /// The part [[a0, a1], [b0, b1]] of the sector.
    pub domain: [[f64; 2]; 2],
    /// The bi-degree d.
    pub degree: usize,
    /// The numbers of the functions, rising.
    pub functions: Vec<usize>,
    /// For each of them its (d+1)^2 coefficients, index along b fastest.
    pub coefs: Vec<Vec<f64>>,
}

impl Element {
    /// The jets of all functions at (u,v) of the patch, derived by u and v, from 0 to 1.
    pub fn eval(&self, u: f64, v: f64) -> Vec<Jet<1>> {
        self.coefs.iter().map(|b| jet_of_patch(self.degree, b, [u, v])).collect()
    }
}

impl RefinableSpace {
    /// The space V_m, m = `rings`, of `guided5` or `guided6` at `valence`; `None` for other
    /// schemes, valences without rules, and more than [`MAX_RINGS`] rings.
    ///
    /// The splines of `guided3` and `guided4` are made of bi-5 rings, ring by ring: they have no
    /// functions of their own.
    pub fn new(kind: SchemeKind, valence: usize, rings: usize) -> Option<Self> {
        Self::with_contraction(kind, Contraction::CatmullClark, valence, rings)
    }

    /// The same space with another contraction: ring l covers sigma^(l+1) < max(a,b) <= sigma^l.
    /// `None` also if the scheme has no such contraction.
    pub fn with_contraction(
        kind: SchemeKind,
        contraction: Contraction,
        valence: usize,
        rings: usize,
    ) -> Option<Self> {
        let degree = kind.guided_degree().filter(|&degree| degree >= 5 && rings <= MAX_RINGS)?;
        let eigen = Eigenfunctions::with_contraction(kind, contraction, valence)?;
        let layout = Slots::new(degree, eigen.sigma());
        let patches = [0, 1, 2].map(|square| sources(&eigen, layout, square));
        Some(Self { common: Arc::new(Common { eigen, layout, patches }), rings })
    }

    /// The space V_(m+1); `None` if there would be more than [`MAX_RINGS`] rings.
    pub fn refined(&self) -> Option<Self> {
        (self.rings < MAX_RINGS).then(|| self.with_rings(self.rings + 1))
    }

    /// The space V_m with m = `rings`.
    fn with_rings(&self, rings: usize) -> Self {
        Self { common: Arc::clone(&self.common), rings }
    }

    /// The valence.
    pub fn valence(&self) -> usize {
        self.common.eigen.valence()
    }

    /// The number m of rings with functions of their own.
    pub fn num_rings(&self) -> usize {
        self.rings
    }

    /// The bi-degree of the patches, 5 or 6.
    pub fn degree(&self) -> usize {
        self.common.layout.degree
    }

    /// The number of functions: the border, m rings, the guides.
    pub fn dim(&self) -> usize {
        self.first_guide() + self.eigenfunctions().len()
    }

    /// The functions of the border, which come first: 18n, or 24n with bi-6 rings.
    pub fn num_border_functions(&self) -> usize {
        self.valence() * self.common.layout.of_level()
    }

    /// The functions of each ring: 18n, or 36n with bi-6 rings.
    pub fn num_ring_functions(&self) -> usize {
        self.valence() * self.common.layout.slots()
    }

    /// The number of the first guide.
    pub fn first_guide(&self) -> usize {
        self.num_border_functions() + self.rings * self.num_ring_functions()
    }

    /// The eigenfunctions, which the guides follow.
    pub fn eigenfunctions(&self) -> &Eigenfunctions {
        &self.common.eigen
    }

    /// Where function `k` belongs; `None` if `k` is not below [`RefinableSpace::dim`].
    pub fn kind(&self, k: usize) -> Option<FunctionKind> {
        (k < self.dim()).then(|| self.kind_of(k))
    }

    /// Where a function belongs that is known to exist.
    fn kind_of(&self, k: usize) -> FunctionKind {
        let (border, ring) = (self.num_border_functions(), self.num_ring_functions());
        let of_level = self.common.layout.of_level();
        if k < border {
            return FunctionKind::Level { level: 0, sector: k / of_level };
        }
        if k >= self.first_guide() {
            return FunctionKind::Guide { eigenfunction: k - self.first_guide() };
        }
        let (ring, k) = ((k - border) / ring, (k - border) % ring);
        match k.checked_sub(border) {
            None => FunctionKind::Level { level: ring + 1, sector: k / of_level },
            Some(k) => FunctionKind::Ring { ring, sector: k / self.common.layout.of_ring() },
        }
    }

    /// Where function `k` is not zero; `None` if `k` is not below [`RefinableSpace::dim`].
    pub fn support(&self, k: usize) -> Option<Support> {
        let (n, layout) = (self.valence(), self.common.layout);
        let (first_ring, last_ring, sector, slot) = match self.kind(k)? {
            FunctionKind::Guide { .. } => {
                let sectors = (0..n).collect();
                return Some(Support { first_ring: self.rings, last_ring: None, sectors });
            }
            FunctionKind::Level { level, sector } => {
                let first = self.level_number(level, sector, 0);
                (level.saturating_sub(1), level, sector, k - first)
            }
            FunctionKind::Ring { ring, sector } => {
                let first = self.number(ring, sector, layout.of_level());
                (ring, ring, sector, k - first + layout.of_level())
            }
        };
        let before = (sector + n - 1) % n;
        let sectors = if layout.is_on_line(slot) { vec![before, sector] } else { vec![sector] };
        Some(Support { first_ring, last_ring: Some(last_ring), sectors })
    }

    /// The number of a function of `ring` or of the level of its hole, by its slot.
    fn number(&self, ring: usize, sector: usize, slot: usize) -> usize {
        let (layout, n) = (self.common.layout, self.valence());
        let sector = (sector + slot / layout.slots()) % n;
        let (slot, of_level) = (slot % layout.slots(), layout.of_level());
        let first = self.num_border_functions() + ring * self.num_ring_functions();
        match slot.checked_sub(of_level) {
            None => first + sector * of_level + slot,
            Some(own) => first + n * of_level + sector * layout.of_ring() + own,
        }
    }

    /// The number of a function of `level`, by its slot.
    fn level_number(&self, level: usize, sector: usize, slot: usize) -> usize {
        match level.checked_sub(1) {
            Some(ring) => self.number(ring, sector, slot),
            None => {
                let layout = self.common.layout;
                let sector = (sector + slot / layout.slots()) % self.valence();
                sector * layout.of_level() + slot % layout.slots()
            }
        }
    }

    /// The element of a patch: the functions that live on it and their BB coefficients. `None` if
    /// there is no such sector or patch, or the ring is not below [`MAX_RINGS`].
    pub fn element(&self, ring: usize, sector: usize, which: usize) -> Option<Element> {
        let is_known = ring < MAX_RINGS && sector < self.valence() && which < 3;
        is_known.then(|| self.element_of(ring, sector, which))
    }

    /// The element of a patch that is known to exist.
    fn element_of(&self, ring: usize, sector: usize, which: usize) -> Element {
        let size = (self.degree() + 1) * (self.degree() + 1);
        let mut found: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
        let mut add = |function: usize, at: usize, w: f64| {
            found.entry(function).or_insert_with(|| vec![0.0; size])[at] += w;
        };
        let sources = &self.common.patches[which];
        for (at, source) in sources.iter().enumerate() {
            match source {
                Source::Outer(weights) if ring <= self.rings => {
                    weights
                        .iter()
                        .for_each(|&(k, w)| add(self.level_number(ring, sector, k), at, w));
                }
                Source::Inner(weights) if ring < self.rings => {
                    weights.iter().for_each(|&(k, w)| add(self.number(ring, sector, k), at, w));
                }
                _ => {}
            }
        }
        let mut functions: Vec<usize> = found.keys().copied().collect();
        let mut coefs: Vec<Vec<f64>> = found.into_values().collect();
        if ring >= self.rings {
            functions.extend(self.first_guide()..self.dim());
            let guides = 0..self.eigenfunctions().len();
            coefs.extend(guides.map(|k| self.guide_coefs(k, ring, sector, which)));
        }
        let domain = self.domain(ring, which);
        Element { ring, sector, which, domain, degree: self.degree(), functions, coefs }
    }

    /// The coefficients of guide `k` on a patch of ring m or a later one.
    fn guide_coefs(&self, k: usize, ring: usize, sector: usize, which: usize) -> Vec<f64> {
        let mut coefs = self.eigenfunctions().coefs_on(k, ring - self.rings, sector, which);
        if ring == self.rings {
            let sources = coefs.iter_mut().zip(&self.common.patches[which]);
            sources.filter(|(_, s)| matches!(s, Source::Outer(_))).for_each(|(b, _)| *b = 0.0);
        }
        coefs
    }

    /// The part of a sector that a patch covers.
    fn domain(&self, ring: usize, which: usize) -> [[f64; 2]; 2] {
        let size = power(self.eigenfunctions().sigma(), ring);
        self.eigenfunctions().domain(which).map(|side| side.map(|x| size * x))
    }

    /// The BB coefficients on a patch of the sum of all functions times `values`, index along b
    /// fastest. `None` where [`RefinableSpace::element`] is, and if there is not one value for each
    /// function.
    pub fn coefs_of_sum(
        &self,
        values: &[f64],
        ring: usize,
        sector: usize,
        which: usize,
    ) -> Option<Vec<f64>> {
        if values.len() != self.dim() {
            return None;
        }
        let element = self.element(ring, sector, which)?;
        Some(self.sum_on(values, &element))
    }

    /// The BB coefficients of a sum on an element.
    fn sum_on(&self, values: &[f64], element: &Element) -> Vec<f64> {
        let mut sum = vec![0.0; (self.degree() + 1) * (self.degree() + 1)];
        for (&function, coefs) in element.functions.iter().zip(&element.coefs) {
            sum.iter_mut().zip(coefs).for_each(|(sum, b)| *sum += values[function] * b);
        }
        sum
    }

    /// The sum of all functions times `values` at (a,b) of a sector, with its derivatives by a and
    /// b. At the centre (0,0) it has only its value; the derivatives are NaN.
    ///
    /// `None` if there is no such sector, a, b are not from 0 to 1, or there is not one value for
    /// each function. Many points on one patch are cheaper with [`RefinableSpace::element`].
    pub fn eval_sum(&self, values: &[f64], sector: usize, a: f64, b: f64) -> Option<Jet<1>> {
        if values.len() != self.dim() {
            return None;
        }
        self.eval_with(sector, [a, b], values[self.first_guide()], |element| {
            self.sum_on(values, element)
        })
    }

    /// Function `k` at (a,b) of a sector, with its derivatives by a and b; as
    /// [`RefinableSpace::eval_sum`]. `None` if there is no such function or sector, or a, b are not
    /// from 0 to 1.
    pub fn eval(&self, k: usize, sector: usize, a: f64, b: f64) -> Option<Jet<1>> {
        if k >= self.dim() {
            return None;
        }
        let at_center = f64::from(u8::from(k == self.first_guide()));
        self.eval_with(sector, [a, b], at_center, |element| {
            let found = element.functions.iter().position(|&function| function == k);
            let zero = || vec![0.0; (self.degree() + 1) * (self.degree() + 1)];
            found.map_or_else(zero, |at| element.coefs[at].clone())
        })
    }

    fn eval_with(
        &self,
        sector: usize,
        [a, b]: [f64; 2],
        at_center: f64,
        coefs: impl Fn(&Element) -> Vec<f64>,
    ) -> Option<Jet<1>> {
        let is_inside = [a, b].iter().all(|x| (0.0..=1.0).contains(x));
        if sector >= self.valence() || !is_inside {
            return None;
        }
        if a.max(b) == 0.0 {
            return Some(value_alone(at_center));
        }
        let sigma = self.eigenfunctions().sigma();
        let ring = ring_of(a.max(b), sigma);
        let place = [a, b].map(|x| scaled_up(x, ring, sigma));
        let which = self.eigenfunctions().patch_at(place);
        let domain = self.eigenfunctions().domain(which);
        let size = domain.map(|[start, end]| end - start);
        let at = [0, 1].map(|k| (place[k] - domain[k][0]) / size[k]);
        let coefs = coefs(&self.element_of(ring, sector, which));
        let speed = power(1.0 / sigma, ring);
        Some(jet_of_patch(self.degree(), &coefs, at).scaled(1.0, size.map(|size| speed / size)))
    }

    /// The matrix from the values of functions of V_m to the values of functions of V_(m+1): row k
    /// gives the value of function k of V_(m+1).
    ///
    /// It is the identity on the border and the rings. The new ring takes its values from the
    /// guide. The guide shrinks: each eigenfunction is multiplied by its lambda^s.
    pub fn refinement(&self) -> Stencils {
        let (first, guides) = (self.first_guide(), self.eigenfunctions().len());
        let kept = (0..first).map(|k| vec![(k, 1.0)]);
        let columns: Vec<Vec<f64>> = (0..guides).map(|k| self.functions_of_ring(k)).collect();
        let new = (0..self.num_ring_functions()).map(|at| {
            let row = columns.iter().enumerate().map(|(k, column)| (first + k, column[at]));
            row.filter(|(_, w)| *w != 0.0).collect()
        });
        let shrunk = (0..guides).map(|k| vec![(first + k, self.eigenfunctions().eigenvalue_of(k))]);
        let matrix = Stencils::from_rows(self.dim(), kept.chain(new).chain(shrunk));
        matrix.expect("every column is a function")
    }

    /// Eigenfunction `k` on ring 0 as values of the functions of a ring, in the order of their
    /// numbers.
    fn functions_of_ring(&self, k: usize) -> Vec<f64> {
        let (layout, order) = (self.common.layout, self.degree() + 1);
        let rows = layout.functions_from_ring();
        let of_sector = |sector: usize, row: &Vec<((usize, [usize; 2]), f64)>| -> f64 {
            let coef = |square: usize, [i, j]: [usize; 2]| {
                self.eigenfunctions().coefs_on(k, 0, sector, square)[i * order + j]
            };
            row.iter().map(|&((square, at), w)| w * coef(square, at)).sum()
        };
        let (level, own) = rows.split_at(layout.of_level());
        let all = |rows: &[Vec<_>]| -> Vec<f64> {
            let sectors = 0..self.valence();
            sectors.flat_map(|s| rows.iter().map(move |row| of_sector(s, row))).collect()
        };
        [all(level), all(own)].concat()
    }

    /// Eigenfunction `k` as values of the functions of V_m; `None` if there is no such
    /// eigenfunction.
    pub fn eigenfunction(&self, k: usize) -> Option<Vec<f64>> {
        let eigen = self.eigenfunctions();
        let constant = f64::from(u8::from(eigen.guide(k)?.degree() == 0));
        let net = eigen.net(k);
        let per_sector = net.len() / self.valence();
        let node = |sector: usize, at: usize| net[sector * per_sector + at][0] + constant;
        let mut values = self.functions_of_border(node);
        let ring = self.functions_of_ring(k);
        for l in 0..self.rings {
            let factor = power(eigen.eigenvalue_of(k), l);
            values.extend(ring.iter().map(|x| factor * x));
        }
        let guide =
            |other: usize| if other == k { power(eigen.eigenvalue_of(k), self.rings) } else { 0.0 };
        values.extend((0..eigen.len()).map(guide));
        Some(values)
    }

    /// The constant 1 as values of the functions: 1 for all functions of the border and the rings
    /// and for the first guide, else 0.
    pub fn constant(&self) -> Vec<f64> {
        let guide = self.first_guide();
        (0..self.dim()).map(|k| f64::from(u8::from(k <= guide))).collect()
    }

    /// The values of the border's functions from its nodes: node number `at` of a sector.
    fn functions_of_border(&self, node: impl Fn(usize, usize) -> f64) -> Vec<f64> {
        let (rows, order) = (self.common.layout.functions_from_border(), self.degree() + 1);
        let value = |sector: usize, row: &Vec<([usize; 3], f64)>| -> f64 {
            let number = |[edge, layer, k]: [usize; 3]| (edge * LAYERS + layer) * order + k;
            row.iter().map(|&(at, w)| w * node(sector, number(at))).sum()
        };
        let value = &value;
        (0..self.valence()).flat_map(|s| rows.iter().map(move |row| value(s, row))).collect()
    }

    /// The matrix from the nodes of a c-net, sector by sector and the centre last, to the values of
    /// the functions: applied to the nodes' positions, it gives the surface of the scheme.
    ///
    /// Column k is the scheme's own function of node k. Outside of the border that function is the
    /// bi-3 B-spline of the node: together with the B-splines of all other nodes of a cage these
    /// are a basis on the whole surface, which the functions of borders, rings and guides refine.
    pub fn cnet_matrix(&self) -> Stencils {
        let coarse = self.with_rings(0);
        let nodes = CNET_NODES * self.valence() + 1;
        let columns: Vec<Vec<f64>> = (0..nodes).map(|node| coarse.of_node(node)).collect();
        let row = |k: usize| {
            let entries = columns.iter().enumerate().map(|(node, column)| (node, column[k]));
            entries.filter(|(_, w)| *w != 0.0).collect()
        };
        let matrix = Stencils::from_rows(nodes, (0..coarse.dim()).map(row));
        let mut matrix = matrix.expect("every column is a node");
        let mut space = coarse;
        while space.rings < self.rings {
            let next = space.refinement().times(&matrix);
            matrix = next.expect("every row is a function");
            space = space.with_rings(space.rings + 1);
        }
        matrix
    }

    /// The scheme's function of a node of a c-net, in V_0.
    fn of_node(&self, node: usize) -> Vec<f64> {
        let (n, eigen) = (self.valence(), self.eigenfunctions());
        let (limit, net) = eigen.net_of_node(node);
        let per_sector = net.len() / n;
        let mut values = self.functions_of_border(|s, at| net[s * per_sector + at] + limit);
        let monomials = guide_monomials();
        let border = per_sector - monomials.len();
        // The eigenvectors are orthogonal.
        let share = |k: usize| -> f64 {
            let guide = &eigen.guides()[k];
            if guide.degree() == 0 {
                return limit;
            }
            let mut sums = [0.0; 2];
            for (s, (at, &(i, j))) in
                (0..n).flat_map(|s| monomials.iter().enumerate().map(move |m| (s, m)))
            {
                let x = guide.coefficient(s, i, j);
                sums[0] += x * net[s * per_sector + border + at];
                sums[1] += x * x;
            }
            sums[0] / sums[1]
        };
        values.extend((0..eigen.len()).map(share));
        values
    }
}

/// What determines the coefficients of a square.
fn sources(eigen: &Eigenfunctions, layout: Slots, square: usize) -> Vec<Source> {
    let order = layout.degree + 1;
    let coefs = (0..order * order).map(|at| (at, [at / order, at % order]));
    let source = |(at, index)| match layout.coefficient((square, index)) {
        Some(weights) => Source::Inner(weights),
        None => {
            let mut sum = BTreeMap::new();
            for &(node, w) in eigen.border_row(square, at) {
                let (edge, rest) = (node / (LAYERS * order), node % (LAYERS * order));
                for (slot, x) in layout.border(edge, rest / order, rest % order) {
                    *sum.entry(slot).or_insert(0.0) += w * x;
                }
            }
            Source::Outer(sum.into_iter().collect())
        }
    };
    coefs.map(source).collect()
}
