//! Wavefront OBJ: positions, normals, texture coordinates, polygons, smoothing groups, materials by name.
//!
//! Faces are collected into one mesh per object or group and material. Lines, points, curves and free-form surfaces are
//! skipped with a warning.

use super::mtl::{self, Library};
use super::{Asset, Error, Result, inside_folder, read_file};
use crate::mesh::MeshData;
use crate::polygons::{self, PolygonData, triangulate};
use lesk_math::{Vec3, vec3};
use std::collections::HashMap;
use std::path::Path;

/// Reads a file and the material libraries beside it. A library that cannot be read is a warning.
///
/// # Errors
/// A file that cannot be opened; everything that [`from_bytes`] finds; a material library that is not understood.
pub fn read(path: &Path) -> Result<Asset> {
    let bytes = read_file(path)?;
    let load = |name: &str| inside_folder(path, name).and_then(|p| read_file(&p).map(|b| (p, b)));
    parse(&bytes, &load).map_err(|e| e.at(path.display()))
}

/// Reads the text of a file without its material libraries: materials have their names only.
///
/// # Errors
/// Numbers that are not numbers, faces with fewer than three corners, indices out of range, vertices that are not
/// finite; each with its line or vertex.
pub fn from_bytes(bytes: &[u8]) -> Result<Asset> {
    parse(bytes, &|name| Err(Error::new(format!("`{name}` was not given"))))
}

/// Finds a material library: its path and its text.
type Load<'a> = &'a dyn Fn(&str) -> Result<(std::path::PathBuf, Vec<u8>)>;

/// The corners of a face: position, texture coordinates, normal, each counted from 0; [`NONE`] where absent.
type Corner = [u32; 3];

const NONE: u32 = u32::MAX;

/// Faces of one object and material.
#[derive(Default)]
struct Part {
    /// Corner counts of the polygons.
    sizes: Vec<u32>,
    /// Smoothing groups of the polygons, 0 where off.
    groups: Vec<u32>,
    corners: Vec<Corner>,
}

#[derive(Default)]
struct Reader {
    positions: Vec<Vec3<f32>>,
    uvs: Vec<[f32; 2]>,
    normals: Vec<Vec3<f32>>,
    /// In order of appearance.
    parts: Vec<((String, Option<usize>), Part)>,
    part_of: HashMap<(String, Option<usize>), usize>,
    object: String,
    /// The current smoothing group; `None` while the file has stated none.
    group: Option<u32>,
    material: Option<usize>,
    current: Option<usize>,
    /// Names of materials in order of their first use.
    used: Vec<String>,
    used_at: HashMap<String, usize>,
    library: Library,
    skipped: HashMap<String, usize>,
    asset: Asset,
}

fn parse(bytes: &[u8], load: Load<'_>) -> Result<Asset> {
    let mut reader = Reader::default();
    for (number, line) in logical_lines(bytes) {
        reader.line(&line, load).map_err(|e| e.at(format!("line {number}")))?;
    }
    reader.finish()
}

/// Lines without comments, joined where they end in a backslash, with the number of their first line.
pub(super) fn logical_lines(bytes: &[u8]) -> impl Iterator<Item = (usize, String)> + '_ {
    let mut lines = bytes.split(|&b| b == b'\n').enumerate();
    std::iter::from_fn(move || {
        let (number, first) = lines.next()?;
        let clean = |l: &[u8]| {
            let text = String::from_utf8_lossy(l);
            text.split('#').next().unwrap_or("").trim_end().to_string()
        };
        let mut text = clean(first);
        while text.ends_with('\\') {
            text.pop();
            let Some((_, next)) = lines.next() else { break };
            text.push(' ');
            text.push_str(&clean(next));
        }
        Some((number + 1, text))
    })
}

/// The numbers among the words; at least `least` of them, at most `N`.
pub(super) fn numbers<const N: usize>(key: &str, words: &[&str], least: usize) -> Result<[f32; N]> {
    if words.len() < least {
        return Err(Error::new(format!("`{key}` has {} numbers, {least} are needed", words.len())));
    }
    let mut out = [0.0; N];
    for (value, word) in out.iter_mut().zip(words) {
        *value = word.parse().map_err(|_| Error::new(format!("`{}` is no number", word.escape_debug())))?;
    }
    Ok(out)
}

impl Reader {
    fn line(&mut self, line: &str, load: Load<'_>) -> Result<()> {
        let mut words = line.split_ascii_whitespace();
        let Some(key) = words.next() else { return Ok(()) };
        let rest: Vec<&str> = words.collect();
        let name = || line.trim_start()[key.len()..].trim().to_string();
        match key {
            "v" => {
                let [x, y, z] = numbers(key, &rest, 3)?;
                self.positions.push(vec3(x, y, z));
            }
            "vt" => self.uvs.push(numbers(key, &rest, 1)?),
            "vn" => {
                let [x, y, z] = numbers(key, &rest, 3)?;
                self.normals.push(vec3(x, y, z));
            }
            "f" | "fo" => self.face(&rest)?,
            "o" | "g" => {
                self.object = name();
                self.current = None;
            }
            "usemtl" => self.use_material(name()),
            "mtllib" => self.read_library(&name(), &rest, load)?,
            "s" => self.group = Some(smoothing_group(&rest)?),
            "mg" | "vp" => {}
            other => *self.skipped.entry(other.chars().take(20).collect()).or_default() += 1,
        }
        Ok(())
    }

