//! Vertex normals and edges of polygon meshes: closed forms on solids whose answer is known.

use lesk_geometry::import::obj;
use lesk_geometry::polygons::{
    Corner, EdgeKind, EdgeRule, NONE, NormalRule, PolygonData, PolygonMesh, cone_polygons, cube_polygons,
    cylinder_polygons, disk_polygons, rectangle_polygons, sphere_polygons, torus_polygons,
};
use lesk_geometry::{bezier_patch, icosphere, teapot};
use lesk_math::{Vec3, vec3};
use proptest::prelude::*;
use std::f64::consts::{FRAC_1_SQRT_2, PI};

/// Rounding of a sum of a few unit vectors in f64, stored as f32.
const ROUNDING: f32 = 4.0 * f32::EPSILON;

fn close(a: Vec3<f32>, b: Vec3<f32>) -> bool {
    (a - b).length() <= ROUNDING
}

fn kinds(mesh: &PolygonMesh, rule: EdgeRule) -> [usize; 4] {
    let edges = mesh.edges(rule);
    EdgeKind::ALL.map(|kind| edges.iter().filter(|e| e.kind == kind).count())
}

fn crease(degrees: f64) -> EdgeRule {
    EdgeRule::Crease(degrees.to_radians())
}

/// Corner positions with the normals that shading gives them.
fn corner_normals(mesh: &PolygonMesh, rule: NormalRule, edges: EdgeRule) -> Vec<(Vec3<f32>, Vec3<f32>)> {
    let shading = mesh.shading(rule, edges).unwrap();
    let corners = mesh.data().corners.iter().zip(&shading.corners);
    corners.map(|(c, &n)| (mesh.data().positions[c.position as usize], shading.normals[n as usize])).collect()
}

fn faces(positions: &[[f32; 3]], faces: &[&[u32]]) -> PolygonMesh {
    let corner = |&position: &u32| Corner { position, normal: NONE, uv: NONE };
    PolygonMesh::new(PolygonData {
        positions: positions.iter().map(|p| (*p).into()).collect(),
        corners: faces.iter().flat_map(|f| f.iter().map(corner)).collect(),
        sizes: faces.iter().map(|f| f.len() as u32).collect(),
        ..PolygonData::default()
    })
    .unwrap()
}

#[test]
fn a_cube_has_twelve_real_edges_and_three_normals_per_vertex() {
    for rule in [EdgeRule::Stored, crease(30.0), crease(89.9)] {
        let mesh = cube_polygons();
        assert_eq!(kinds(&mesh, rule), [12, 0, 0, 0]);
        let shading = mesh.shading(NormalRule::Mean, rule).unwrap();
        assert_eq!(mesh.vertices(&shading).positions.len(), 24);
        for face in 0..6 {
            let n = mesh.face_normal(face).map(|x| x as f32);
            assert!(mesh.face(face).all(|c| shading.normals[shading.corners[c] as usize] == n));
        }
    }
}

#[test]
fn a_cube_whose_edges_are_auxiliary_has_diagonal_normals() {
    for rule in [NormalRule::Mean, NormalRule::Area, NormalRule::Angle, NormalRule::Max1999] {
        let all = corner_normals(&cube_polygons(), rule, crease(91.0));
        assert!(all.iter().all(|(p, n)| close(p.normalize(), *n)), "{rule:?}");
    }
}

#[test]
fn only_angle_weights_do_not_see_how_a_cube_is_cut_into_triangles() {
    // Thürmer & Wüthrich 1998, figure 1: a diagonal counts a face twice
    let whole = cube_polygons();
    let points: Vec<[f32; 3]> = whole.data().positions.iter().map(|p| p.to_array()).collect();
    let quads = whole.data().corners.chunks(4).map(|c| [0, 1, 2, 3].map(|k| c[k].position));
    let halves: Vec<[u32; 3]> = quads.flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    let mesh = faces(&points, &halves.iter().map(|t| &t[..]).collect::<Vec<_>>());
    let worst = |rule| {
        let all = corner_normals(&mesh, rule, crease(91.0));
        all.iter().map(|(p, n)| (p.normalize() - *n).length()).fold(0.0, f32::max)
    };
    assert!(worst(NormalRule::Angle) < ROUNDING);
    // at six of the vertices one face counts twice: (1, 1, 2)/sqrt 6 against (1, 1, 1)/sqrt 3, 19.5 degrees
    let expected = 2.0 * (0.5 * (4.0 / 18f32.sqrt()).acos()).sin();
    assert!((worst(NormalRule::Mean) - expected).abs() < 1e-6);
    assert!((worst(NormalRule::Area) - expected).abs() < 1e-6);
}

