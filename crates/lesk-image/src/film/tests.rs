use super::*;

/// Uniform numbers in 0..1 from a counter; the constants are SplitMix64's.
fn noise(i: u64) -> f32 {
    let mut z = i.wrapping_mul(0x9E37_79B9_7F4A_7C15);
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    ((z ^ (z >> 31)) >> 40) as f32 / (1u64 << 24) as f32
}

fn full_spec() -> FilmSpec {
    FilmSpec { width: 37, height: 21, splits: vec!["direct".into(), "indirect".into()], aovs: true }
}

/// One pass of samples over all tiles, as a renderer makes it.
fn pass(film: &mut Film, side: u32, index: u64) {
    let mut tiles = film.tiles(side);
    if index % 2 == 1 {
        tiles.reverse(); // threads finish in any order
    }
    for tile in tiles {
        let mut pixels = film.take(tile);
        for (x, y) in tile.pixels() {
            let seed = (index * 10_000 + u64::from(y)) * 10_000 + u64::from(x);
            let l = [noise(seed) * 100.0, noise(seed + 1), 3.0];
            let splits = [[l[0] * 0.5; 3], [l[1]; 3]];
            let aov = Aov { albedo: [noise(seed); 3], normal: [0.0, 0.6, 0.8], depth: 2.5, object: 7, material: 3 };
            pixels.add(x, y, &Sample { radiance: l, splits: &splits, aov: (x > 3).then_some(aov) });
        }
        film.put(pixels);
    }
}

#[test]
fn tiles_cover_every_pixel_once() {
    for side in [1, 7, 16, 64] {
        let film = Film::new(full_spec()).unwrap();
        let mut seen = vec![0; 37 * 21];
        for tile in film.tiles(side) {
            for (x, y) in tile.pixels() {
                seen[(y * 37 + x) as usize] += 1;
            }
        }
        assert!(seen.iter().all(|n| *n == 1), "{side}");
    }
}

#[test]
fn the_same_samples_give_the_same_bits_for_any_tile_size_and_order() {
    let render = |side| {
        let mut film = Film::new(full_spec()).unwrap();
        (0..5).for_each(|i| pass(&mut film, side, i));
        film
    };
    assert_eq!(render(8), render(64));
    assert_eq!(render(1), render(16));
}

#[test]
fn a_saved_and_restored_film_goes_on_as_if_nothing_had_happened() {
    let mut whole = Film::new(full_spec()).unwrap();
    (0..6).for_each(|i| pass(&mut whole, 16, i));

    let mut half = Film::new(full_spec()).unwrap();
    (0..3).for_each(|i| pass(&mut half, 16, i));
    let mut bytes = Vec::new();
    half.save(&mut bytes).unwrap();
    assert_eq!(bytes.len() as u64, half.saved_size());
    let mut resumed = Film::new(full_spec()).unwrap();
    resumed.restore(&mut bytes.as_slice()).unwrap();
    assert_eq!(resumed, half);
    (3..6).for_each(|i| pass(&mut resumed, 16, i));
    assert_eq!(resumed, whole);
}

#[test]
fn a_film_of_another_shape_or_cut_short_is_refused() {
    let mut bytes = Vec::new();
    Film::new(full_spec()).unwrap().save(&mut bytes).unwrap();
    let mut smaller = Film::new(FilmSpec { width: 36, ..full_spec() }).unwrap();
    let text = smaller.restore(&mut bytes.as_slice()).unwrap_err().to_string();
    assert_eq!(text, "not a valid film file: it is 37 x 21, but 36 x 21 is needed");
    let mut other = Film::new(FilmSpec { aovs: false, ..full_spec() }).unwrap();
    assert!(other.restore(&mut bytes.as_slice()).is_err());
    let mut film = Film::new(full_spec()).unwrap();
    for end in [0, 7, 20, 40, bytes.len() - 1] {
        assert!(film.restore(&mut &bytes[..end]).is_err(), "{end}");
    }
    let at = bytes.len() - 8;
    bytes[at..].copy_from_slice(&f64::NAN.to_le_bytes());
    assert!(film.restore(&mut bytes.as_slice()).is_err());
    assert_eq!(film, Film::new(full_spec()).unwrap());
}

