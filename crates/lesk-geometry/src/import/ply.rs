//! PLY (Turk 1994): ascii and both binary forms, read as a stream.
//!
//! The element `vertex` needs `x`, `y`, `z` and may have `nx`, `ny`, `nz` and `u`, `v` (also `s`, `t` and `texture_u`,
//! `texture_v`); the element `face` needs the list `vertex_indices` (also `vertex_index`). Anything else is skipped.

use super::source::{Endian, Scalar, Source};
use super::{Asset, Error, Result};
use crate::mesh::MeshData;
use crate::polygons::{Corner, NONE, PolygonData, triangulate};
use lesk_math::{Vec3, vec3};
use std::io::Read;
use std::path::Path;

/// Reads a file.
///
/// # Errors
/// A file that cannot be opened; everything that [`from_reader`] finds.
pub fn read(path: &Path) -> Result<Asset> {
    let open = || std::fs::File::open(path).and_then(|f| f.metadata().map(|m| (f, m.len())));
    let (file, length) = open().map_err(|e| Error::unreadable(&e).at(path.display()))?;
    let name = path.file_stem().and_then(|n| n.to_str()).unwrap_or("");
    from_reader(file, length, name).map_err(|e| e.at(path.display()))
}

/// Reads a stream of `length` bytes; the mesh gets the given name.
///
/// # Errors
/// A header that is not understood, elements that are larger than the stream, missing coordinates, numbers that are
/// not numbers, indices out of range, vertices that are not finite.
pub fn from_reader(reader: impl Read, length: u64, name: &str) -> Result<Asset> {
    let mut source = Source::new(reader, length);
    let (format, elements) = header(&mut source)?;
    let mut data = MeshData::default();
    let mut polygons = Polygons::default();
    for element in &elements {
        let place = |e: Error| e.at(format!("element `{}`", element.name));
        element.check_size(format, source.remaining()).map_err(place)?;
        let read = match element.name.as_str() {
            "vertex" => vertices(&mut source, format, element, &mut data),
            "face" => faces(&mut source, format, element, &mut data, &mut polygons),
            _ => skip(&mut source, format, element),
        };
        read.map_err(place)?;
    }
    if data.positions.is_empty() {
        return Err(Error::new("file has no vertices"));
    }
    if data.triangles.is_empty() {
        return Err(Error::new("file has no faces").hint("point clouds cannot be shown"));
    }
    data.triangles.shrink_to_fit();
    let mut asset = Asset::default();
    let polygons = polygons.data(&data);
    asset.add_mesh(name, data, polygons, None)?;
    asset.place_all();
    Ok(asset)
}

/// How the body is written.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Format {
    Ascii,
    Binary(Endian),
}

#[derive(Debug)]
struct Element {
    name: String,
    count: u64,
    properties: Vec<Property>,
}

#[derive(Debug)]
struct Property {
    name: String,
    /// Type of the count, for a list.
    list: Option<Scalar>,
    scalar: Scalar,
}

impl Element {
    /// Refuses an element that cannot fit into the rest of the file.
    fn check_size(&self, format: Format, remaining: u64) -> Result<()> {
        let least: u64 = match format {
            // a digit and a separator each; an empty line at least
            Format::Ascii => (2 * self.properties.len() as u64).saturating_sub(1).max(1),
            Format::Binary(_) => self.properties.iter().map(|p| p.list.unwrap_or(p.scalar).size() as u64).sum(),
        };
        if self.count.saturating_mul(least) > remaining || self.count > u32::MAX as u64 {
            return Err(Error::new(format!(
                "{} entries of at least {least} bytes are declared, but {remaining} bytes are left",
                self.count
            ))
            .hint("the file is cut off, or its header is wrong"));
        }
        Ok(())
    }

    fn position(&self, names: &[&str]) -> Option<usize> {
        self.properties.iter().position(|p| names.contains(&p.name.as_str()))
    }
}

