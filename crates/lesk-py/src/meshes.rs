//! Reports about mesh files, and their edges.

use crate::errors;
use lesk_geometry::import::Asset;
use lesk_geometry::polygons::{EdgeKind, MeshReport};
use lesk_geometry::{EdgeRule, PolygonMesh, Transform};
use numpy::{IntoPyArray, PyArrayMethods};
use pyo3::prelude::*;
use serde_json::{Value, json};
use std::path::PathBuf;

fn rule(crease_angle_deg: Option<f64>) -> EdgeRule {
    crease_angle_deg.map_or(EdgeRule::Stored, |a| EdgeRule::Crease(a.to_radians()))
}

/// The meshes of a file with their names, as polygons.
fn read(path: &std::path::Path) -> Result<(Asset, Vec<(String, PolygonMesh)>), lesk_geometry::Error> {
    let asset = Asset::read(path)?;
    let polygons = |m: &lesk_geometry::import::NamedMesh| match m.mesh.polygons() {
        Some(polygons) => (m.name.clone(), (**polygons).clone()),
        None => (m.name.clone(), PolygonMesh::from_triangles(&m.mesh)),
    };
    let meshes = asset.meshes.iter().map(polygons).collect();
    Ok((asset, meshes))
}

/// Facts about every mesh of a file, as JSON.
#[pyfunction]
pub fn mesh_report_json(py: Python<'_>, path: PathBuf, crease_angle_deg: Option<f64>) -> PyResult<String> {
    let report = || {
        let (asset, meshes) = read(&path)?;
        let facts: Vec<Value> = meshes.iter().map(|(name, m)| facts(name, &m.report(rule(crease_angle_deg)))).collect();
        Ok(json!({ "meshes": facts, "warnings": asset.warnings }).to_string())
    };
    py.detach(report).map_err(geometry)
}

fn geometry(error: lesk_geometry::Error) -> PyErr {
    match error.message.contains("cannot be read") {
        true => errors::FileError::new_err(error.to_string()),
        false => errors::parameter(error),
    }
}

fn facts(name: &str, r: &MeshReport) -> Value {
    let faces: serde_json::Map<String, Value> =
        r.faces.iter().map(|(n, count)| (n.to_string(), json!(count))).collect();
    let kinds = EdgeKind::ALL.iter().zip(r.edges).map(|(kind, n)| (kind.name().to_string(), json!(n)));
    json!({
        "name": name,
        "positions": r.positions,
        "faces": r.faces.values().sum::<usize>(),
        "faces_by_corners": faces,
        "triangles": r.triangles,
        "area_m2": r.area,
        "degenerate_faces": r.degenerate_faces,
        "bent_faces": r.bent_faces,
        "edges": kinds.collect::<serde_json::Map<String, Value>>(),
        "twisted_edges": r.twisted_edges,
        "non_manifold_at": r.non_manifold,
        "pinched_vertices": r.pinched_vertices,
        "pinched_at": r.pinched,
        "stated_normals": r.stated_normals,
        "opposed_normals": r.opposed_normals,
        "largest_deviation_deg": r.largest_deviation.to_degrees(),
        "closed": r.closed,
    })
}

/// Positions (N, 3), edges (M, 2) as numbers of positions, their kinds (M,), corners of all faces and their counts.
type Edges<'py> = (Bound<'py, PyAny>, Bound<'py, PyAny>, Bound<'py, PyAny>, Bound<'py, PyAny>, Bound<'py, PyAny>);

/// All edges of all meshes of a file where they stand.
#[pyfunction]
pub fn mesh_edges(py: Python<'_>, path: PathBuf, crease_angle_deg: Option<f64>) -> PyResult<Edges<'_>> {
    let collect = || {
        let (asset, meshes) = read(&path)?;
        let mut out = Parts::default();
        for placed in &asset.instances {
            out.add(&meshes[placed.mesh].1, &placed.world_from_local, rule(crease_angle_deg));
        }
        Ok(out)
    };
    let parts = py.detach(collect).map_err(geometry)?;
    Ok((
        parts.positions.into_pyarray(py).reshape([parts.count, 3])?.into_any(),
        {
            let n = parts.edges.len() / 2;
            parts.edges.into_pyarray(py).reshape([n, 2])?.into_any()
        },
        parts.kinds.into_pyarray(py).into_any(),
        parts.corners.into_pyarray(py).into_any(),
        parts.sizes.into_pyarray(py).into_any(),
    ))
}

#[derive(Default)]
struct Parts {
    positions: Vec<f32>,
    count: usize,
    edges: Vec<u32>,
    kinds: Vec<u8>,
    corners: Vec<u32>,
    sizes: Vec<u32>,
}

impl Parts {
    fn add(&mut self, mesh: &PolygonMesh, place: &Transform, rule: EdgeRule) {
        let base = self.count as u32;
        let data = mesh.data();
        self.positions.extend(data.positions.iter().flat_map(|&p| place.point(p).to_array()));
        self.count += data.positions.len();
        for edge in mesh.edges(rule) {
            self.edges.extend(edge.ends.map(|p| base + p));
            let kind = EdgeKind::ALL.iter().position(|k| *k == edge.kind);
            self.kinds.push(kind.expect("the list holds every kind") as u8);
        }
        self.corners.extend(data.corners.iter().map(|c| base + c.position));
        self.sizes.extend(&data.sizes);
    }
}
