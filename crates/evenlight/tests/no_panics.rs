//! Nothing that takes an id, a number or a length panics: what does not exist is `None` or an
//! error.
#![allow(clippy::unwrap_used, reason = "tests may panic")]

use evenlight::cap::{Cap, CapError, CapOptions};
use evenlight::mesh::{BoundaryRule, Faces, HalfEdgeId, Topology, isolation};
use evenlight::net::{CNet, DNet, Quadratic, Spline};
use evenlight::patch::{Jet, Patch, SurfacePoint};
use evenlight::rings::{MAX_RINGS, Rings};
use evenlight::surface::RuleCache;
use evenlight::{Cage, FaceId, Mesh, QuadId, RuleSet, SchemeKind};
use evenlight::{Surface, SurfaceOptions, VertexId, analyse, basis, patch, tessellate};

const HUGE: usize = usize::MAX;
const PLACES: [[f64; 2]; 5] =
    [[f64::NAN, 0.5], [0.5, f64::NAN], [-0.5, 0.5], [0.5, 1.5], [f64::INFINITY, 0.0]];

/// A cube, whose corners are extraordinary.
fn cube() -> Cage {
    let corner = |k: usize| [(k & 1) as f64, (k >> 1 & 1) as f64, (k >> 2) as f64];
    let faces =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    Cage::new(Mesh::new((0..8).map(corner).collect(), faces)).unwrap()
}

fn surface(scheme: SchemeKind) -> Surface {
    Surface::build(cube(), SurfaceOptions { scheme, ..SurfaceOptions::default() }).unwrap()
}

#[test]
fn patches_and_bases() {
    for degree in [[7, 1], [1, 7], [HUGE, 0], [0, HUGE], [HUGE, HUGE]] {
        assert!(Patch::<3>::new(degree, Vec::new()).is_err());
    }
    assert!(Patch::new([3, 3], vec![[0.0; 2]; 15]).is_err());
    assert!(Patch::<1>::new([0, 0], Vec::new()).is_err());
    let plane = Patch::new([1, 1], vec![[0.0; 3]; 4]).unwrap();
    for (i, j) in [(2, 0), (0, 2), (HUGE, 0), (0, HUGE), (HUGE, HUGE)] {
        assert!(plane.coef(i, j).is_none());
    }
    assert!(plane.jet(f64::NAN, f64::INFINITY).p[0].is_nan());
    assert!(patch::basis::bernstein(7, 0.5).is_none());
    assert!(patch::basis::bernstein(HUGE, f64::NAN).is_none());
    // A point is a patch too, without area.
    let point = Patch::new([0, 0], vec![[1.0; 3]]).unwrap();
    assert_eq!(point.jet(0.3, 0.4), Jet { p: [1.0; 3], ..Jet::default() });
    assert!(!analyse::injectivity::jacobian_is_positive(&point));
    assert_eq!(analyse::shape::shape_energy(&point), 0.0);
    assert_eq!(analyse::shape::gauss_energy(&point), 0.0);
}

#[test]
fn nets_and_quadratics() {
    let empty = DNet::<3> { sectors: Vec::new() };
    assert!(empty.center(Spline::BiCubic).is_none());
    let nothing = CNet { center: [0.0; 3], sectors: Vec::new() };
    assert_eq!(nothing.catmull_clark_limit(), [0.0; 3]);
    assert_eq!(nothing.evolving_guide_limit(), [0.0; 3]);
    assert_eq!(DNet::from_cnet(&nothing, Spline::BiQuartic), empty);
    for kind in SchemeKind::ALL {
        assert!(Rings::from_cnet(&nothing, kind, RuleSet::Generated).is_none());
        assert!(Rings::from_dnet(&empty, kind, RuleSet::Generated).is_none());
        assert!(
            !kind.has_rules(RuleSet::Generated, HUGE) && !kind.has_rules(RuleSet::Published, 0)
        );
    }
    let q = Quadratic { coefs: [[0.0; 3]; 6] };
    for n in [0, 1, 2, 1025, HUGE] {
        assert!(q.in_sector(n, 0).is_none() && q.in_sector(n, HUGE).is_none());
    }
    assert_eq!(q.in_sector(5, HUGE), Some(q));
    for n in [0, 2, 1025] {
        assert!(Quadratic::from_proposals(&vec![[[0.0; 3]; 6]; n]).is_none());
    }
    assert!(q.at(f64::NAN, 0.0)[0].is_nan());
}