    fn use_material(&mut self, name: String) {
        let next = self.used.len();
        let index = *self.used_at.entry(name.clone()).or_insert(next);
        if index == next {
            self.used.push(name);
        }
        self.material = Some(index);
        self.current = None;
    }

    /// One file whose name may hold spaces, or several.
    fn read_library(&mut self, whole: &str, names: &[&str], load: Load<'_>) -> Result<()> {
        let files = match load(whole) {
            Ok(file) => vec![(whole, Ok(file))],
            Err(e) if names.len() == 1 => vec![(whole, Err(e))],
            Err(_) => names.iter().map(|n| (*n, load(n))).collect(),
        };
        for (name, file) in files {
            match file {
                Ok((path, bytes)) => mtl::parse(&bytes, &path, &mut self.library, &mut |w| self.asset.warn(w))
                    .map_err(|e| e.at(format!("`{name}`")))?,
                Err(e) => self.asset.warn(format!("material library left out: {e}")),
            }
        }
        Ok(())
    }

    fn face(&mut self, words: &[&str]) -> Result<()> {
        if words.len() < 3 {
            return Err(Error::new(format!("face has {} corners, at least 3 are needed", words.len())));
        }
        let part = self.current_part();
        let start = self.parts[part].1.corners.len();
        for word in words {
            let corner = self.corner(word)?;
            self.parts[part].1.corners.push(corner);
        }
        let size = self.parts[part].1.corners.len() - start;
        self.parts[part].1.sizes.push(size as u32);
        self.parts[part].1.groups.push(self.group.unwrap_or(0));
        Ok(())
    }

    fn current_part(&mut self) -> usize {
        if let Some(part) = self.current {
            return part;
        }
        let key = (self.object.clone(), self.material);
        let next = self.parts.len();
        let part = *self.part_of.entry(key.clone()).or_insert(next);
        if part == next {
            self.parts.push((key, Part::default()));
        }
        self.current = Some(part);
        part
    }

    /// `p`, `p/t`, `p//n` or `p/t/n`; negative numbers count backward from the last one so far.
    fn corner(&self, word: &str) -> Result<Corner> {
        let counts = [self.positions.len(), self.uvs.len(), self.normals.len()];
        let names = ["positions", "texture coordinates", "normals"];
        let mut out = [NONE; 3];
        for (k, text) in word.split('/').enumerate() {
            if k >= 3 || (text.is_empty() && k == 0) {
                return Err(Error::new(format!("`{}` is no corner of a face", word.escape_debug())));
            }
            if text.is_empty() {
                continue;
            }
            let index: i64 = text.parse().map_err(|_| Error::new(format!("`{}` is no index", text.escape_debug())))?;
            let count = counts[k] as i64;
            let from_zero = if index < 0 { count + index } else { index - 1 };
            if !(0..count).contains(&from_zero) {
                return Err(Error::new(format!("index {index} into {count} {} (counted from 1)", names[k])));
            }
            out[k] = from_zero as u32;
        }
        Ok(out)
    }

    fn finish(mut self) -> Result<Asset> {
        let mut skipped: Vec<_> = std::mem::take(&mut self.skipped).into_iter().collect();
        skipped.sort();
        for (key, count) in skipped {
            self.asset.warn(format!("{count} lines `{}` skipped", key.escape_debug()));
        }
        for name in &self.used {
            let known = self.library.get(name);
            if known.is_none() && !name.is_empty() {
                self.asset.warn(format!("material `{name}` is used but not defined"));
            }
            self.asset.materials.push(mtl::material(name, known));
        }
        let parts = std::mem::take(&mut self.parts);
        for ((object, material), part) in parts {
            let name = match (object.as_str(), material) {
                ("", Some(m)) => self.used[m].clone(),
                _ => object,
            };
            let data = self.mesh_data(&part);
            let polygons = self.polygons(&part);
            self.asset.add_mesh(&name, data, polygons, material)?;
        }
        if self.asset.meshes.is_empty() {
            return Err(Error::new("file has no faces"));
        }
        self.asset.place_all();
        Ok(self.asset)
    }

    /// The faces as they are, where they say more than triangles with their corners' normals.
    fn polygons(&self, part: &Part) -> Option<PolygonData> {
        if self.group.is_none() && part.sizes.iter().all(|&s| s == 3) {
            return None;
        }
        let mut used = Used::default();
        let mut data = PolygonData { sizes: part.sizes.clone(), ..PolygonData::default() };
        for corner in &part.corners {
            let position = used.number(0, corner[0], || data.positions.push(self.positions[corner[0] as usize]));
            let uv = used.number(1, corner[1], || data.uvs.push(self.uvs[corner[1] as usize]));
            let normal = used.number(2, corner[2], || data.normals.push(self.normals[corner[2] as usize]));
            data.corners.push(polygons::Corner { position, normal, uv });
        }
        if self.group.is_some() {
            data.smoothing = part.groups.clone();
        }
        Some(data)
    }

