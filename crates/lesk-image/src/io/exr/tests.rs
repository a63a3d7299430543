use super::*;
use crate::{Film, FilmSpec, Sample, Samples};

fn planes(width: u32, height: u32) -> Planes {
    let n = (width * height) as usize;
    let mut planes = Planes::new(width, height).unwrap();
    let float = |c: usize| (0..n).map(|i| ((i * 7 + c) as f32).sin() * 1e3).collect();
    planes.push("R", Samples::Float(float(0))).unwrap();
    planes.push("G", Samples::Float(float(1))).unwrap();
    planes.push("B", Samples::Float(float(2))).unwrap();
    planes.push("depth.Z", Samples::Half((0..n).map(|i| i as f32 * 0.25).collect())).unwrap();
    planes.push("id.object", Samples::Uint((0..n as u32).map(|i| i * 1_000_003).collect())).unwrap();
    planes.attributes = vec![("unit".into(), "cd/m2".into()), ("a note".into(), "äöü — 2700 K".into())];
    planes.white_luminance = Some(1.0);
    planes
}

/// The same channels in the order of an EXR file.
fn sorted(planes: &Planes) -> Vec<crate::Plane> {
    let mut list = planes.planes().to_vec();
    list.sort_by(|a, b| a.name.cmp(&b.name));
    list
}

#[test]
fn written_planes_come_back_bit_by_bit() {
    // sizes around the 16 lines of a block
    for (width, height) in [(1, 1), (5, 3), (64, 16), (33, 17), (7, 100)] {
        let before = planes(width, height);
        let after = decode(&encode(&before).unwrap()).unwrap();
        assert_eq!(sorted(&after), sorted(&before), "{width} x {height}");
        assert_eq!(after.attribute("unit"), Some("cd/m2"));
        assert_eq!(after.attribute("a note"), Some("äöü — 2700 K"));
        assert_eq!(after.white_luminance, Some(1.0));
    }
}

#[test]
fn noise_that_does_not_compress_comes_back() {
    let mut planes = Planes::new(200, 40).unwrap();
    let mut state = 1u32;
    let mut noise = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f32::from_bits(state >> 2)
    };
    planes.push("Y", Samples::Float((0..8000).map(|_| noise()).collect())).unwrap();
    assert_eq!(decode(&encode(&planes).unwrap()).unwrap().planes(), planes.planes());
}

#[test]
fn nan_and_infinity_are_kept_and_half_clamps() {
    let mut planes = Planes::new(4, 1).unwrap();
    let values = vec![f32::NAN, f32::INFINITY, 1e6, -1e-9];
    planes.push("a", Samples::Float(values.clone())).unwrap();
    planes.push("b", Samples::Half(values)).unwrap();
    let back = decode(&encode(&planes).unwrap()).unwrap();
    let get = |name: &str, i| back.plane(name).unwrap().samples.get(i);
    assert!(get("a", 0).is_nan() && get("b", 0).is_nan());
    assert_eq!((get("a", 1), get("b", 1)), (f32::INFINITY, f32::INFINITY));
    assert_eq!((get("a", 2), get("b", 2)), (1e6, 65_504.0));
}

#[test]
fn equal_films_give_equal_bytes_whatever_the_order_of_attributes() {
    let bytes = |settings: &[(&str, &str)]| {
        let mut film = Film::new(FilmSpec::new(20, 20)).unwrap();
        film.add(3, 4, &Sample::of([1.0, 2.0, 3.0]));
        encode(&film.planes(settings).unwrap()).unwrap()
    };
    assert_eq!(bytes(&[("spp", "1"), ("seed", "7")]), bytes(&[("seed", "7"), ("spp", "1")]));
}

#[test]
fn long_names_are_flagged_and_come_back() {
    let mut planes = Planes::new(1, 1).unwrap();
    let name = "a_layer_with_quite_a_long_name_indeed.R";
    planes.push(name, Samples::Float(vec![2.0])).unwrap();
    let bytes = encode(&planes).unwrap();
    assert_eq!(bytes[5], 4);
    assert_eq!(decode(&bytes).unwrap().plane(name).unwrap().samples.get(0), 2.0);
}

#[test]
fn names_of_the_format_are_refused_as_attributes() {
    for name in ["compression", "", "unit", "a\0b"] {
        let mut planes = planes(1, 1);
        planes.attributes.push((name.into(), String::new()));
        assert!(encode(&planes).is_err(), "{name}");
    }
    assert!(encode(&Planes::new(1, 1).unwrap()).is_err());
}

#[test]
fn files_of_every_compression_of_the_crate_exr_are_read() {
    use ::exr::prelude::*;
    let pixel = |x: usize, y: usize| (x as f32 * 0.5, y as f32, (x * y) as f32 * 0.01);
    let compressions = [
        Compression::Uncompressed,
        Compression::RLE,
        Compression::ZIP1,
        Compression::ZIP16,
        Compression::PIZ,
        Compression::PXR24,
        Compression::B44,
        Compression::DWAA(None),
    ];
    for compression in compressions {
        let encoding = Encoding { compression, ..Encoding::FAST_LOSSLESS };
        let channels = SpecificChannels::rgb(|Vec2(x, y)| pixel(x, y));
        let layer = Layer::new((40, 30), LayerAttributes::named("main"), encoding, channels);
        let mut bytes = std::io::Cursor::new(Vec::new());
        Image::from_layer(layer).write().non_parallel().to_buffered(&mut bytes).unwrap();
        let image = super::decode(bytes.get_ref()).unwrap().picture().unwrap();
        let [r, g, b] = image.rgb(20, 10);
        // the lossy ones keep about 1 %
        let (r0, g0, b0) = pixel(20, 10);
        let close = |a: f32, b: f32| (a - b).abs() < 0.02 * b;
        assert!(close(r, r0) && close(g, g0) && close(b, b0), "{compression}: {r} {g} {b}");
    }
}

#[test]
fn huge_declared_sizes_are_refused_before_memory_is_taken() {
    let bytes = encode(&planes(8, 8)).unwrap();
    let at = bytes.windows(11).position(|w| w == b"dataWindow\0").unwrap() + 11 + 6 + 4;
    for (right, bottom) in [(65_534, 1500), (65_535, 65_535), (i32::MAX, 7), (-2, 7), (70_000, 0)] {
        let mut bytes = bytes.clone();
        bytes[at + 8..at + 12].copy_from_slice(&i32::to_le_bytes(right));
        bytes[at + 12..at + 16].copy_from_slice(&i32::to_le_bytes(bottom));
        assert!(decode(&bytes).is_err(), "{right} {bottom}");
    }
}
