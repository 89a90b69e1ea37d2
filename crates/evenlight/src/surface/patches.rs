//! The patches of a surface: where they lie, and their polynomials.

use super::caps::CapPlan;
use super::place::{
    PatchPlace, PlacedPatch, RingPatch, Role, Source, Square, from_sector, quadrant, ring_domain,
    to_sector, turned_patch,
};
use super::{Layout, QuadId, Surface};
use crate::mesh::isolation::{CORNERS, Piece};
use crate::patch::basis::{CUBIC_B_SPLINE_TO_BB, cubic_b_spline};
use crate::patch::kernel::{square, sum, sum_of_rows, tensor_jet};
use crate::patch::{Answer, Jet, Parts, Patch, SurfacePoint};
use crate::rings::{MAX_RINGS, in_ring, scaled_up};

impl Layout {
    /// Where the patches of surfaces lie that are not closed: all regular patches and the first
    /// `rings` rings of every extraordinary point, at most [`MAX_RINGS`], quad by quad.
    pub fn patch_places(&self, rings: usize) -> impl Iterator<Item = PatchPlace> + '_ {
        self.places(rings, None)
    }

    /// Where the patches lie; of closed surfaces no more rings than they have, and if it is all of
    /// them the caps.
    pub(crate) fn places<'a>(
        &'a self,
        rings: usize,
        caps: Option<&'a CapPlan>,
    ) -> impl Iterator<Item = PatchPlace> + use<'a> {
        let rings = rings.min(MAX_RINGS);
        (0..self.num_quads() as u32).flat_map(move |quad| {
            let mut places = Vec::new();
            let whole = Square { quad: QuadId(quad), origin: [0.0; 2], size: 1.0 };
            let piece = self.plan.pieces[quad as usize];
            Collector { layout: self, rings, caps }.collect(piece, whole, &mut places);
            places
        })
    }
}

impl Layout {
    /// The patch that evaluation asks at (u,v) of a quad, which are clamped to 0..1, of rings
    /// without end or in front of caps. `None` if there is no surface, no such quad, at a point
    /// without a cap, and if a parameter is NaN.
    pub(crate) fn place_at(
        &self,
        quad: QuadId,
        uv: [f64; 2],
        caps: Option<&CapPlan>,
    ) -> Option<PatchPlace> {
        let mut piece = *self.plan.pieces[..self.num_quads()].get(quad.0 as usize)?;
        let mut square = Square { quad, origin: [0.0; 2], size: 1.0 };
        if uv.iter().any(|x| x.is_nan()) {
            return None;
        }
        let mut at = uv.map(|x| x.clamp(0.0, 1.0));
        loop {
            match piece {
                Piece::Omitted => return None,
                Piece::Regular(net) => return Some(place_of_net(net, square)),
                Piece::Sector { point, sector, corner } => {
                    let (point, sector) = (point as usize, sector as usize);
                    let of_patch = |(role, ring, which)| {
                        let patch = RingPatch { point, sector, ring, which, square, corner };
                        self.place_around(role, patch, caps)
                    };
                    return self.patch_around(point, to_sector(corner, at), caps).map(of_patch);
                }
                Piece::Split(first) => {
                    let k = quadrant(at);
                    piece = self.plan.pieces[first as usize + k];
                    at = [0, 1].map(|d| 2.0 * at[d] - CORNERS[k][d]);
                    square = square.child(k);
                }
            }
        }
    }

    /// Role, ring (from 0) and number of the patch at (a,b) of a sector of a point.
    fn patch_around(
        &self,
        point: usize,
        at: [f64; 2],
        caps: Option<&CapPlan>,
    ) -> Option<(Role, usize, usize)> {
        let rules = self.rules(point).rules().rules();
        let sigma = rules.sigma();
        if let Some(caps) = caps {
            let rings = caps.options.rings;
            let in_hole = at.map(|x| scaled_up(x, rings, sigma));
            if in_hole[0].max(in_hole[1]) <= 1.0 {
                return Some((Role::Cap, rings, caps.rules(point).patch_at(in_hole)));
            }
        }
        if at[0].max(at[1]) == 0.0 {
            return None;
        }
        let (ring, at) = in_ring(at, sigma);
        Some((Role::Ring(ring), ring, rules.patch_at(at)))
    }

