use super::*;
use proptest::prelude::*;

fn file(header: &str, size: &str, body: &[u8]) -> Vec<u8> {
    let mut bytes = format!("#?RADIANCE\n{header}FORMAT=32-bit_rle_rgbe\n\n{size}\n").into_bytes();
    bytes.extend(body);
    bytes
}

/// 3 x 2 pixels of light 1, 2, 3 and 4, 5, 6 in the order of the file.
const SIX: [[u8; 4]; 6] =
    [[128, 0, 0, 129], [128, 0, 0, 130], [192, 0, 0, 130], [128, 0, 0, 131], [160, 0, 0, 131], [192, 0, 0, 131]];

fn reds(image: &Image) -> Vec<f32> {
    image.rgb_pixels().map(|p| p[0]).collect()
}

#[test]
fn all_eight_orientations_come_out_upright() {
    let cases: [(&str, [f32; 6]); 8] = [
        ("-Y 2 +X 3", [1., 2., 3., 4., 5., 6.]),
        ("-Y 2 -X 3", [3., 2., 1., 6., 5., 4.]),
        ("+Y 2 +X 3", [4., 5., 6., 1., 2., 3.]),
        ("+Y 2 -X 3", [6., 5., 4., 3., 2., 1.]),
        ("+X 3 -Y 2", [1., 3., 5., 2., 4., 6.]),
        ("-X 3 -Y 2", [5., 3., 1., 6., 4., 2.]),
        ("+X 3 +Y 2", [2., 4., 6., 1., 3., 5.]),
        ("-X 3 +Y 2", [6., 4., 2., 5., 3., 1.]),
    ];
    for (size, expected) in cases {
        let image = decode(&file("", size, SIX.as_flattened())).unwrap();
        assert_eq!((image.width(), image.height()), (3, 2), "{size}");
        assert_eq!(reds(&image), expected, "{size}");
    }
}

#[test]
fn exposure_and_colorcorr_are_divided_out_and_multiply() {
    let header = "EXPOSURE=2\nVIEW= -vf x\nEXPOSURE= 4.0\nCOLORCORR=0.5 1 1\n";
    let image = decode(&file(header, "-Y 2 +X 3", SIX.as_flattened())).unwrap();
    assert_eq!(reds(&image)[3], 4.0 / (2.0 * 4.0 * 0.5)); // Radiance file formats: original = pixel / (EXPOSURE COLORCORR)
    for bad in ["EXPOSURE=0\n", "EXPOSURE=nan\n", "EXPOSURE=-1\n", "COLORCORR=1 1\n", "EXPOSURE=1e300\n", "EXPOSURE=\n"]
    {
        assert!(decode(&file(bad, "-Y 2 +X 3", SIX.as_flattened())).is_err(), "{bad}");
    }
}

#[test]
fn old_runs_repeat_the_last_pixel() {
    let body = [[128, 64, 0, 129], [1, 1, 1, 4], [0, 0, 0, 0], [1, 1, 1, 2], [1, 1, 1, 1]].concat();
    // 1 + 4 + 1 + 2 + 256 = 264 pixels
    let error = decode(&file("", "-Y 1 +X 263", &body)).unwrap_err().to_string();
    assert_eq!(error, "not a valid HDR file: scanline 0 of 1 has a run that is too long");
    let image = decode(&file("", "-Y 1 +X 264", &body)).unwrap();
    assert_eq!(image.rgb(4, 0), [1.0, 0.5, 0.0]);
    assert_eq!(image.rgb(5, 0), [0.0; 3]);
}

#[test]
fn xyze_becomes_rec_709() {
    // XYZ of Rec.709 red at Y = 0.2126
    let mut bytes = b"#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n".to_vec();
    bytes.extend(pack([0.412_39, 0.212_64, 0.019_33]));
    let [r, g, b] = decode(&bytes).unwrap().rgb(0, 0);
    // mantissas of 8 bits: 1/256 times the largest entry of the matrix
    assert!((r - 1.0).abs() < 0.015 && g.abs() < 0.01 && b.abs() < 0.005, "{r} {g} {b}");
}

#[test]
fn written_pictures_come_back_within_half_a_step_of_the_mantissa() {
    for width in [1, 7, 8, 200, 300] {
        let image = Image::from_fn(width, 3, Transfer::Linear, |x, y| {
            let t = (x + y * width) as f32;
            [t.sin().abs() * 1e4, 0.5, (0.3 * t).exp().min(1e20)]
        })
        .unwrap();
        let back = decode(&encode(&image).unwrap()).unwrap();
        for (a, b) in image.rgb_pixels().zip(back.rgb_pixels()) {
            let max = a[0].max(a[1]).max(a[2]);
            for c in 0..3 {
                assert!((a[c] - b[c]).abs() <= max / 255.0, "{width}: {a:?} {b:?}");
            }
        }
        // what was rounded once is not rounded again
        assert_eq!(decode(&encode(&back).unwrap()).unwrap(), back);
    }
}

#[test]
fn runs_are_as_short_as_they_should_be() {
    let grey = Image::from_fn(127, 1, Transfer::Linear, |_, _| [0.25; 3]).unwrap();
    let bytes = encode(&grey).unwrap();
    let body = bytes.len() - "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 127\n".len();
    assert_eq!(body, 4 + 4 * 2);
}

#[test]
fn numbers_that_rgbe_cannot_hold_are_clamped() {
    let values = [f32::NAN, -1.0, f32::INFINITY, f32::MAX, 1e-45, 0.999_999, 255.9];
    let image = Image::from_fn(7, 1, Transfer::Linear, |x, _| [values[x as usize]; 3]).unwrap();
    let back = reds(&decode(&encode(&image).unwrap()).unwrap());
    assert_eq!(back[..2], [0.0, 0.0]);
    assert!(back[2] > 1e38 && back[2].is_finite() && back[3] > 1e38);
    assert_eq!((back[4], back[5]), (0.0, 1.0));
    assert_eq!(back[6], 256.0);
}

#[test]
fn headers_that_are_not_radiance_are_refused() {
    let cases: [&[u8]; 9] = [
        b"",
        b"#?RADIANCE",
        b"#?RADIANCE\n\n",
        b"#?RADIANCE\n\n-Y 1 +X\n",
        b"#?RADIANCE\n\n-Y 1 +Y 1\n\0\0\0\0",
        b"#?RADIANCE\n\n-Y 0 +X 1\n\0\0\0\0",
        b"#?RADIANCE\n\n-Y 65537 +X 1\n\0\0\0\0",
        b"#?RADIANCE\n\n-Y 60000 +X 2000\n\0\0\0\0",
        b"#?RADIANCE\nFORMAT=else\n\n-Y 1 +X 1\n\0\0\0\0",
    ];
    for bytes in cases {
        assert!(decode(bytes).is_err(), "{}", String::from_utf8_lossy(bytes));
    }
}

proptest! {
    #[test]
    fn any_scanlines_are_read_or_refused(
        body in prop::collection::vec(prop_oneof![Just(1u8), Just(2), Just(130), 0u8..=255], 0..400),
        width in 1usize..40,
        height in 1usize..4,
    ) {
        let size = format!("-Y {height} +X {width}");
        if let Ok(image) = decode(&file("", &size, &body)) {
            prop_assert!(image.count_non_finite() == 0);
        }
        let mut runs = vec![2, 2, 0, width as u8];
        runs.extend(&body);
        let _ = decode(&file("", &size, &runs));
    }
}