    /// One vertex per distinct corner.
    fn mesh_data(&self, part: &Part) -> MeshData {
        let mut data = MeshData::default();
        let has = |k: usize| part.corners.iter().any(|c| c[k] != NONE);
        let (has_uvs, has_normals) = (has(1), has(2));
        let mut vertex_of: HashMap<Corner, u32> = HashMap::new();
        let mut polygon = Vec::new();
        let mut corners = part.corners.iter();
        for &size in &part.sizes {
            polygon.clear();
            for corner in corners.by_ref().take(size as usize) {
                let next = data.positions.len() as u32;
                let vertex = *vertex_of.entry(*corner).or_insert(next);
                polygon.push(vertex);
                if vertex != next {
                    continue;
                }
                data.positions.push(self.positions[corner[0] as usize]);
                if has_uvs {
                    data.uvs.push(self.uvs.get(corner[1] as usize).copied().unwrap_or([0.0; 2]));
                }
                if has_normals {
                    // zero: to be replaced by the normal of the faces around
                    data.normals.push(self.normals.get(corner[2] as usize).copied().unwrap_or(Vec3::ZERO));
                }
            }
            triangulate(&data.positions, &polygon, &mut data.triangles);
        }
        data
    }
}

/// `s 1` begins a smoothing group, `s off` and `s 0` end it.
fn smoothing_group(words: &[&str]) -> Result<u32> {
    match words {
        ["off", ..] => Ok(0),
        [number, ..] => number.parse().map_err(|_| {
            Error::new(format!("`{}` is no smoothing group, a number or `off` is accepted", number.escape_debug()))
        }),
        [] => Err(Error::new("`s` has no smoothing group, a number or `off` is accepted")),
    }
}

/// Numbers of a file counted anew for one part of it.
#[derive(Default)]
struct Used([HashMap<u32, u32>; 3]);

impl Used {
    fn number(&mut self, kind: usize, old: u32, first: impl FnOnce()) -> u32 {
        if old == NONE {
            return polygons::NONE;
        }
        let next = self.0[kind].len() as u32;
        *self.0[kind].entry(old).or_insert_with(|| {
            first();
            next
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_are_grouped_by_object_and_material() {
        let text = b"o box\nusemtl red\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nusemtl blue\nf 1 2 4\n\
                     usemtl red\nf -1 -2 -3\n";
        let a = from_bytes(text).unwrap();
        let summary: Vec<_> =
            a.meshes.iter().map(|m| (m.name.as_str(), m.material, m.mesh.triangles().len())).collect();
        assert_eq!(summary, [("box", Some(0), 2), ("box", Some(1), 1)]);
        assert_eq!((a.materials[0].name.as_str(), a.materials[1].name.as_str()), ("red", "blue"));
        assert_eq!(a.instances.len(), 2);
    }

    #[test]
    fn corners_with_equal_numbers_become_one_vertex() {
        let text = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n\
                     f 1/1/1 2/2/1 3/3/1 4/4/1\nf 1/2/1 3/3/1 2/2/1\n";
        let a = from_bytes(text).unwrap();
        let mesh = &a.meshes[0].mesh;
        assert_eq!((mesh.positions().len(), mesh.triangles().len()), (5, 3));
        assert_eq!(mesh.uvs()[2], [1.0, 1.0]);
        assert_eq!(a.warnings, ["mesh: 1 triangles turned to the side of their normals"]);
    }

    #[test]
    fn comments_continuations_and_carriage_returns_are_read() {
        let text = b"# x\r\nv 0 0 0 # origin\r\nv 1 0 \\\r\n0\r\nv 0 1 0\r\nf 1 \\\r\n 2 3\r\n";
        assert_eq!(from_bytes(text).unwrap().meshes[0].mesh.area(), 0.5);
    }

    #[test]
    fn errors_name_the_line_and_what_is_accepted() {
        let cases: [(&[u8], &str); 6] = [
            (b"v 0 0\n", "line 1: `v` has 2 numbers, 3 are needed"),
            (b"v 0 0 0\nf 1 1 2\n", "line 2: index 2 into 1 positions (counted from 1)"),
            (b"v 0 0 0\nf 1 1 -2\n", "line 2: index -2 into 1 positions (counted from 1)"),
            (b"v 0 x 0\n", "line 1: `x` is no number"),
            (b"v 0 0 0\nf 1 1\n", "line 2: face has 2 corners, at least 3 are needed"),
            (b"", "file has no faces"),
        ];
        for (text, expected) in cases {
            assert_eq!(from_bytes(text).unwrap_err().to_string(), expected);
        }
        let infinite = from_bytes(b"v 0 0 inf\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap_err().to_string();
        assert!(infinite.contains("vertex 0"), "{infinite}");
    }
}
