//! Polygon meshes of surfaces that know their own normals.

use super::{Corner, NONE, PolygonData, PolygonMesh};
use crate::transform::narrow;
use lesk_math::{Vec3, vec3};
use std::f64::consts::{PI, TAU};

/// A point of a parametric surface.
pub(crate) struct Point {
    pub p: Vec3<f64>,
    /// Unit, to the outside.
    pub n: Vec3<f64>,
}

/// Cells along one parameter, at most.
const MAX_CELLS: u32 = 1 << 12;

fn trusted(data: PolygonData) -> PolygonMesh {
    PolygonMesh::new(data).expect("a generated mesh is valid")
}

/// A surface given by a function of two parameters in 0 to 1 that returns position and unit normal, as `columns` by
/// `rows` four-sided faces (1 to 4096 each). Faces wind from u to v: the normal should be dp/du × dp/dv. Where a side
/// of a face has shrunk to a point, the face has three corners, and the normal at the point is that of the middle of
/// the side.
pub fn grid_polygons(columns: u32, rows: u32, surface: impl Fn(f64, f64) -> (Vec3<f64>, Vec3<f64>)) -> PolygonMesh {
    let mut data = PolygonData { analytic: true, ..PolygonData::default() };
    add_grid(&mut data, [columns, rows], |u, v| {
        let (p, n) = surface(u, v);
        Point { p, n }
    });
    trusted(data)
}

/// Adds a grid of cells to a mesh.
pub(crate) fn add_grid(data: &mut PolygonData, cells: [u32; 2], surface: impl Fn(f64, f64) -> Point) {
    let [columns, rows] = cells.map(|n| n.clamp(1, MAX_CELLS));
    let base = data.positions.len() as u32;
    let add = |data: &mut PolygonData, i: f64, j: f64| {
        let (u, v) = (i / f64::from(columns), j / f64::from(rows));
        let point = surface(u, v);
        data.normals.push(narrow(point.n));
        data.uvs.push([u as f32, v as f32]);
        narrow(point.p)
    };
    let attribute = data.normals.len() as u32;
    for (j, i) in (0..=rows).flat_map(|j| (0..=columns).map(move |i| (j, i))) {
        let p = add(data, f64::from(i), f64::from(j));
        data.positions.push(p);
    }
    for (j, i) in (0..rows).flat_map(|j| (0..columns).map(move |i| (j, i))) {
        let number = |[i, j]: [u32; 2]| j * (columns + 1) + i;
        let cell = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]];
        let at = |k: usize| data.positions[(base + number(cell[k % 4])) as usize];
        let collapsed: Vec<bool> = (0..4).map(|k| at(k) == at(k + 1)).collect();
        let before = data.corners.len();
        for k in 0..4 {
            if collapsed[(k + 3) % 4] {
                continue; // the corner before stands for both
            }
            let position = base + number(cell[k]);
            let mut own = attribute + number(cell[k]);
            if collapsed[k] {
                let [a, b] = [cell[k], cell[(k + 1) % 4]];
                let middle = |n: usize| 0.5 * f64::from(a[n] + b[n]);
                own = data.normals.len() as u32;
                add(data, middle(0), middle(1));
            }
            data.corners.push(Corner { position, normal: own, uv: own });
        }
        match data.corners.len() - before {
            size @ 3.. => data.sizes.push(size as u32),
            _ => data.corners.truncate(before),
        }
    }
}

/// cos and sin of a share of the full turn, exact at quarters.
fn turn(u: f64) -> (f64, f64) {
    let quarter = (4.0 * u).round();
    if 4.0 * u == quarter {
        let i = quarter as i64 & 3;
        return ([1.0, 0.0, -1.0, 0.0][i as usize], [0.0, 1.0, 0.0, -1.0][i as usize]);
    }
    ((TAU * u).cos(), (TAU * u).sin())
}

/// The unit sphere as faces between circles of latitude and meridians; at least 3 by 2.
pub fn sphere_polygons(columns: u32, rows: u32) -> PolygonMesh {
    grid_polygons(columns.max(3), rows.max(2), |u, v| {
        let (c, s) = turn(u);
        // from the south pole up, so that the faces wind outward
        let r = if v == 0.0 || v == 1.0 { 0.0 } else { (PI * v).sin() };
        let n = vec3(r * c, r * s, -(PI * v).cos());
        (n, n)
    })
}