#[test]
fn a_cylinder_is_smooth_around_and_sharp_at_its_rims() {
    let mesh = cylinder_polygons(16, 3, true);
    // stored: the normals of side and cap differ; computed: neighbours on the side turn by 22.5 degrees
    for rule in [EdgeRule::Stored, crease(30.0)] {
        assert_eq!(kinds(&mesh, rule), [32, 16 * 3 + 16 * 2, 0, 0], "{rule:?}");
    }
    assert_eq!(kinds(&mesh, crease(20.0))[0], 32 + 48);
    for rule in [NormalRule::Mean, NormalRule::Area, NormalRule::Angle, NormalRule::Max1999] {
        for (p, n) in corner_normals(&mesh, rule, crease(30.0)) {
            let cap = vec3(0.0, 0.0, if p.z > 0.5 { 1.0 } else { -1.0 });
            // by mirror symmetry the mean of the two neighbours on the side is radial
            assert!(close(n, vec3(p.x, p.y, 0.0)) || close(n, cap), "{rule:?} {p:?} {n:?}");
        }
    }
}

#[test]
fn the_apex_of_a_cone_gets_the_axis_from_faces_and_each_faces_middle_from_the_surface() {
    let mesh = cone_polygons(12, 1, true);
    let is_apex = |p: &Vec3<f32>| p.z == 1.0;
    for rule in [NormalRule::Mean, NormalRule::Area, NormalRule::Angle, NormalRule::Max1999] {
        let all = corner_normals(&mesh, rule, crease(60.0));
        let apex: Vec<_> = all.iter().filter(|(p, _)| is_apex(p)).collect();
        assert_eq!(apex.len(), 12);
        assert!(apex.iter().all(|(_, n)| close(*n, Vec3::Z)), "{rule:?}");
    }
    let all = corner_normals(&mesh, NormalRule::Analytic, EdgeRule::Stored);
    for (face, (_, n)) in all.iter().filter(|(p, _)| is_apex(p)).enumerate() {
        let azimuth = (face as f64 + 0.5) / 12.0 * 2.0 * PI;
        let expected = vec3(azimuth.cos(), azimuth.sin(), 1.0) * FRAC_1_SQRT_2;
        assert!(close(*n, expected.map(|x| x as f32)), "face {face}");
    }
    // where every edge is real, the apex has the normals of the faces
    let flat = corner_normals(&mesh, NormalRule::Mean, crease(0.1));
    for (corner, (p, n)) in flat.iter().enumerate().filter(|(_, (p, _))| is_apex(p)) {
        let face = (0..mesh.face_count()).find(|&f| mesh.face(f).contains(&corner)).unwrap();
        assert!(close(*n, mesh.face_normal(face).map(|x| x as f32)), "{p:?}");
    }
}

#[test]
fn the_mean_of_four_faces_and_of_two_at_a_real_edge_are_those_of_the_lecture() {
    // a roof of four faces; ../shared/design/lecture.md: N = (N1+N2+N3+N4)/4, at an edge N_V = (N2+N3)/2
    let height = |x: f32, y: f32| if x > 0.0 { -x } else { 0.2 * y.abs() };
    let points: Vec<[f32; 3]> =
        (0..9).map(|k| ((k % 3) as f32 - 1.0, (k / 3) as f32 - 1.0)).map(|(x, y)| [x, y, height(x, y)]).collect();
    let roof = faces(&points, &[&[0, 1, 4, 3], &[1, 2, 5, 4], &[3, 4, 7, 6], &[4, 5, 8, 7]]);
    let normals: Vec<Vec3<f64>> = (0..4).map(|f| roof.face_normal(f)).collect();
    let unit = |faces: &[usize]| {
        let sum = faces.iter().fold(Vec3::<f64>::ZERO, |s, &f| s + normals[f]);
        sum.normalize().map(|x| x as f32)
    };
    let at_middle = |rule| -> Vec<Vec3<f32>> {
        let all = corner_normals(&roof, NormalRule::Mean, rule);
        all.iter().filter(|(p, _)| (p.x, p.y) == (0.0, 0.0)).map(|(_, n)| *n).collect()
    };
    assert!(at_middle(crease(180.0)).iter().all(|n| close(*n, unit(&[0, 1, 2, 3]))));
    let split = at_middle(crease(40.0));
    for (n, expected) in split.iter().zip([unit(&[0, 2]), unit(&[1, 3]), unit(&[0, 2]), unit(&[1, 3])]) {
        assert!(close(*n, expected), "{n:?} {expected:?}");
    }
}