#[test]
fn mean_and_variance_are_those_of_the_samples() {
    let mut film = Film::new(FilmSpec::new(1, 1)).unwrap();
    // 2, 4, 4, 4, 5, 5, 7, 9: mean 5, sum of squared deviations 32
    for v in [2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0] {
        film.add(0, 0, &Sample::of([v, 2.0 * v, 1.0]));
    }
    assert_eq!(film.mean(0, 0), [5.0, 10.0, 1.0]);
    let [r, g, b] = film.variance(0, 0);
    assert!((r - 32.0 / 7.0 / 8.0).abs() < 1e-15 && (g - 4.0 * 32.0 / 7.0 / 8.0).abs() < 1e-14);
    assert_eq!(b, 0.0);
    assert_eq!(film.sample_count(0, 0), 8);
}

#[test]
fn a_pixel_without_samples_is_black_and_one_sample_has_no_variance() {
    let mut film = Film::new(FilmSpec::new(2, 1)).unwrap();
    film.add(1, 0, &Sample::of([3.0; 3]));
    assert_eq!((film.mean(0, 0), film.variance(0, 0)), ([0.0; 3], [0.0; 3]));
    assert_eq!((film.mean(1, 0), film.variance(1, 0)), ([3.0; 3], [0.0; 3]));
    assert_eq!(film.relative_error(), None);
}

#[test]
fn light_that_is_not_finite_counts_as_black_and_is_counted() {
    let mut film = Film::new(FilmSpec::new(1, 1)).unwrap();
    film.add(0, 0, &Sample::of([8.0; 3]));
    film.add(0, 0, &Sample::of([f32::NAN, 1.0, 1.0]));
    film.add(0, 0, &Sample::of([1.0, f32::INFINITY, 1.0]));
    film.add(0, 0, &Sample::of([f32::MAX; 3]));
    assert_eq!((film.rejected(), film.sample_count(0, 0)), (2, 4));
    assert!(film.mean(0, 0).iter().chain(&film.variance(0, 0)).all(|v| v.is_finite()));
}

#[test]
fn relative_error_shrinks_as_one_over_root_n() {
    let error = |n: u64| {
        let mut film = Film::new(FilmSpec::new(40, 40)).unwrap();
        for i in 0..n * 1600 {
            film.add((i % 40) as u32, (i / 40 % 40) as u32, &Sample::of([noise(i); 3]));
        }
        film.relative_error().unwrap()
    };
    // uniform noise: standard deviation 1/sqrt(12) over mean 1/2; 1600 pixels estimate it to 1 %
    for n in [16, 64] {
        let expected = (1.0 / 12.0f64 / n as f64).sqrt() / 0.5;
        assert!((error(n) / expected - 1.0).abs() < 0.02, "{n}");
    }
}

#[test]
fn aov_layers_hold_the_means_of_hits_and_the_ids_of_the_first_sample() {
    let mut film = Film::new(full_spec()).unwrap();
    (0..2).for_each(|i| pass(&mut film, 16, i));
    let planes = film.planes(&[("spp", "2")]).unwrap();
    let value = |name: &str, x: usize| planes.plane(name).unwrap().samples.get(5 * 37 + x);
    assert_eq!((value("depth.Z", 0), value("depth.Z", 10)), (0.0, 2.5));
    assert_eq!((value("id.object", 0), value("id.object", 10), value("id.material", 10)), (0.0, 7.0, 3.0));
    assert_eq!((value("normal.Y", 10), value("normal.Z", 10)), (0.6, 0.8));
    assert_eq!(value("samples.Y", 0), 2.0);
    assert_eq!(value("direct.G", 10), (film.mean(10, 5)[0] * 0.5) as f32);
    assert_eq!(planes.attribute("unit"), Some("cd/m2"));
    assert_eq!(planes.attribute("spp"), Some("2"));
}

#[test]
fn names_of_split_layers_are_checked() {
    for name in ["", "variance", "a.b", "ä", "direct", "much_too_long_for_a_layer_name"] {
        let splits = vec!["direct".to_string(), name.to_string()];
        assert!(Film::new(FilmSpec { splits, ..FilmSpec::new(1, 1) }).is_err(), "{name}");
    }
    assert!(Film::new(FilmSpec::new(65_536, 65_536)).is_err());
    assert!(Film::new(FilmSpec::new(0, 1)).is_err());
}