/// A torus around the z axis: its centre circle has radius 1, its tube the radius `tube`; at least 3 by 3.
pub fn torus_polygons(columns: u32, rows: u32, tube: f64) -> PolygonMesh {
    grid_polygons(columns.max(3), rows.max(3), |u, v| {
        let ((c, s), (a, b)) = (turn(u), turn(v));
        let n = vec3(a * c, a * s, b);
        (vec3(c, s, 0.0) + n * tube, n)
    })
}

/// The cylinder of radius 1 around the z axis from z = 0 to z = 1, with polygons as caps where `capped`; at least 3
/// columns.
pub fn cylinder_polygons(columns: u32, rows: u32, capped: bool) -> PolygonMesh {
    let columns = columns.clamp(3, MAX_CELLS);
    let mut data = PolygonData { analytic: true, ..PolygonData::default() };
    add_grid(&mut data, [columns, rows], |u, v| {
        let (c, s) = turn(u);
        Point { p: vec3(c, s, v), n: vec3(c, s, 0.0) }
    });
    if capped {
        add_cap(&mut data, columns, 0.0, false);
        add_cap(&mut data, columns, 1.0, true);
    }
    trusted(data)
}

/// The cone with its base of radius 1 in the plane z = 0 and its apex at z = 1; at least 3 columns. The normal at the
/// apex is that of the middle of each face: there is none for the whole.
pub fn cone_polygons(columns: u32, rows: u32, capped: bool) -> PolygonMesh {
    let columns = columns.clamp(3, MAX_CELLS);
    let mut data = PolygonData { analytic: true, ..PolygonData::default() };
    add_grid(&mut data, [columns, rows], |u, v| {
        let (c, s) = turn(u);
        let r = 1.0 - v;
        Point { p: vec3(r * c, r * s, v), n: vec3(c, s, 1.0).normalize() }
    });
    if capped {
        add_cap(&mut data, columns, 0.0, false);
    }
    trusted(data)
}

/// The disk of radius 1 in the plane z = 0 with normal +z, as one polygon of `columns` corners, at least 3.
pub fn disk_polygons(columns: u32) -> PolygonMesh {
    let mut data = PolygonData { analytic: true, ..PolygonData::default() };
    add_cap(&mut data, columns.clamp(3, MAX_CELLS), 0.0, true);
    trusted(data)
}

/// One polygon across the z axis.
fn add_cap(data: &mut PolygonData, columns: u32, z: f64, up: bool) {
    let normal = data.normals.len() as u32;
    data.normals.push(vec3(0.0, 0.0, if up { 1.0 } else { -1.0 }));
    for k in 0..columns {
        let k = if up { k } else { columns - 1 - k };
        let (c, s) = turn(f64::from(k) / f64::from(columns));
        let (position, uv) = (data.positions.len() as u32, data.uvs.len() as u32);
        data.positions.push(narrow(vec3(c, s, z)));
        data.uvs.push([(0.5 + 0.5 * c) as f32, (0.5 + 0.5 * s) as f32]);
        data.corners.push(Corner { position, normal, uv });
    }
    data.sizes.push(columns);
}

/// The square from (-1, -1) to (1, 1) in the plane z = 0, normal +z, as `columns` by `rows` faces.
pub fn rectangle_polygons(columns: u32, rows: u32) -> PolygonMesh {
    grid_polygons(columns, rows, |u, v| (vec3(2.0 * u - 1.0, 2.0 * v - 1.0, 0.0), Vec3::Z))
}

/// The cube from -1 to 1 along every axis: six faces that share eight positions, without normals, every edge sharp.
pub fn cube_polygons() -> PolygonMesh {
    let mut data = PolygonData::default();
    for k in 0..8u8 {
        let at = |bit: u8| if k >> bit & 1 == 1 { 1.0 } else { -1.0 };
        data.positions.push(vec3(at(0), at(1), at(2)));
    }
    // counter-clockwise seen from outside
    let faces: [[u32; 4]; 6] = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    data.uvs.extend([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
    for face in faces {
        data.sizes.push(4);
        data.corners.extend(face.iter().zip(0..).map(|(&position, uv)| Corner { position, normal: NONE, uv }));
        data.sharp.extend((0..4).map(|k| [face[k], face[(k + 1) % 4]]));
    }
    trusted(data)
}