fn header<R: Read>(source: &mut Source<R>) -> Result<(Format, Vec<Element>)> {
    if source.line()?.trim_end() != "ply" {
        return Err(Error::new("file does not begin with `ply`").at("line 1"));
    }
    let mut format = None;
    let mut elements: Vec<Element> = vec![];
    for number in 2..10_000 {
        let line = source.line().map_err(|e| e.at(format!("line {number}")))?;
        let words: Vec<&str> = line.split_ascii_whitespace().collect();
        let bad = || Error::new(format!("`{}` is not understood", line.trim_end())).at(format!("line {number}"));
        match words[..] {
            ["comment" | "obj_info", ..] | [] => {}
            ["format", kind, _] => {
                format = Some(match kind {
                    "ascii" => Format::Ascii,
                    "binary_little_endian" => Format::Binary(Endian::Little),
                    "binary_big_endian" => Format::Binary(Endian::Big),
                    _ => return Err(bad().hint("formats are `ascii`, `binary_little_endian`, `binary_big_endian`")),
                });
            }
            ["element", name, count] => {
                let count = count.parse().map_err(|_| bad())?;
                elements.push(Element { name: name.into(), count, properties: vec![] });
            }
            ["property", "list", count, scalar, name] => {
                let list = Scalar::parse(count).filter(|s| s.is_integer()).ok_or_else(bad)?;
                let scalar = Scalar::parse(scalar).ok_or_else(bad)?;
                let property = Property { name: name.into(), list: Some(list), scalar };
                elements.last_mut().ok_or_else(bad)?.properties.push(property);
            }
            ["property", scalar, name] => {
                let scalar = Scalar::parse(scalar).ok_or_else(bad)?;
                let property = Property { name: name.into(), list: None, scalar };
                elements.last_mut().ok_or_else(bad)?.properties.push(property);
            }
            ["end_header"] => {
                let format = format.ok_or_else(|| Error::new("header has no `format` line"))?;
                return Ok((format, elements));
            }
            _ => return Err(bad()),
        }
    }
    Err(Error::new("header has more than 10000 lines"))
}

/// Where the eight numbers that a vertex may have stand among its properties.
struct VertexLayout {
    position: [usize; 3],
    normal: Option<[usize; 3]>,
    uv: Option<[usize; 2]>,
}

fn layout(element: &Element) -> Result<VertexLayout> {
    if let Some(list) = element.properties.iter().find(|p| p.list.is_some()) {
        return Err(Error::new(format!("property `{}` of a vertex is a list, which is not supported", list.name)));
    }
    let at = |names: &[&str]| element.position(names);
    let missing = || Error::new("a vertex needs the properties `x`, `y` and `z`");
    let axis = |name| at(&[name]).ok_or_else(missing);
    let normal = at(&["nx"]).zip(at(&["ny"])).zip(at(&["nz"]));
    let uv = at(&["u", "s", "texture_u"]).zip(at(&["v", "t", "texture_v"]));
    Ok(VertexLayout {
        position: [axis("x")?, axis("y")?, axis("z")?],
        normal: normal.map(|((x, y), z)| [x, y, z]),
        uv: uv.map(|(u, v)| [u, v]),
    })
}

fn vertices<R: Read>(source: &mut Source<R>, format: Format, element: &Element, data: &mut MeshData) -> Result<()> {
    let layout = layout(element)?;
    let count = element.count as usize;
    *data = MeshData { triangles: std::mem::take(&mut data.triangles), ..MeshData::default() };
    data.positions.reserve_exact(count);
    data.normals.reserve_exact(if layout.normal.is_some() { count } else { 0 });
    data.uvs.reserve_exact(if layout.uv.is_some() { count } else { 0 });
    let mut row = vec![0.0f32; element.properties.len()];
    for i in 0..count {
        for (value, property) in row.iter_mut().zip(&element.properties) {
            *value = number(source, format, property.scalar).map_err(|e| e.at(format!("entry {i}")))? as f32;
        }
        let pick = |k: [usize; 3]| -> Vec3<f32> { vec3(row[k[0]], row[k[1]], row[k[2]]) };
        data.positions.push(pick(layout.position));
        data.normals.extend(layout.normal.map(pick));
        data.uvs.extend(layout.uv.map(|k| [row[k[0]], row[k[1]]]));
    }
    Ok(())
}

/// The faces as the file has them, kept from the first one on that is no triangle.
#[derive(Default)]
struct Polygons {
    sizes: Vec<u32>,
    corners: Vec<u32>,
}