    /// The place of a patch around a point.
    fn place_around(&self, role: Role, patch: RingPatch, caps: Option<&CapPlan>) -> PatchPlace {
        let RingPatch { point, sector, ring, which, square, corner } = patch;
        let rules = self.rules(point).rules().rules();
        let (domain, source) = match caps.filter(|_| role == Role::Cap) {
            Some(caps) => (caps.rules(point).patch_domain(which), Source::Cap(patch)),
            None => (rules.patch_domain(which), Source::Ring(patch)),
        };
        PatchPlace {
            role,
            quad: square.quad,
            domain: square.part(ring_domain(corner, rules.sigma(), ring, domain)),
            point: Some(point),
            sector: Some(sector),
            source,
        }
    }
}

fn place_of_net(net: u32, square: Square) -> PatchPlace {
    PatchPlace {
        role: Role::Regular,
        quad: square.quad,
        domain: square.part([[0.0, 1.0], [0.0, 1.0]]),
        point: None,
        sector: None,
        source: Source::Net(net),
    }
}

/// Collects the places of patches.
struct Collector<'a> {
    layout: &'a Layout,
    rings: usize,
    caps: Option<&'a CapPlan>,
}

impl Collector<'_> {
    fn collect(&self, piece: Piece, square: Square, out: &mut Vec<PatchPlace>) {
        match piece {
            Piece::Omitted => {}
            Piece::Regular(net) => out.push(place_of_net(net, square)),
            Piece::Sector { point, sector, corner } => {
                self.collect_sector(point as usize, sector as usize, corner, square, out);
            }
            Piece::Split(first) => {
                for k in 0..4 {
                    let child = self.layout.plan.pieces[first as usize + k];
                    self.collect(child, square.child(k), out);
                }
            }
        }
    }

    fn collect_sector(
        &self,
        point: usize,
        sector: usize,
        corner: u8,
        square: Square,
        out: &mut Vec<PatchPlace>,
    ) {
        let rules = self.layout.rules(point).rules().rules();
        let place = |role, ring, which| {
            let patch = RingPatch { point, sector, ring, which, square, corner };
            self.layout.place_around(role, patch, self.caps)
        };
        let count = self.caps.map_or(self.rings, |caps| self.rings.min(caps.options.rings));
        for ring in 0..count {
            for which in 0..rules.patches_per_sector() {
                out.push(place(Role::Ring(ring), ring, which));
            }
        }
        if let Some(caps) = self.caps.filter(|caps| caps.options.rings <= self.rings) {
            let (cap, ring) = (caps.rules(point), caps.options.rings);
            for which in 0..cap.patches_per_sector() {
                out.push(place(Role::Cap, ring, which));
            }
        }
    }
}