#[test]
fn topology_and_faces() {
    let cage = cube();
    let t = cage.topology();
    for id in [24, u32::MAX - 1, u32::MAX] {
        assert!(t.get(HalfEdgeId(id)).is_none() && t.twin(HalfEdgeId(id)).is_none());
        let (face, vertex) = (FaceId(id), VertexId(id));
        assert!(t.half_edge_at(face, 0).is_none() && t.half_edge_at(face, HUGE).is_none());
        assert!(t.faces().corners(face).is_empty());
        assert!(t.ring(vertex).next().is_none() && !t.is_used(vertex) && !t.is_boundary(vertex));
        assert_eq!((t.num_sectors(vertex), t.valence(vertex)), (0, 0));
        assert!(!isolation::is_omitted(&cage, BoundaryRule::EdgeAndCorner, face));
    }
    assert!(t.half_edge_at(FaceId(0), 4).is_none() && t.half_edge_at(FaceId(0), HUGE).is_none());
    assert!(Faces::default().corners(FaceId(0)).is_empty());
    assert!(Topology::build(Faces::default(), HUGE).is_err());
    for corners in [vec![], vec![0, 1], vec![0, 1, 1], vec![0, 1, u32::MAX], vec![0, 1, 3]] {
        let mut faces = Faces::default();
        faces.push(corners.iter().map(|&v| VertexId(v)));
        assert!(Topology::build(faces, 3).is_err(), "{corners:?}");
    }
}

#[test]
fn rings_and_caps() {
    for kind in [SchemeKind::CatmullClark, SchemeKind::Qas4, SchemeKind::Guided5] {
        let surface = surface(kind);
        let rings = surface.rings(0).unwrap();
        let cap = Cap::new(rings, CapOptions::default()).unwrap();
        for [a, b] in PLACES {
            assert!(rings.eval(0, a, b).is_none() && cap.eval(rings, 0, [a, b]).is_none());
            let is_nan = a.is_nan() || b.is_nan();
            assert_eq!(rings.eval_on(0, 0, 0, a, b).is_none(), is_nan);
            assert_eq!(cap.eval_on(rings, 0, 0, [a, b]).is_none(), is_nan);
        }
        for s in [3, HUGE] {
            assert!(rings.eval(s, 0.5, 0.5).is_none() && rings.eval(s, 0.0, 0.0).is_none());
            assert!(rings.eval_on(0, s, 0, 0.5, 0.5).is_none() && rings.patch(0, s, 0).is_none());
            assert!(cap.eval(rings, s, [0.5; 2]).is_none() && cap.patch(rings, s, 0).is_none());
            assert!(cap.eval_on(rings, s, 0, [0.5; 2]).is_none());
        }
        for which in [rings.patches_per_sector(), HUGE] {
            assert!(rings.eval_on(0, 0, which, 0.5, 0.5).is_none());
            assert!(rings.patch(0, 0, which).is_none() && rings.patch_domain(which).is_none());
        }
        for which in [cap.patches_per_sector(), HUGE] {
            assert!(cap.eval_on(rings, 0, which, [0.5; 2]).is_none());
            assert!(cap.patch(rings, 0, which).is_none() && cap.patch_domain(which).is_none());
        }
        for ring in [MAX_RINGS, HUGE] {
            assert!(rings.eval_on(ring, 0, 0, 0.5, 0.5).is_none());
            assert!(rings.patch(ring, 0, 0).is_none() && rings.patches(ring).is_none());
        }
        let last = rings.patch(MAX_RINGS - 1, 0, 0).unwrap();
        assert_eq!(last.coefs()[0], rings.center(), "smaller than the least number");
        let options = CapOptions { rings: HUGE, ..CapOptions::default() };
        assert_eq!(Cap::new(rings, options).unwrap_err(), CapError::Rings { rings: HUGE });
    }
}

