//! Broken, cut off and hostile files: readers answer with an error or a mesh, and never panic or hang.

use lesk_geometry::import::{Asset, Description, gltf, mtl, obj, ply};
use proptest::prelude::*;
use std::io::Cursor;

/// A pyramid with normals, texture coordinates, a quadrilateral and materials.
const OBJ: &str = include_str!("corpus/pyramid.obj");

const PLY_ASCII: &str = include_str!("corpus/ascii.ply");

const MTL: &str = include_str!("corpus/materials.mtl");

fn ply_binary(big: bool) -> Vec<u8> {
    let order = if big { "big" } else { "little" };
    let header = format!(
        "ply\nformat binary_{order}_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
         property short nx\nproperty short ny\nproperty short nz\nelement face 2\n\
         property list uchar uint vertex_index\nend_header\n"
    );
    let mut out = header.into_bytes();
    let mut put = |bytes: &mut [u8]| {
        if big {
            bytes.reverse();
        }
        out.extend_from_slice(bytes);
    };
    for p in [[0.0f32, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]] {
        p.iter().for_each(|x| put(&mut x.to_le_bytes()));
        [0i16, 0, 1].iter().for_each(|x| put(&mut x.to_le_bytes()));
    }
    for face in [&[0u32, 1, 2][..], &[0, 1, 2, 3]] {
        put(&mut [face.len() as u8]);
        face.iter().for_each(|x| put(&mut x.to_le_bytes()));
    }
    out
}

const GLTF: &str = include_str!("corpus/triangle.gltf");

fn glb() -> Vec<u8> {
    let mut text = GLTF.replace(
        r#","uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAECAAEAAAA=""#,
        "",
    );
    while !text.len().is_multiple_of(4) {
        text.push(' ');
    }
    let mut binary = vec![0u8; 44];
    binary[12..16].copy_from_slice(&1f32.to_le_bytes());
    binary[28..32].copy_from_slice(&1f32.to_le_bytes());
    binary[36..40].copy_from_slice(&[0, 1, 2, 0]);
    let mut out = b"glTF\x02\0\0\0".to_vec();
    out.extend((12 + 16 + text.len() as u32 + 44).to_le_bytes());
    for (kind, body) in [(b"JSON", text.as_bytes()), (b"BIN\0", &binary)] {
        out.extend((body.len() as u32).to_le_bytes());
        out.extend(kind);
        out.extend(body);
    }
    out
}

fn read_ply(bytes: &[u8]) -> lesk_geometry::Result<Asset> {
    ply::from_reader(Cursor::new(bytes), bytes.len() as u64, "test")
}

type Reader = fn(&[u8]) -> lesk_geometry::Result<Asset>;

/// Valid files with their readers: what is bent below.
fn corpus() -> Vec<(&'static str, Reader, Vec<u8>)> {
    vec![
        ("obj", obj::from_bytes, OBJ.into()),
        ("mtl", mtl::from_bytes, MTL.into()),
        ("ply ascii", read_ply, PLY_ASCII.into()),
        ("ply little", read_ply, ply_binary(false)),
        ("ply big", read_ply, ply_binary(true)),
        ("gltf", gltf::from_bytes, GLTF.into()),
        ("glb", gltf::from_bytes, glb()),
    ]
}

#[test]
fn the_corpus_itself_is_read() {
    for (name, read, bytes) in corpus() {
        let asset = read(&bytes).unwrap_or_else(|e| panic!("{name}: {e}"));
        let triangles: usize = asset.meshes.iter().map(|m| m.mesh.triangles().len()).sum();
        let expected = match name {
            "obj" => 6,
            "mtl" => 0,
            "gltf" | "glb" => 2,
            _ => 3,
        };
        assert_eq!(triangles, expected, "{name} {:?}", asset.warnings);
    }
}

#[test]
fn files_cut_off_anywhere_are_read_or_refused() {
    for (_, read, bytes) in corpus() {
        for end in 0..bytes.len() {
            let _ = read(&bytes[..end]);
        }
    }
}

#[test]
fn a_huge_declared_size_is_refused_at_once() {
    for count in ["4294967295", "99999999999", "18446744073709551615", "99999999999999999999999"] {
        let text = PLY_ASCII.replace("vertex 4", &format!("vertex {count}"));
        assert!(read_ply(text.as_bytes()).is_err());
        let text = PLY_ASCII.replace("face 2", &format!("face {count}"));
        assert!(read_ply(text.as_bytes()).is_err());
        let text = PLY_ASCII.replace("element edge 1\nproperty int a\n", &format!("element edge {count}\n"));
        assert!(read_ply(text.as_bytes()).is_err());
        let text = GLTF.replace("\"count\":3", &format!("\"count\":{count}"));
        assert!(gltf::from_bytes(text.as_bytes()).is_err());
    }
    let mut list = ply_binary(false);
    let at = list.len() - 17;
    list[at] = 255;
    assert!(read_ply(&list).is_err());
}