impl Polygons {
    /// Adds a face; `before` are the triangles of all faces before it.
    fn add(&mut self, polygon: &[u32], before: &[[u32; 3]]) {
        if polygon.len() < 3 || (polygon.len() == 3 && self.sizes.is_empty()) {
            return;
        }
        if self.sizes.is_empty() {
            self.sizes = vec![3; before.len()];
            self.corners = before.as_flattened().to_vec();
        }
        self.sizes.push(polygon.len() as u32);
        self.corners.extend(polygon);
    }

    fn data(self, mesh: &MeshData) -> Option<PolygonData> {
        if self.sizes.is_empty() {
            return None;
        }
        let number = |has: bool, i: u32| if has { i } else { NONE };
        let (has_normals, has_uvs) = (!mesh.normals.is_empty(), !mesh.uvs.is_empty());
        let corner = |&i: &u32| Corner { position: i, normal: number(has_normals, i), uv: number(has_uvs, i) };
        Some(PolygonData {
            positions: mesh.positions.clone(),
            normals: mesh.normals.clone(),
            uvs: mesh.uvs.clone(),
            corners: self.corners.iter().map(corner).collect(),
            sizes: self.sizes,
            ..PolygonData::default()
        })
    }
}

fn faces<R: Read>(
    source: &mut Source<R>,
    format: Format,
    element: &Element,
    data: &mut MeshData,
    polygons: &mut Polygons,
) -> Result<()> {
    let Some(indices) = element.position(&["vertex_indices", "vertex_index"]) else {
        return Err(Error::new("a face needs the list `vertex_indices`"));
    };
    if element.properties[indices].list.is_none() {
        return Err(Error::new(format!("`{}` is no list", element.properties[indices].name)));
    }
    data.triangles.reserve_exact(element.count as usize);
    let mut polygon = Vec::new();
    for i in 0..element.count {
        let place = |e: Error| e.at(format!("entry {i}"));
        for (k, property) in element.properties.iter().enumerate() {
            let list = (k == indices).then_some(&mut polygon);
            property_values(source, format, property, list).map_err(place)?;
        }
        polygons.add(&polygon, &data.triangles);
        triangulate(&data.positions, &polygon, &mut data.triangles);
    }
    Ok(())
}

fn skip<R: Read>(source: &mut Source<R>, format: Format, element: &Element) -> Result<()> {
    // entries without properties take no bytes, however many there are
    if element.properties.is_empty() && format != Format::Ascii {
        return Ok(());
    }
    for i in 0..element.count {
        for property in &element.properties {
            property_values(source, format, property, None).map_err(|e| e.at(format!("entry {i}")))?;
        }
    }
    Ok(())
}

/// Reads one property; the numbers of a list go to `polygon`, or nowhere.
fn property_values<R: Read>(
    source: &mut Source<R>,
    format: Format,
    property: &Property,
    polygon: Option<&mut Vec<u32>>,
) -> Result<()> {
    let Some(list) = property.list else {
        return number(source, format, property.scalar).map(|_| ());
    };
    let length = number(source, format, list)?;
    let least = if format == Format::Ascii { 2 } else { property.scalar.size() as u64 };
    if !(length >= 0.0 && length as u64 <= source.remaining() / least + 1) {
        let left = source.remaining();
        return Err(Error::new(format!("list `{}` has the length {length}, {left} bytes are left", property.name)));
    }
    let mut sink = polygon;
    if let Some(polygon) = sink.as_deref_mut() {
        polygon.clear();
    }
    for _ in 0..length as u64 {
        let value = number(source, format, property.scalar)?;
        let Some(polygon) = sink.as_deref_mut() else { continue };
        if value < 0.0 || value > u32::MAX as f64 || value.fract() != 0.0 {
            return Err(Error::new(format!("{value} is no number of a vertex (counted from 0)")));
        }
        polygon.push(value as u32);
    }
    Ok(())
}

fn number<R: Read>(source: &mut Source<R>, format: Format, scalar: Scalar) -> Result<f64> {
    match format {
        Format::Ascii => source.word_as_number(),
        Format::Binary(endian) => source.scalar(scalar, endian),
    }
}