#[test]
fn surfaces() {
    let mut surface = surface(SchemeKind::Qas4);
    for quad in [6, u32::MAX].map(QuadId) {
        assert!(surface.eval(quad, 0.5, 0.5).is_none() && surface.face_of(quad).is_none());
        let mut one = [[0.0; 3]];
        surface.eval_grid(quad, &[0.5], &[0.5], &mut one).unwrap();
        assert!(one[0][0].is_nan());
        surface.eval_each(&[(quad, 0.5, 0.5)], &mut one).unwrap();
        assert!(one[0][0].is_nan());
    }
    assert!(surface.eval(QuadId(0), f64::NAN, 0.5).is_none());
    assert!(surface.eval_grid(QuadId(0), &[], &[0.5], &mut [[0.0; 3]]).is_err());
    assert!(surface.eval_each::<SurfacePoint>(&[(QuadId(0), 0.5, 0.5)], &mut []).is_err());
    let mut rows = [0.0];
    for (quads, uv, order) in [
        (&[0][..], &[][..], 0),
        (&[0], &[[0.5; 2]], 0),
        (&[u32::MAX], &[[0.5; 2]], 0),
        (&[], &[], 3),
        (&[], &[], HUGE),
    ] {
        assert!(surface.eval_arrays::<f64>(quads, uv, order, &mut rows).is_err());
    }
    assert!(surface.layout().quads_of(&[u32::MAX], None).is_err());
    assert!(surface.layout().quads_of(&[0], Some(&[u32::MAX])).is_err());
    assert!(surface.layout().quads_of(&[0], Some(&[])).is_err());
    for face in [6, u32::MAX].map(FaceId) {
        assert!(surface.quad(face, 0).is_none() && !surface.is_omitted(face));
    }
    assert!(surface.quad(FaceId(0), 1).is_none() && surface.quad(FaceId(0), HUGE).is_none());
    assert!(!surface.is_infinitely_sharp(HalfEdgeId(u32::MAX)));
    let q = Quadratic { coefs: [[0.0; 3]; 6] };
    for point in [8, HUGE] {
        assert!(surface.rings(point).is_none() && surface.cap(point).is_none());
        assert!(!surface.set_quadratic(point, &q));
        assert!(surface.eval_primvar::<1>(point, QuadId(0), 0.5, 0.5).is_none());
        assert!(surface.primvar_surface::<1>(point).is_none());
    }
    assert!(surface.with_positions(Vec::new()).is_err());
    assert!(surface.with_positions(vec![[f64::NAN; 3]; 8]).is_err());
    let options = CapOptions { rings: HUGE, ..CapOptions::default() };
    assert_eq!(surface.set_caps(Some(options)), Err(CapError::Rings { rings: HUGE }));
    // No more rings than there are.
    let places = surface.patch_places(HUGE).count();
    assert_eq!(places, surface.patch_places(MAX_RINGS).count());
    // Places of another surface.
    let other = self::surface(SchemeKind::Guided5);
    let place = surface.patch_places(2).last().unwrap();
    assert!(surface.patch(&place).is_some());
    let flat = Surface::build(
        Cage::new(Mesh::new(
            vec![[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]],
            [[0, 1, 2, 3]],
        ))
        .unwrap(),
        SurfaceOptions::default(),
    )
    .unwrap();
    assert!(flat.patch(&place).is_none() && flat.eval_on(&place, 0.5, 0.5).is_none());
    let far = other.patch_places(2).last().unwrap();
    let found = surface.patch(&far).map(|patch| patch.degree());
    assert!(found.is_none_or(|degree| degree == [4, 4]));
    assert!(RuleCache::with_capacity(0).is_empty() && RuleCache::with_capacity(HUGE).is_empty());
}

