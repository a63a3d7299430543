use super::*;
use proptest::prelude::*;

/// 4 x 2 texels: red counts from the lower left, row by row upwards.
fn counted(wrap: Wrap, interpolation: Interpolation) -> Texture {
    let image = Image::from_fn(4, 2, Transfer::Linear, |x, y| [(x + 4 * (1 - y)) as f32, 10.0, 20.0, 0.5]).unwrap();
    Texture::new(image, Role::Color, [wrap; 2], interpolation)
}

#[test]
fn texel_centres_give_the_texels_and_v_runs_upwards() {
    for interpolation in [Interpolation::Bilinear, Interpolation::Nearest] {
        let texture = counted(Wrap::Repeat, interpolation);
        for i in 0..8u8 {
            let uv = [(f32::from(i % 4) + 0.5) / 4.0, (f32::from(i / 4) + 0.5) / 2.0];
            assert_eq!(texture.rgb(uv), [f32::from(i), 10.0, 20.0]);
        }
    }
}

#[test]
fn halfway_between_texels_is_their_mean() {
    let texture = counted(Wrap::Repeat, Interpolation::Bilinear);
    assert_eq!(texture.scalar([0.25, 0.25], Channel::Red), 0.5);
    assert_eq!(texture.scalar([0.125, 0.5], Channel::Red), 2.0);
    // across the border: texel 0 and texel 3
    assert_eq!(texture.scalar([0.0, 0.25], Channel::Red), 1.5);
}

#[test]
fn wrap_modes_say_what_lies_outside() {
    let red = |wrap, u| counted(wrap, Interpolation::Nearest).scalar([u, 0.25], Channel::Red);
    for (u, repeat, mirror, clamp) in
        [(1.1, 0.0, 3.0, 3.0), (-0.1, 3.0, 0.0, 0.0), (2.3, 1.0, 1.0, 3.0), (-1.3, 2.0, 2.0, 0.0)]
    {
        assert_eq!(red(Wrap::Repeat, u), repeat, "{u}");
        assert_eq!(red(Wrap::Mirror, u), mirror, "{u}");
        assert_eq!(red(Wrap::Clamp, u), clamp, "{u}");
    }
}

#[test]
fn colours_are_decoded_and_data_and_alpha_are_not() {
    let image = || Image::new(1, 1, 4, Transfer::Srgb, vec![0.5, 0.5, 0.5, 0.5]).unwrap();
    let texture = |role| Texture::new(image(), role, [Wrap::Clamp; 2], Interpolation::Bilinear);
    // IEC 61966-2-1: code 0.5 is 0.214041 of linear light
    assert!((texture(Role::Color).scalar([0.5; 2], Channel::Green) - 0.214_041).abs() < 1e-6);
    assert_eq!(texture(Role::Color).scalar([0.5; 2], Channel::Alpha), 0.5);
    assert_eq!(texture(Role::Data).scalar([0.5; 2], Channel::Green), 0.5);
}

#[test]
fn channels_are_selected_and_missing_ones_have_a_meaning() {
    let texture = counted(Wrap::Clamp, Interpolation::Nearest);
    let at = [0.0, 0.0];
    assert_eq!(
        [Channel::Red, Channel::Green, Channel::Blue, Channel::Alpha].map(|c| texture.scalar(at, c)),
        [0.0, 10.0, 20.0, 0.5]
    );
    assert!((texture.scalar(at, Channel::Luminance) - (7.15169 + 1.44384)).abs() < 1e-4);
    let grey = Texture::new(
        Image::new(1, 1, 1, Transfer::Linear, vec![0.3]).unwrap(),
        Role::Data,
        [Wrap::Clamp; 2],
        Interpolation::Nearest,
    );
    assert_eq!([Channel::Blue, Channel::Alpha].map(|c| grey.scalar(at, c)), [0.3, 1.0]);
    assert_eq!("a".parse::<Channel>().unwrap(), Channel::Alpha);
    assert!("w".parse::<Channel>().is_err());
}

#[test]
fn texels_that_are_not_finite_are_repaired_and_counted() {
    let image = Image::new(2, 1, 1, Transfer::Linear, vec![f32::NAN, f32::INFINITY]).unwrap();
    let texture = Texture::new(image, Role::Data, [Wrap::Repeat; 2], Interpolation::Bilinear);
    assert_eq!((texture.repaired(), texture.scalar([0.3, 0.5], Channel::Red)), (2, 0.0));
}

#[test]
fn clamping_counts_what_was_outside() {
    let image = Image::new(2, 2, 2, Transfer::Linear, vec![-1.0, 9.0, 0.5, 9.0, 2.0, 9.0, 1.0, 9.0]).unwrap();
    let mut texture = Texture::new(image, Role::Data, [Wrap::Repeat; 2], Interpolation::Nearest);
    assert_eq!((texture.clamp(0.0, 1.0), texture.clamp(0.0, 1.0)), (2, 0));
    assert_eq!(texture.scalar([0.1, 0.1], Channel::Alpha), 9.0);
}

#[test]
fn mean_is_the_mean_of_all_texels() {
    assert_eq!(counted(Wrap::Repeat, Interpolation::Nearest).mean_rgb(), [3.5, 10.0, 20.0]);
}

proptest! {
    #[test]
    fn any_place_gives_a_finite_number_within_the_texels(
        u in prop::num::f32::ANY,
        v in prop::num::f32::ANY,
        wrap in prop_oneof![Just(Wrap::Repeat), Just(Wrap::Mirror), Just(Wrap::Clamp)],
        nearest: bool,
    ) {
        let texture = counted(wrap, if nearest { Interpolation::Nearest } else { Interpolation::Bilinear });
        prop_assert!((0.0..=7.0).contains(&texture.scalar([u, v], Channel::Red)));
    }
}