#[test]
fn deeply_nested_json_is_refused() {
    let text = format!(r#"{{"asset":{{"version":"2.0"}},"extras":{}"#, "[".repeat(1_000_000));
    assert!(gltf::from_bytes(text.as_bytes()).is_err());
}

#[test]
fn small_files_that_ask_for_much_work_answer_soon() {
    // many concave polygons of many corners
    let outline: String = (0..2000).map(|i| format!("v {} {} 0\n", i % 45, (i * i) % 37)).collect();
    let face: String = (1..=2000).map(|i| format!(" {i}")).collect();
    let small: String = (1..=60).map(|i| format!(" {}", 1 + (i * 7) % 60)).collect();
    let text = format!("{outline}{}{}", format!("f{face}\n").repeat(10), format!("f{small}\n").repeat(500));
    let _ = obj::from_bytes(text.as_bytes());
    // primitives that share all their data
    let primitive = r#"{"attributes":{"POSITION":0},"indices":1}"#;
    let many = vec![primitive; 400_000].join(",");
    let text = GLTF.replace(r#"{"attributes":{"POSITION":2},"mode":5}"#, &many);
    assert!(gltf::from_bytes(text.as_bytes()).is_err());
}

/// One change of a file: at a place, drop, repeat, overwrite or insert some bytes.
#[derive(Clone, Debug)]
enum Change {
    Drop(usize, usize),
    Repeat(usize, usize),
    Write(usize, Vec<u8>),
    Insert(usize, Vec<u8>),
    Bit(usize, u8),
}

fn change() -> impl Strategy<Value = Change> {
    let words = prop::sample::select(vec![
        "-1",
        "0",
        "1e40",
        "nan",
        "inf",
        "4294967296",
        "18446744073709551615",
        "-0",
        "\n",
        " ",
        "/",
        "[",
        "{",
        "\"",
        "\\",
        "\0\0\0\0",
        "\u{ff}\u{ff}\u{ff}\u{ff}",
        "element vertex 3\n",
        "usemtl x\n",
        "f 1 2 3\n",
        "null",
        "1e309",
    ]);
    let bytes = prop_oneof![words.prop_map(|w| w.as_bytes().to_vec()), prop::collection::vec(any::<u8>(), 1..6)];
    let at = 0..4000usize;
    prop_oneof![
        (at.clone(), 1..40usize).prop_map(|(a, n)| Change::Drop(a, n)),
        (at.clone(), 1..40usize).prop_map(|(a, n)| Change::Repeat(a, n)),
        (at.clone(), bytes.clone()).prop_map(|(a, b)| Change::Write(a, b)),
        (at.clone(), bytes).prop_map(|(a, b)| Change::Insert(a, b)),
        (at, 0..8u8).prop_map(|(a, b)| Change::Bit(a, b)),
    ]
}

fn apply(bytes: &mut Vec<u8>, change: &Change) {
    let place = |a: usize, len: usize| if len == 0 { 0 } else { a % len };
    match change {
        Change::Drop(a, n) => {
            let a = place(*a, bytes.len());
            bytes.drain(a..(a + n).min(bytes.len()));
        }
        Change::Repeat(a, n) => {
            let a = place(*a, bytes.len());
            let part = bytes[a..(a + n).min(bytes.len())].to_vec();
            bytes.splice(a..a, part);
        }
        Change::Write(a, new) => {
            let a = place(*a, bytes.len());
            let end = (a + new.len()).min(bytes.len());
            bytes.splice(a..end, new.iter().copied());
        }
        Change::Insert(a, new) => {
            let a = place(*a, bytes.len());
            bytes.splice(a..a, new.iter().copied());
        }
        Change::Bit(a, bit) => {
            let a = place(*a, bytes.len());
            if let Some(b) = bytes.get_mut(a) {
                *b ^= 1 << bit;
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn bent_files_never_panic_and_what_they_give_is_valid(which in 0..7usize, changes in prop::collection::vec(change(), 1..6)) {
        let (_, read, mut bytes) = corpus().swap_remove(which);
        changes.iter().for_each(|c| apply(&mut bytes, c));
        match read(&bytes) {
            Ok(asset) => {
                for m in &asset.meshes {
                    prop_assert!(m.mesh.positions().iter().all(|p| p.length() < 2e12));
                    let count = m.mesh.positions().len() as u32;
                    prop_assert!(m.mesh.triangles().iter().flatten().all(|&i| i < count));
                    prop_assert!(m.material.is_none_or(|i| i < asset.materials.len()));
                }
                prop_assert!(asset.instances.iter().all(|i| i.mesh < asset.meshes.len()));
                for m in &asset.materials {
                    let numbers = match &m.description {
                        Description::Mtl(m) => [m.kd, m.ks, m.ke, [m.ns, m.d, m.ni]].concat(),
                        Description::MetallicRoughness(m) => [&m.base_color[..], &m.emissive].concat(),
                    };
                    prop_assert!(numbers.iter().all(|x| x.is_finite()));
                }
            }
            Err(e) => prop_assert!(!e.to_string().is_empty()),
        }
    }

    #[test]
    fn random_bytes_never_panic(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        let _ = obj::from_bytes(&bytes);
        let _ = mtl::from_bytes(&bytes);
        let _ = read_ply(&bytes);
        let _ = gltf::from_bytes(&bytes);
        let glb = [b"glTF\x02\0\0\0\x30\0\0\0".as_slice(), &bytes].concat();
        let _ = gltf::from_bytes(&glb);
    }
}