#[test]
fn functions_of_guided_surfaces() {
    use basis::{Eigenfunctions, HomogeneousGuide, RefinableSpace};
    for n in [0, 2, 1025, HUGE] {
        assert!(HomogeneousGuide::all(n, 3).is_none() && basis::multiplicity(n, HUGE).is_none());
        assert!(Eigenfunctions::new(SchemeKind::Guided5, n).is_none());
        assert!(RefinableSpace::new(SchemeKind::Guided5, n, 1).is_none());
    }
    assert_eq!(HomogeneousGuide::all(5, HUGE), Some(Vec::new()));
    let f = Eigenfunctions::new(SchemeKind::Guided5, 5).unwrap();
    for k in [f.len(), HUGE] {
        assert!(f.guide(k).is_none() && f.eigenvalue(k).is_none());
        assert!(f.coefs(k, 0, 0, 0).is_none() && f.eval(k, 0, 0.5, 0.5).is_none());
        assert!(f.eval_on(k, 0, 0, 0, [0.5; 2]).is_none() && f.of_degree(k).is_empty());
    }
    for [ring, sector, which] in [[HUGE, 0, 0], [MAX_RINGS, 0, 0], [0, 5, 0], [0, 0, 3], [HUGE; 3]]
    {
        assert!(f.coefs(0, ring, sector, which).is_none());
        assert!(f.eval_on(0, ring, sector, which, [0.5; 2]).is_none());
    }
    assert!(f.patch_domain(3).is_none() && f.eval(0, HUGE, 0.5, 0.5).is_none());
    assert!(PLACES.iter().all(|&[a, b]| f.eval(1, 0, a, b).is_none()));
    let guide = f.guide(1).unwrap();
    assert_eq!(guide.coefficient(HUGE, HUGE, HUGE), 0.0);
    assert_eq!(guide.coefficient(HUGE, 1, 0), guide.coefficient(HUGE % 5, 1, 0));

    assert!(RefinableSpace::new(SchemeKind::Guided5, 5, HUGE).is_none());
    let deepest = RefinableSpace::new(SchemeKind::Guided5, 5, MAX_RINGS).unwrap();
    assert!(deepest.refined().is_none());
    let space = RefinableSpace::new(SchemeKind::Guided5, 5, 1).unwrap();
    let values = vec![0.0; space.dim()];
    for k in [space.dim(), HUGE] {
        assert!(space.kind(k).is_none() && space.support(k).is_none());
        assert!(space.eigenfunction(k).is_none() && space.eval(k, 0, 0.5, 0.5).is_none());
    }
    for [ring, sector, which] in [[HUGE, 0, 0], [MAX_RINGS, 0, 0], [0, 5, 0], [0, 0, 3], [HUGE; 3]]
    {
        assert!(space.element(ring, sector, which).is_none());
        assert!(space.coefs_of_sum(&values, ring, sector, which).is_none());
    }
    assert!(space.coefs_of_sum(&[], 0, 0, 0).is_none());
    assert!(space.eval_sum(&[], 0, 0.0, 0.0).is_none());
    assert!(space.eval_sum(&values, HUGE, 0.5, 0.5).is_none());
    assert!(PLACES.iter().all(|&[a, b]| space.eval_sum(&values, 0, a, b).is_none()));
    assert!(PLACES.iter().all(|&[a, b]| space.eval(0, 0, a, b).is_none()));
}

