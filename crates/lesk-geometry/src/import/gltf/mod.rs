//! glTF 2.0 and GLB: meshes, node transforms, metallic-roughness materials, cameras and punctual lights.
//!
//! The JSON is parsed by the crate `gltf`; every index, offset and count in it is checked here, because its own
//! validation trusts some of them. Skins, morph targets and animations are left out: shapes stand in their rest pose.

mod accessor;
mod container;
mod material;
mod nodes;
mod primitive;

use super::{Asset, Error, Result, read_file};
use ::gltf::json::Root;
use container::Document;
use std::path::Path;

/// Extensions that a file may require.
const SUPPORTED: [&str; 7] = [
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_transmission",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
];

/// Reads a `.gltf` or `.glb` file, with the buffers beside it; images are named, not read.
///
/// # Errors
/// A file that cannot be opened; everything that [`from_bytes`] finds.
pub fn read(path: &Path) -> Result<Asset> {
    parse(&read_file(path)?, Some(path)).map_err(|e| e.at(path.display()))
}

/// Reads a document without files beside it.
///
/// # Errors
/// JSON that is not glTF 2.0; required extensions that are not supported, all in one message; indices, offsets and
/// counts that lead out of the document; a node graph that is no tree; vertices that are not finite.
pub fn from_bytes(bytes: &[u8]) -> Result<Asset> {
    parse(bytes, None)
}

fn parse(bytes: &[u8], path: Option<&Path>) -> Result<Asset> {
    let document = Document::open(bytes, path)?;
    let mut asset = Asset::default();
    for name in document.root.extensions_used.iter().filter(|e| !SUPPORTED.contains(&e.as_str())) {
        asset.warn(format!("extension `{}` is used, not required and left out", name.escape_debug()));
    }
    material::add_materials(&document, &mut asset)?;
    let meshes = primitive::add_meshes(&document, &mut asset)?;
    nodes::add_nodes(&document, &meshes, &mut asset)?;
    Ok(asset)
}

/// Refuses what the file cannot do without and this crate cannot do.
fn check_version(root: &Root) -> Result<()> {
    let version = root.asset.min_version.as_ref().unwrap_or(&root.asset.version);
    if !version.starts_with("2.") {
        return Err(Error::new(format!("file is glTF {}, version 2.0 is accepted", version.escape_debug())));
    }
    let mut missing: Vec<String> = root
        .extensions_required
        .iter()
        .filter(|e| !SUPPORTED.contains(&e.as_str()))
        .map(|e| format!("`{e}`"))
        .collect();
    missing.sort();
    missing.dedup();
    if missing.is_empty() {
        return Ok(());
    }
    let list: Vec<String> = SUPPORTED.iter().map(|e| format!("`{e}`")).collect();
    Err(Error::new(format!("file requires {}, which is not supported", missing.join(", ")))
        .hint(format!("export without it; supported are {}", list.join(", "))))
}

