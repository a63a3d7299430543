use super::*;

fn grey(values: &[f32]) -> Image {
    Image::from_fn(values.len() as u32, 1, Transfer::Linear, |x, _| [values[x as usize]; 3]).unwrap()
}

#[test]
fn srgb_curve_has_the_values_of_the_standard() {
    // IEC 61966-2-1; 0.5 encodes to 187.516 / 255, 0.18 to 117.6 / 255
    for (linear, encoded) in [(0.0, 0.0), (1.0, 1.0), (0.0031308, 0.040_449_936), (0.5, 0.735_357), (0.18, 0.461_356)] {
        assert!((srgb_encode(linear) - encoded).abs() < 1e-6, "{linear}");
        assert!((srgb_decode(encoded) - linear).abs() < 2e-6, "{encoded}");
    }
    assert_eq!(srgb_encode(-0.5), -srgb_encode(0.5));
}

#[test]
fn every_code_value_of_8_and_16_bit_survives_decoding_and_encoding() {
    for max in [255u32, 65_535] {
        for code in 0..=max {
            let v = srgb_encode(srgb_decode(code as f32 / max as f32));
            assert_eq!((v * max as f32 + 0.5) as u32, code);
        }
    }
}

#[test]
fn srgb_below_white_is_the_light_itself_and_clips_above() {
    assert_eq!(ToneMapper::Srgb.map([0.2, 0.9, 7.0]), [0.2, 0.9, 1.0]);
}

#[test]
fn reinhard_and_hable_have_the_values_of_their_formulas() {
    assert_eq!(ToneMapper::Reinhard.map([1.0, 3.0, 0.0]), [0.5, 0.75, 0.0]);
    // white of Hable is 11.2 at an exposure bias of 2
    assert!((ToneMapper::Hable.map([5.6; 3])[0] - 1.0).abs() < 1e-6);
    // (1 (0.15 + 0.05) + 0.004) / (1 (0.15 + 0.5) + 0.06) - 1/15 over (11.2 ...) = 0.220657 / 0.725137
    assert!((ToneMapper::Hable.map([0.5; 3])[0] - 0.220_657_3 / 0.725_137).abs() < 1e-5);
}

#[test]
fn neutral_keeps_colours_below_its_shoulder_less_4_percent() {
    // the specification: reflectance c at F0 = 0.04 is rendered as c + 0.04 and comes back as c
    let [r, g, b] = ToneMapper::Neutral.map([0.5, 0.3, 0.2]);
    assert!((r - 0.46).abs() < 1e-6 && (g - 0.26).abs() < 1e-6 && (b - 0.16).abs() < 1e-6);
    assert!(ToneMapper::Neutral.map([1e6; 3])[0] > 0.999);
}

#[test]
fn aces_of_middle_grey_is_that_of_the_published_fit() {
    // all three channels of a grey g: rows of the input matrix sum to 1, so fit(g) is (g (g + 0.0245786) - 9.0537e-5) /
    // (g (0.983729 g + 0.432951) + 0.238081) = 0.105591 for 0.18; rows of the output matrix sum to 1
    for v in ToneMapper::Aces.map([0.18; 3]) {
        assert!((v - 0.105_591).abs() < 2e-5, "{v}"); // matrices printed with five digits
    }
}

#[test]
fn agx_of_middle_grey_is_that_of_the_published_polynomial() {
    // 0.18 lies at 10 / 16.5 of the log range; the polynomial gives 0.49678 there, at gamma 2.2 that is 0.21455
    for v in ToneMapper::Agx.map([0.18; 3]) {
        assert!((v - 0.214_55).abs() < 2e-4, "{v}"); // rows of the Rec.2020 matrices, four digits, sum to 1 within 1e-4
    }
}

#[test]
fn every_tone_mapper_is_increasing_and_stays_within_0_and_1() {
    for mapper in ToneMapper::ALL {
        let mut last = -1.0;
        for i in 0..400 {
            let v = mapper.map([(0.05 * i as f32 - 12.0).exp2(); 3])[1];
            // the AgX polynomial is not monotonic to the last bit at its ends
            assert!((0.0..=1.0).contains(&v) && v >= last - 1e-3, "{mapper}: {v} after {last}");
            last = v;
        }
        assert!(last > 0.9, "{mapper}");
    }
}

#[test]
fn every_tone_mapper_survives_every_kind_of_number() {
    let numbers = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN_POSITIVE, -1.0, 0.0, 1.0];
    for mapper in ToneMapper::ALL {
        for (r, g) in numbers.iter().flat_map(|r| numbers.iter().map(move |g| (*r, *g))) {
            assert!(mapper.map([r, g, 0.3]).iter().all(|v| (0.0..=1.0).contains(v)), "{mapper} {r} {g}");
        }
    }
}

#[test]
fn names_are_read_back_and_a_wrong_one_is_refused_with_the_list() {
    for mapper in ToneMapper::ALL {
        assert_eq!(mapper.name().parse::<ToneMapper>().unwrap(), mapper);
    }
    let text = "filmic".parse::<ToneMapper>().unwrap_err().to_string();
    assert_eq!(text, "tone mapper `filmic`, but one of srgb, reinhard, hable, aces, agx, neutral is accepted");
}

#[test]
fn metering_a_uniform_field_is_log2_of_l_times_100_over_k() {
    assert!((meter(&grey(&[4096.0; 5])).unwrap() - 15.0).abs() < 1e-6); // ISO 2720 with K = 12.5; f32 pixel
    // log average of 1, 4 and 16 is 4; black, NaN and infinite pixels do not count
    let mixed = grey(&[1.0, 4.0, 16.0, 0.0, f32::NAN, f32::INFINITY, -3.0]);
    assert!((log_average_luminance(&mixed).unwrap() - 4.0).abs() < 1e-6);
    assert_eq!(meter(&grey(&[0.0; 4])), None);
}

#[test]
fn the_saturation_luminance_develops_to_white() {
    let picture = develop(&grey(&[1.2 * 1024.0, 0.6 * 1024.0, 1e9]), 10.0, ToneMapper::Srgb);
    assert_eq!(picture.transfer(), Transfer::Srgb);
    assert!((picture.rgb(0, 0)[0] - 1.0).abs() < 1e-6 && picture.rgb(2, 0)[0] > 1.0 - 1e-6);
    assert!((picture.rgb(1, 0)[0] - 0.735_357).abs() < 1e-5);
}

#[test]
fn alpha_is_not_developed() {
    for channels in [2, 4] {
        let image = Image::new(1, 1, channels, Transfer::Linear, vec![0.3; channels]).unwrap();
        let picture = develop(&image, 0.0, ToneMapper::Srgb);
        assert_eq!((picture.channels(), picture.pixel(0, 0)[channels - 1]), (channels, 0.3));
    }
}

#[test]
fn luminance_is_that_of_the_number_crate() {
    // lesk-math keeps six digits of the same weights
    let rgb = [0.3, 0.7, 0.2];
    let ours = lesk_quantities::colorspace::luminance(rgb);
    assert!((lesk_math::Channels(rgb).luminance() - ours).abs() < 1e-6);
}