#[test]
fn stencils() {
    use evenlight::stencil::{StencilBuilder, Stencils};
    assert!(Stencils::from_rows(0, [vec![(0, 1.0)]]).is_none());
    assert!(Stencils::from_rows(HUGE, [vec![(HUGE, 1.0)]]).is_none());
    let matrix = Stencils::from_rows(2, [vec![(1, 1.0)]]).unwrap();
    assert!(matrix.row(1).is_none() && matrix.row(HUGE).is_none());
    assert!(matrix.apply::<3>(&[]).is_err() && matrix.apply_to_numbers(&[0.0]).is_err());
    assert!(matrix.apply_to(&[[0.0]; 2], &mut []).is_err() && matrix.times(&matrix).is_none());
    let surface = surface(SchemeKind::Qas4);
    let builder = StencilBuilder::of_surface(&surface).unwrap();
    assert!(builder.refined(HUGE).is_err());
    assert!(StencilBuilder::of_primvar(&surface, HUGE).is_err());
    let place = surface.patch_places(1).next().unwrap();
    let patches = builder.patches(&[place]).unwrap();
    assert!(patches.rows(1).is_none() && patches.degree(HUGE).is_none());
    assert!(patches.rows(HUGE).is_none());
}

#[test]
fn complexes() {
    use evenlight::complex::{PatchComplex, PatchEdgeId, PatchId, PatchVertexId};
    let surface = surface(SchemeKind::Qas4);
    assert!(PatchComplex::of(&surface, HUGE).is_err());
    let complex = PatchComplex::of(&surface, 1).unwrap();
    let [patch, edge, vertex] = [u32::MAX; 3];
    let (patch, edge, vertex) = (PatchId(patch), PatchEdgeId(edge), PatchVertexId(vertex));
    assert!(complex.place(patch).is_none() && complex.patch(&surface, patch).is_none());
    assert!(complex.edge(edge).is_none() && complex.border(&surface, edge).is_none());
    assert!(complex.vertex(vertex).is_none() && complex.edges_at(vertex).is_empty());
    assert!(complex.edges_of_side(patch, 0).is_empty() && complex.edges_of_patch(patch).is_empty());
    assert!(
        complex.edges_of_side(PatchId(0), 4).is_empty()
            && complex.neighbours(patch).next().is_none()
    );
    assert!(complex.border_of_use(&surface, PatchEdgeId(0), HUGE).is_none());
    let border = complex.border(&surface, PatchEdgeId(0)).unwrap();
    assert!(border.raised(7).is_none() && border.raised(HUGE).is_none());
    assert!(border.point(f64::NAN)[0].is_nan());
    assert!(complex.locate(QuadId(u32::MAX), 0.5, 0.5).is_none());
    assert!(complex.locate(QuadId(0), f64::NAN, 0.5).is_none());
}

#[test]
fn meshes_of_triangles() {
    let surface = surface(SchemeKind::Qas4);
    assert!(tessellate::tessellate(&surface, 0).is_err());
    assert!(tessellate::tessellate(&surface, HUGE).is_err());
    let mesh = tessellate::tessellate(&surface, 1).unwrap();
    assert!(mesh.parametric_triangle(12).is_none() && mesh.parametric_triangle(HUGE).is_none());
    assert!(mesh.vertex_of_side(8).is_none() && mesh.vertex_of_side(u32::MAX).is_none());
    let none = tessellate::CornerValues::default();
    assert!(mesh.split(&[&none]).is_none() && mesh.split(&[]).is_some());
    assert!(mesh.corner_values(&surface, HUGE).is_none());
    let empty = tessellate::TriangleMesh::default();
    assert!(empty.parametric_triangle(0).is_none() && empty.vertex_of_side(0).is_none());
}

#[cfg(feature = "picture")]
#[test]
fn pictures() {
    use evenlight::picture::{GraphOptions, PictureError, View, eigenfunctions};
    let functions = basis::Eigenfunctions::new(SchemeKind::Guided5, 5).unwrap();
    let number = functions.len();
    for k in [number, HUGE] {
        let error = eigenfunctions(&functions, &[k], &GraphOptions::default()).map(|_| ());
        assert_eq!(error, Err(PictureError::Function { number: k, count: number }));
    }
    assert!(View::toward(&surface(SchemeKind::Qas4), HUGE).is_none());
}