/// An element of a list of the document, by its number.
fn element<'a, T>(list: &'a [T], index: usize, what: &str) -> Result<&'a T> {
    let count = list.len();
    list.get(index).ok_or_else(|| Error::new(format!("{what} {index} is used, but there are {count} (counted from 0)")))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(json: &str) -> String {
        from_bytes(json.as_bytes()).unwrap_err().to_string()
    }

    #[test]
    fn required_extensions_that_are_missing_are_listed_in_one_error() {
        let json = r#"{"asset":{"version":"2.0"},"extensionsRequired":
            ["KHR_draco_mesh_compression","EXT_b","KHR_lights_punctual","EXT_b"]}"#;
        assert!(
            message(json).starts_with("file requires `EXT_b`, `KHR_draco_mesh_compression`, which is not supported\n")
        );
        assert!(message(r#"{"asset":{"version":"1.0"}}"#).contains("version 2.0 is accepted"));
    }

    #[test]
    fn node_graphs_that_are_no_trees_are_refused() {
        let cycle =
            r#"{"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"children":[1]},{"children":[0]}]}"#;
        assert!(message(cycle).contains("node 0 is reached twice"), "{}", message(cycle));
        let shared = r#"{"asset":{"version":"2.0"},"scenes":[{"nodes":[0,1]}],"nodes":[{"children":[1]},{}]}"#;
        assert!(message(shared).contains("node 1 is reached twice"));
        let missing = r#"{"asset":{"version":"2.0"},"scenes":[{"nodes":[7]}]}"#;
        assert!(message(missing).contains("node 7 is used, but there are 0"));
    }

    /// One triangle whose parts can be bent by the tests.
    fn triangle(view: &str, accessor: &str) -> String {
        let data = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
        format!(
            r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],
            "nodes":[{{"mesh":0,"name":"n","translation":[1,2,3]}}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],
            "buffers":[{{"byteLength":36,"uri":"data:application/octet-stream;base64,{data}"}}],
            "bufferViews":[{{"buffer":0,"byteLength":36{view}}}],
            "accessors":[{{"bufferView":0,"componentType":5126,"type":"VEC3","count":3{accessor}}}]}}"#
        )
    }

    #[test]
    fn a_triangle_in_a_data_uri_is_read_and_placed() {
        let asset = from_bytes(triangle("", "").as_bytes()).unwrap();
        assert_eq!(asset.meshes[0].mesh.area(), 0.5);
        assert_eq!(asset.instances[0].name, "n");
        let p = asset.instances[0].world_from_local.point(lesk_math::Vec3::ZERO);
        assert_eq!(p.to_array(), [1.0, 2.0, 3.0]);
    }

    #[test]
    fn accessors_and_views_that_lead_out_of_their_buffer_are_refused() {
        let cases = [
            (r#","byteOffset":4"#, "", "buffer view 0"),
            (r#","byteOffset":18446744073709551615"#, "", "buffer view 0"),
            (r#","byteStride":13"#, "", "accessor 0"),
            ("", r#","byteOffset":8"#, "accessor 0"),
            ("", r#","byteOffset":18446744073709551612"#, "accessor 0"),
            (r#","byteStride":1000000000000"#, "", "accessor 0"),
        ];
        for (view, accessor, expected) in cases {
            let text = message(&triangle(view, accessor));
            assert!(text.contains(expected), "{view} {accessor}: {text}");
        }
        let huge = triangle("", "").replace("\"count\":3", "\"count\":4611686018427387904");
        assert!(message(&huge).contains("accessor 0"));
        let sparse = triangle("", "")
            .replace("\"bufferView\":0,\"comp", "\"comp")
            .replace("\"count\":3", "\"count\":99999999999");
        assert!(message(&sparse).contains("accessor 0"), "{}", message(&sparse));
    }

    #[test]
    fn texture_coordinates_run_upward_and_texture_transforms_with_them() {
        let material = r#""materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"texCoord":1,
            "extensions":{"KHR_texture_transform":{"offset":[0.1,0.2],"rotation":0.5,"scale":[2,3]}}}}}],
            "textures":[{"source":0}],"images":[{"uri":"data:image/png;base64,AAAA"}],"buffers"#;
        let json = triangle("", "")
            .replace("\"buffers", material)
            .replace(r#"{"POSITION":0}"#, r#"{"POSITION":0,"TEXCOORD_0":1,"TEXCOORD_1":1},"material":0"#)
            .replace(
                r#""accessors":["#,
                r#""accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":3},
                {"bufferView":0,"byteOffset":12,"componentType":5126,"type":"VEC2","count":3},"#,
            );
        let asset = from_bytes(json.as_bytes()).unwrap();
        // floats 3 to 8 of the buffer: (1, 0), (0, 0), (1, 0)
        let expected = [[1.0, 1.0], [0.0, 1.0], [1.0, 1.0]];
        let mesh = &asset.meshes[0].mesh;
        assert_eq!((mesh.uv_list(0), mesh.uv_list(1)), (&expected[..], &expected[..]));
        let super::super::Description::MetallicRoughness(m) = &asset.materials[0].description else { panic!() };
        let texture = m.base_color_texture.as_ref().unwrap();
        assert_eq!(texture.uv_set, 1);
        // the matrix of the extension's text, row by row: T * R * S
        let (s, c) = 0.5f32.sin_cos();
        let stated = |u: f32, v: f32| [2.0 * c * u + 3.0 * s * v + 0.1, -2.0 * s * u + 3.0 * c * v + 0.2];
        for (u, v) in [(0.0, 0.0), (1.0, 0.0), (0.3, 0.8)] {
            let up = texture.uv.map(|row| row[0] * u + row[1] * (1.0 - v) + row[2]);
            let [x, y] = stated(u, v);
            assert!((up[0] - x).abs() < 1e-6 && (up[1] - (1.0 - y)).abs() < 1e-6, "{up:?} {x} {y}");
        }
    }

    #[test]
    fn sparse_accessors_replace_elements() {
        // the last vertex (0, 1, 0) becomes the first three numbers of the buffer again, shifted: (0, 0, 1)
        let sparse = r#","sparse":{"count":1,"indices":{"bufferView":1,"componentType":5121},
            "values":{"bufferView":0,"byteOffset":4}}"#;
        let json = triangle("", sparse).replace(
            r#""bufferViews":["#,
            r#""bufferViews":[{"buffer":0,"byteLength":36},{"buffer":1,"byteLength":1},"#,
        );
        let second = r#"AAAAgD8AAAAA"},{"byteLength":1,"uri":"data:;base64,Ag=="}]"#;
        let json = json.replace(r#"AAAAgD8AAAAA"}]"#, second);
        let asset = from_bytes(json.as_bytes()).unwrap();
        // bytes 4..16 of the buffer: (0, 0, 1)
        assert_eq!(asset.meshes[0].mesh.positions()[2].to_array(), [0.0, 0.0, 1.0]);
    }

    #[test]
    fn references_out_of_the_folder_are_refused() {
        for uri in ["../a.bin", "/etc/passwd", "file:///etc/passwd", "http://x/y", "%2e%2e/a.bin"] {
            let json = format!(r#"{{"asset":{{"version":"2.0"}},"buffers":[{{"byteLength":1,"uri":"{uri}"}}]}}"#);
            let text = parse(json.as_bytes(), Some(Path::new("none/a.gltf"))).unwrap_err().to_string();
            assert!(text.contains("folder") || text.contains("relative path"), "{uri}: {text}");
        }
    }
}