#[test]
fn max_1999_is_exact_for_points_on_a_sphere_and_the_others_are_not() {
    let mesh = PolygonMesh::from_triangles(&icosphere(2));
    let worst = |rule, mesh: &PolygonMesh| {
        let all = corner_normals(mesh, rule, crease(180.0));
        all.iter().map(|(p, n)| (*p - *n).length()).fold(0.0, f32::max)
    };
    // Max 1999, section 2; positions are rounded to f32, edges are 0.16 long or more
    let rounding = 8.0 * f32::EPSILON / 0.16;
    assert!(worst(NormalRule::Max1999, &mesh) < rounding, "{}", worst(NormalRule::Max1999, &mesh));
    for other in [NormalRule::Mean, NormalRule::Area, NormalRule::Angle] {
        assert!(worst(other, &mesh) > 1e-3, "{other:?}");
    }
    // four-sided faces around the equator; a polygon counts by its two edges at the vertex
    assert!(worst(NormalRule::Max1999, &sphere_polygons(12, 6)) < rounding);
}

#[test]
fn closed_surfaces_are_closed_and_have_their_euler_characteristic() {
    let cases = [
        (cube_polygons(), 2),
        (sphere_polygons(9, 5), 2),
        (torus_polygons(8, 6, 0.4), 0),
        (cylinder_polygons(7, 2, true), 2),
        (cone_polygons(7, 3, true), 2),
    ];
    for (mesh, expected) in cases {
        let report = mesh.report(EdgeRule::Stored);
        let edges: usize = report.edges.iter().sum();
        assert!(report.closed && report.pinched_vertices == 0);
        assert_eq!(report.positions as i64 - edges as i64 + mesh.face_count() as i64, expected);
        assert_eq!(report.opposed_normals, 0);
    }
}

#[test]
fn open_borders_are_boundary_edges() {
    let square = rectangle_polygons(4, 3);
    assert_eq!(kinds(&square, EdgeRule::Stored), [0, 3 * 3 + 4 * 2, 2 * (4 + 3), 0]);
    assert!(!square.report(EdgeRule::Stored).closed);
    assert_eq!(kinds(&disk_polygons(5), EdgeRule::Stored), [0, 0, 5, 0]);
    let all = corner_normals(&square, NormalRule::Angle, EdgeRule::Stored);
    assert!(all.iter().all(|(_, n)| *n == Vec3::Z));
}

#[test]
fn an_edge_of_three_faces_is_not_manifold_and_separates_normals() {
    let points = [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [-1.0, 0.2, 0.0], [0.0, 1.0, 0.0]];
    let fan = faces(&points, &[&[0, 2, 1], &[0, 1, 3], &[0, 1, 4]]);
    assert_eq!(kinds(&fan, crease(180.0)), [0, 0, 6, 1]);
    let report = fan.report(crease(180.0));
    assert_eq!(report.non_manifold, [[[0.0, 0.0, 0.0], [0.0, 0.0, 1.0]]]);
    for (corner, (_, n)) in corner_normals(&fan, NormalRule::Angle, crease(180.0)).iter().enumerate() {
        assert!(close(*n, fan.face_normal(corner / 3).map(|x| x as f32)));
    }
}

#[test]
fn fans_that_touch_in_a_vertex_have_a_normal_each() {
    let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [-1.0, 0.0, 1.0]];
    let bow = faces(&points, &[&[0, 1, 2], &[0, 3, 4]]);
    let report = bow.report(crease(180.0));
    assert_eq!((report.pinched_vertices, &report.pinched[..]), (1, &[[0.0; 3]][..]));
    let all = corner_normals(&bow, NormalRule::Mean, crease(180.0));
    assert_eq!(all[0].1, Vec3::Z);
    assert_eq!(all[3].1, vec3(0.0, 1.0, 0.0));
}

#[test]
fn faces_that_wind_against_each_other_are_reported_and_normals_turn_them() {
    let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let bad = faces(&points, &[&[0, 1, 2], &[0, 3, 2]]);
    assert_eq!(bad.report(EdgeRule::Stored).twisted_edges, 1);
    let mut data = bad.data().clone();
    data.normals = vec![Vec3::Z];
    data.corners.iter_mut().for_each(|c| c.normal = 0);
    let mut bad = PolygonMesh::new(data).unwrap();
    assert_eq!(bad.report(EdgeRule::Stored).opposed_normals, 3);
    assert_eq!(bad.turn_to_normals(), 1);
    let report = bad.report(EdgeRule::Stored);
    assert_eq!((report.opposed_normals, report.twisted_edges), (0, 0));
}

#[test]
fn generated_surfaces_wind_to_the_side_of_their_normals() {
    let patch: [Vec3<f64>; 16] = std::array::from_fn(|k| {
        let (i, j) = ((k % 4) as f64 / 3.0, (k / 4) as f64 / 3.0);
        vec3(i, j, i * j)
    });
    let meshes =
        [sphere_polygons(12, 7), torus_polygons(24, 16, 0.3), cone_polygons(9, 2, true), bezier_patch(&patch, 5)];
    for mut mesh in meshes {
        assert_eq!(mesh.turn_to_normals(), 0);
    }
    // degree elevation: the patch is z = u v, whose normal is (-v, -u, 1)
    for (p, n) in corner_normals(&bezier_patch(&patch, 5), NormalRule::Analytic, EdgeRule::Stored) {
        assert!((p.z - p.x * p.y).abs() < ROUNDING);
        assert!(close(n, vec3(-p.y, -p.x, 1.0).normalize()));
    }
}

