use super::*;

/// A PNG by the crate png: an implementation that shares no code with ours but the encoder itself.
fn made(color: ::png::ColorType, depth: ::png::BitDepth, size: (u32, u32), data: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = ::png::Encoder::new(&mut bytes, size.0, size.1);
    encoder.set_color(color);
    encoder.set_depth(depth);
    if color == ::png::ColorType::Indexed {
        encoder.set_palette(vec![255, 0, 0, 0, 51, 102]);
    }
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(data).unwrap();
    writer.finish().unwrap();
    bytes
}

#[test]
fn code_values_come_back_in_8_and_16_bit_for_all_channels() {
    for channels in 1..=4usize {
        for (depth, max) in [(Depth::Eight, 255.0f32), (Depth::Sixteen, 65_535.0)] {
            let codes: Vec<f32> = (0..12 * channels).map(|i| ((i * 37) % 200) as f32 / max).collect();
            let image = Image::new(4, 3, channels, Transfer::Srgb, codes).unwrap();
            assert_eq!(decode(&encode(&image, depth, &[]).unwrap()).unwrap(), image, "{channels}");
        }
    }
}

#[test]
fn palettes_and_bits_below_8_are_expanded() {
    let image = decode(&made(::png::ColorType::Indexed, ::png::BitDepth::One, (2, 1), &[0b0100_0000])).unwrap();
    assert_eq!((image.rgb(0, 0), image.rgb(1, 0)), ([1.0, 0.0, 0.0], [0.0, 0.2, 0.4]));
    let image = decode(&made(::png::ColorType::Grayscale, ::png::BitDepth::Two, (4, 1), &[0b0001_1011])).unwrap();
    assert_eq!(image.data(), [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0]);
}

#[test]
fn linear_images_are_clipped_and_encoded_but_not_their_alpha() {
    let data = vec![0.5, -1.0, 7.0, 0.5, f32::NAN, f32::INFINITY, 0.0, 2.0];
    let image = Image::new(2, 1, 4, Transfer::Linear, data).unwrap();
    let back = decode(&encode(&image, Depth::Eight, &[]).unwrap()).unwrap();
    // IEC 61966-2-1: 0.5 is code 188 (187.52)
    assert_eq!(back.data().iter().map(|v| (v * 255.0) as u8).collect::<Vec<_>>(), [188, 0, 255, 128, 0, 255, 0, 255]);
}

#[test]
fn texts_are_kept_and_bytes_repeat() {
    let image = Image::from_fn(5, 5, Transfer::Srgb, |x, y| [x as f32 / 5.0, y as f32 / 5.0, 0.0]).unwrap();
    let bytes = || encode(&image, Depth::Eight, &[("ev100", "7.5"), ("tonemap", "agx")]).unwrap();
    assert_eq!(bytes(), bytes());
    let reader = ::png::Decoder::new(Cursor::new(bytes())).read_info().unwrap();
    let texts: Vec<_> = reader.info().utf8_text.iter().map(|t| (t.keyword.clone(), t.get_text().unwrap())).collect();
    assert_eq!(texts, [("ev100".to_string(), "7.5".to_string()), ("tonemap".into(), "agx".into())]);
}

#[test]
fn a_small_file_that_declares_a_huge_picture_is_refused() {
    let mut bytes = made(::png::ColorType::Grayscale, ::png::BitDepth::Eight, (1, 1), &[0]);
    for (width, height) in [(60_000u32, 2000u32), (65_537, 1), (u32::MAX, u32::MAX), (0, 1)] {
        bytes[16..20].copy_from_slice(&width.to_be_bytes());
        bytes[20..24].copy_from_slice(&height.to_be_bytes());
        let checksum = crc(&bytes[12..29]);
        bytes[29..33].copy_from_slice(&checksum.to_be_bytes());
        assert!(decode(&bytes).is_err(), "{width} x {height}");
    }
}

/// CRC-32 of PNG chunks, bit by bit (PNG specification, annex D).
fn crc(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0u32, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |c, _| if c & 1 == 1 { 0xedb8_8320 ^ (c >> 1) } else { c >> 1 })
    })
}