impl<const N: usize> Surface<N> {
    /// All regular patches and the first `rings` rings of every extraordinary point, at most
    /// [`MAX_RINGS`], quad by quad; of a closed surface no more rings than it has, and if it is all
    /// of them the caps.
    pub fn patches(&self, rings: usize) -> impl Iterator<Item = PlacedPatch<N>> + '_ {
        self.patch_places(rings).map(|place| {
            let patch = self.patch_at(&place);
            PlacedPatch { place, patch }
        })
    }

    /// Where the patches of [`Surface::patches`] lie.
    pub fn patch_places(&self, rings: usize) -> impl Iterator<Item = PatchPlace> + '_ {
        self.layout.places(rings, self.cap_plan().map(|plan| &**plan))
    }

    /// Where the patch lies that evaluation asks at (u,v) of `quad`, which are clamped to 0..1: in
    /// which ring however deep, or in the cap. `None` if there is no surface, no such quad, at an
    /// extraordinary point without a cap, and if a parameter is NaN.
    pub fn place_at(&self, quad: QuadId, u: f64, v: f64) -> Option<PatchPlace> {
        self.layout.place_at(quad, [u, v], self.cap_plan().map(|plan| &**plan))
    }

    /// The polynomial of a patch; `None` if the place is not one of this surface.
    pub fn patch(&self, place: &PatchPlace) -> Option<Patch<N>> {
        self.has(place).then(|| self.patch_at(place))
    }

    /// What a patch says at (u,v) of its quad, on its borders too: [`Surface::eval_as`] chooses the
    /// patch by itself. Derivatives are in the quad's parameters and, unlike those of the
    /// polynomial in world coordinates, exact to rounding at any depth. `None` if the place is not
    /// one of this surface.
    pub fn eval_on_as<A: Answer<N>>(&self, place: &PatchPlace, u: f64, v: f64) -> Option<A> {
        self.has(place).then(|| self.answer_on(place, [u, v]))
    }

    /// Whether there is such a patch.
    fn has(&self, place: &PatchPlace) -> bool {
        let in_sector = |p: &RingPatch, patches: usize| {
            let rules = self.layout.rules(p.point).rules().rules();
            p.sector < rules.valence && p.which < patches && p.ring < MAX_RINGS
        };
        match &place.source {
            Source::Net(net) => (*net as usize) < self.layout.plan.nets.len(),
            Source::Ring(p) => {
                p.point < self.rings.len()
                    && in_sector(p, self.rings_at(p.point).patches_per_sector())
            }
            Source::Cap(p) => self
                .cap(p.point)
                .is_some_and(|cap| cap.rings() == p.ring && in_sector(p, cap.patches_per_sector())),
        }
    }

    /// The polynomial of a patch of this surface.
    pub(crate) fn patch_at(&self, place: &PatchPlace) -> Patch<N> {
        match place.source {
            Source::Net(net) => self.regular_patch(net),
            Source::Ring(RingPatch { point, sector, ring, which, corner, .. }) => {
                turned_patch(corner, self.rings_at(point).patch_at(ring, sector, which))
            }
            Source::Cap(RingPatch { point, sector, which, corner, .. }) => {
                let cap = self.cap(point).expect("places of caps are those of caps");
                turned_patch(corner, cap.patch_at(self.rings_at(point), sector, which))
            }
        }
    }

    /// What a patch of this surface says.
    pub(crate) fn answer_on<A: Answer<N>>(&self, place: &PatchPlace, [u, v]: [f64; 2]) -> A {
        match place.source {
            Source::Net(net) => {
                let [[u0, u1], [v0, v1]] = place.domain;
                let at = [(u - u0) / (u1 - u0), (v - v0) / (v1 - v0)];
                let jet = self.regular_jet(<A as Parts<N>>::ORDER, net, at);
                A::from_parts(jet.scaled_parameters(1.0 / (u1 - u0)), Jet::shape)
            }
            Source::Ring(RingPatch { point, sector, ring, which, square, corner }) => {
                let at = to_sector(corner, square.parameters([u, v]));
                let found: A = self.rings_at(point).eval_on_as(ring, sector, which, at);
                let change = |jet: &Jet<N>| from_sector(corner, jet);
                found.in_parameters(|jet| change(jet).scaled_parameters(1.0 / square.size))
            }
            Source::Cap(RingPatch { point, sector, ring, which, square, corner }) => {
                let cap = self.cap(point).expect("places of caps are those of caps");
                let rings = self.rings_at(point);
                let at = rings.in_hole(ring, to_sector(corner, square.parameters([u, v])));
                let found: A = cap.eval_in_patch(rings, sector, which, at);
                let change = |jet: &Jet<N>| from_sector(corner, jet);
                found.in_parameters(|jet| change(jet).scaled_parameters(1.0 / square.size))
            }
        }
    }

    #[inline]
    pub(super) fn net_points(&self, net: u32) -> [[f64; N]; 16] {
        let net = &self.layout.plan.nets[net as usize];
        net.points(&self.levels[net.level as usize])
    }

    #[inline(always)]
    pub(super) fn regular_jet(&self, order: usize, net: u32, [u, v]: [f64; 2]) -> Jet<N> {
        let points = self.net_points(net);
        tensor_jet(order, &cubic_b_spline(u), &cubic_b_spline(v), square(&points))
    }

    fn regular_patch(&self, net: u32) -> Patch<N> {
        let points = self.net_points(net);
        let along_u = CUBIC_B_SPLINE_TO_BB.map(|row| sum_of_rows(&row, square(&points)));
        let along_v = |p: [[f64; N]; 4]| CUBIC_B_SPLINE_TO_BB.map(|row| sum(&row, &p));
        Patch::of([3, 3], along_u.map(along_v).as_flattened().to_vec())
    }
}

impl Surface {
    /// [`Surface::eval_on_as`] of everything.
    pub fn eval_on(&self, place: &PatchPlace, u: f64, v: f64) -> Option<SurfacePoint> {
        self.eval_on_as(place, u, v)
    }
}