#[test]
fn the_teapot_keeps_its_four_sided_cells() {
    let pot = teapot(8);
    let polygons = pot.polygons().expect("the teapot has polygons");
    // an independent numpy evaluation of the table: 1984 quads and 64 triangles
    let report = polygons.report(EdgeRule::Stored);
    assert_eq!(report.faces.into_iter().collect::<Vec<_>>(), [(3, 64), (4, 1984)]);
    assert!(polygons.data().analytic);
}

#[test]
fn obj_keeps_polygons_smoothing_groups_and_normals_per_corner() {
    let text = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 1\nv 2 1 1\nv 3 0 0\nv 3 1 0\nvn 0 0 1\nvn 1 0 1\n\
                 s 1\nf 1//1 2//1 3//1 4//1\nf 2//2 5//2 6//2 3//2\ns off\nf 5 7 8 6\n";
    let asset = obj::from_bytes(text).unwrap();
    let mesh = asset.meshes[0].mesh.polygons().expect("quads are kept");
    assert_eq!(mesh.data().sizes, [4, 4, 4]);
    assert_eq!(mesh.data().smoothing, [1, 1, 0]);
    assert_eq!((mesh.data().normals.len(), mesh.data().positions.len()), (2, 8));
    // the first pair differs in its normals, the second in its groups
    assert_eq!(kinds(mesh, EdgeRule::Stored)[0], 2);
    let plain = obj::from_bytes(b"v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n").unwrap();
    assert!(plain.meshes[0].mesh.polygons().is_none(), "triangles say nothing more");
}

#[test]
fn a_smoothing_group_that_is_no_number_is_an_error_with_its_line() {
    let message = obj::from_bytes(b"v 0 0 0\ns smooth\n").unwrap_err().to_string();
    assert!(message.starts_with("line 2: `smooth` is no smoothing group"), "{message}");
}

#[test]
fn meshes_without_a_surface_have_no_analytic_normals() {
    let error = cube_polygons().shading(NormalRule::Analytic, EdgeRule::Stored).unwrap_err();
    assert!(error.to_string().contains("no surface"), "{error}");
    assert!("phong".parse::<NormalRule>().unwrap_err().to_string().contains("max1999"));
}

#[test]
fn unusable_polygon_meshes_are_refused_with_their_place() {
    let base = cube_polygons().data().clone();
    let mut broken = vec![];
    let mut change = |f: fn(&mut PolygonData)| {
        let mut data = base.clone();
        f(&mut data);
        broken.push(PolygonMesh::new(data).unwrap_err().to_string());
    };
    change(|d| d.positions[3].y = f32::NAN);
    change(|d| d.sizes[1] = 2);
    change(|d| d.sizes[1] = 5);
    change(|d| d.corners[2].position = 8);
    change(|d| d.corners[2].uv = 4);
    change(|d| d.smoothing = vec![1; 5]);
    change(|d| d.sharp.push([0, 99]));
    let expected =
        ["vertex 3", "face 1 has 2", "25 corners", "position 8", "coordinates 4", "5 smoothing", "position 99"];
    for (message, part) in broken.iter().zip(expected) {
        assert!(message.contains(part), "{message}");
    }
}

proptest! {
    #[test]
    fn any_faces_give_unit_normals(
        coordinates in prop::collection::vec(prop::array::uniform3(-2i8..3), 3..8),
        corners in prop::collection::vec((3usize..6, prop::array::uniform5(0usize..8)), 1..12),
        angle in 0.0..4.0f64,
    ) {
        let points: Vec<[f32; 3]> = coordinates.iter().map(|p| p.map(f32::from)).collect();
        let polygons: Vec<Vec<u32>> = corners
            .iter()
            .map(|(n, c)| c[..*n].iter().map(|&i| (i % points.len()) as u32).collect())
            .collect();
        let mesh = faces(&points, &polygons.iter().map(Vec::as_slice).collect::<Vec<_>>());
        for rule in [NormalRule::Given, NormalRule::Mean, NormalRule::Area, NormalRule::Angle, NormalRule::Max1999] {
            let shading = mesh.shading(rule, EdgeRule::Crease(angle)).unwrap();
            prop_assert!(shading.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-6));
            prop_assert!(mesh.triangulated(&shading).is_ok());
        }
        mesh.report(EdgeRule::Crease(angle));
    }
}
