//! Meshes.

use super::super::Asset;
use super::accessor::Numbers;
use super::container::Document;
use super::{Error, Result, element};
use crate::mesh::MeshData;
use ::gltf::json::mesh::{Mode, Primitive, Semantic};
use ::gltf::json::validation::Checked;
use lesk_math::vec3;

/// Adds every primitive as a mesh; returns the numbers of the asset's meshes per mesh of the file.
pub(super) fn add_meshes(document: &Document<'_>, asset: &mut Asset) -> Result<Vec<Vec<usize>>> {
    // primitives may share accessors, so that a small file could ask for endless copies
    let bytes: usize = document.buffers.iter().map(|b| b.len()).sum();
    let mut budget = 4 * bytes + (1 << 20);
    let mut out = Vec::new();
    for (number, mesh) in document.root.meshes.iter().enumerate() {
        let name = mesh.name.clone().unwrap_or_default();
        let mut parts = Vec::new();
        for (k, primitive) in mesh.primitives.iter().enumerate() {
            let place = |e: Error| e.at(format!("mesh {number} `{}`, primitive {k}", name.escape_debug()));
            if let Some(part) = add_primitive(document, primitive, &name, &mut budget, asset).map_err(place)? {
                parts.push(part);
            }
        }
        out.push(parts);
    }
    Ok(out)
}

fn add_primitive(
    document: &Document<'_>,
    primitive: &Primitive,
    name: &str,
    budget: &mut usize,
    asset: &mut Asset,
) -> Result<Option<usize>> {
    let Checked::Valid(mode) = primitive.mode else {
        return Err(Error::new("its mode is unknown"));
    };
    if !matches!(mode, Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan) {
        asset.warn(format!("mesh `{name}`: {mode:?} left out, triangles are shown"));
        return Ok(None);
    }
    let material = primitive.material.map(|m| m.value());
    if let Some(m) = material {
        element(&document.root.materials, m, "material")?;
    }
    if primitive.targets.as_ref().is_some_and(|t| !t.is_empty()) {
        asset.warn(format!("mesh `{name}`: morph targets left out"));
    }
    if primitive.attributes.contains_key(&Checked::Valid(Semantic::Colors(0))) {
        asset.warn(format!("mesh `{name}`: colours of vertices left out"));
    }
    let Some(positions) = attribute(document, primitive, Semantic::Positions, 3)? else {
        asset.warn(format!("mesh `{name}`: a primitive without positions left out"));
        return Ok(None);
    };
    let corners = corners(document, primitive, positions.count, budget)?;
    let triangles = triangles(mode, &corners);
    let data = mesh_data(document, primitive, &positions, triangles)?;
    asset.add_mesh(name, data, None, material)
}

fn attribute<'a>(
    document: &'a Document<'_>,
    primitive: &Primitive,
    semantic: Semantic,
    width: usize,
) -> Result<Option<Numbers<'a>>> {
    let name = format!("{semantic:?}");
    let Some(accessor) = primitive.attributes.get(&Checked::Valid(semantic)) else { return Ok(None) };
    let numbers = Numbers::open(document, accessor.value())?;
    if numbers.width != width {
        let has = numbers.width;
        return Err(Error::new(format!("attribute {name} has {has} components, {width} are needed")));
    }
    Ok(Some(numbers))
}

/// The vertices of the corners, in order.
fn corners(document: &Document<'_>, primitive: &Primitive, vertices: usize, budget: &mut usize) -> Result<Vec<u32>> {
    let indices = primitive.indices.map(|i| Numbers::open(document, i.value())).transpose()?;
    let count = indices.as_ref().map_or(vertices, |i| i.count);
    if count > *budget || vertices > u32::MAX as usize {
        return Err(Error::new(format!("its {count} corners are more than the bytes of the file account for"))
            .hint("primitives that share all their data should be one mesh, placed by several nodes"));
    }
    *budget -= count;
    let Some(indices) = indices else { return Ok((0..count as u32).collect()) };
    let mut out = Vec::with_capacity(count);
    for i in 0..count {
        let index = indices.index(i)?;
        if index as usize >= vertices {
            return Err(Error::new(format!(
                "index {i} is {index}, but there are {vertices} vertices (counted from 0)"
            )));
        }
        out.push(index);
    }
    Ok(out)
}

fn triangles(mode: Mode, c: &[u32]) -> Vec<[u32; 3]> {
    match mode {
        Mode::TriangleStrip => (2..c.len())
            .map(|i| if i % 2 == 0 { [c[i - 2], c[i - 1], c[i]] } else { [c[i - 1], c[i - 2], c[i]] })
            .collect(),
        Mode::TriangleFan => (2..c.len()).map(|i| [c[0], c[i - 1], c[i]]).collect(),
        _ => c.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect(),
    }
}

/// The vertices that the triangles use, renumbered: exporters like to share one buffer between many primitives.
fn mesh_data(
    document: &Document<'_>,
    primitive: &Primitive,
    positions: &Numbers<'_>,
    mut triangles: Vec<[u32; 3]>,
) -> Result<MeshData> {
    let mut used: Vec<u32> = triangles.iter().flatten().copied().collect();
    used.sort_unstable();
    used.dedup();
    if used.len() < positions.count {
        let renumber = |v: &mut u32| *v = used.binary_search(v).expect("every corner is used") as u32;
        triangles.iter_mut().flatten().for_each(renumber);
    }
    let fits = |n: &Numbers<'_>, what: &str| {
        let (has, needs) = (n.count, positions.count);
        if has >= needs { Ok(()) } else { Err(Error::new(format!("{has} {what} for {needs} positions"))) }
    };
    let vector = |n: &Numbers<'_>, i: u32| vec3(n.get(i as usize, 0), n.get(i as usize, 1), n.get(i as usize, 2));
    let mut data = MeshData { triangles, ..MeshData::default() };
    data.positions = used.iter().map(|&i| vector(positions, i)).collect();
    if let Some(normals) = attribute(document, primitive, Semantic::Normals, 3)? {
        fits(&normals, "normals")?;
        data.normals = used.iter().map(|&i| vector(&normals, i)).collect();
    }
    // the file's v runs downward
    let upward = |n: &Numbers<'_>, i: u32| [n.get(i as usize, 0), 1.0 - n.get(i as usize, 1)];
    for (set, list) in [(0, &mut data.uvs), (1, &mut data.uvs_1)] {
        if let Some(uvs) = attribute(document, primitive, Semantic::TexCoords(set), 2)? {
            fits(&uvs, "texture coordinates")?;
            *list = used.iter().map(|&i| upward(&uvs, i)).collect();
        }
    }
    // tangents without normals have no meaning
    if !data.normals.is_empty()
        && let Some(tangents) = attribute(document, primitive, Semantic::Tangents, 4)?
    {
        fits(&tangents, "tangents")?;
        data.tangents = used.iter().map(|&i| [0, 1, 2, 3].map(|k| tangents.get(i as usize, k))).collect();
    }
    Ok(data)
}
