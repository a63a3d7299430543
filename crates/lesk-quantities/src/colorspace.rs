//! CIE XYZ and linear Rec.709 RGB (the primaries of sRGB, white D65 at x = 0.3127, y = 0.3290).

/// XYZ of linear Rec.709, from the primaries of ITU-R BT.709-6; the numbers of CSS Color 4.
pub const XYZ_FROM_REC709: [[f64; 3]; 3] = [
    [0.412_390_799_265_959_48, 0.357_584_339_383_878, 0.180_480_788_401_834_3],
    [0.212_639_005_871_510_27, 0.715_168_678_767_756, 0.072_192_315_360_733_71],
    [0.019_330_818_715_591_851, 0.119_194_779_794_625_99, 0.950_532_152_249_660_58],
];

/// Linear Rec.709 of XYZ, the inverse of [`XYZ_FROM_REC709`].
pub const REC709_FROM_XYZ: [[f64; 3]; 3] = [
    [3.240_969_941_904_521_3, -1.537_383_177_570_093_5, -0.498_610_760_293_003_28],
    [-0.969_243_636_280_879_83, 1.875_967_501_507_720_7, 0.041_555_057_407_175_613],
    [0.055_630_079_696_993_61, -0.203_976_958_888_976_57, 1.056_971_514_242_878_6],
];

/// Linear Rec.709 of XYZ; negative outside the gamut.
pub fn rec709_from_xyz(xyz: [f64; 3]) -> [f64; 3] {
    REC709_FROM_XYZ.map(|row| dot(row, xyz))
}

/// XYZ of linear Rec.709.
pub fn xyz_from_rec709(rgb: [f64; 3]) -> [f64; 3] {
    XYZ_FROM_REC709.map(|row| dot(row, rgb))
}

/// Luminance Y of linear Rec.709, in the unit of the channels.
pub fn luminance(rgb: [f64; 3]) -> f64 {
    dot(XYZ_FROM_REC709[1], rgb)
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_two_matrices_are_inverse() {
        for c in 0..3 {
            let mut unit = [0.0; 3];
            unit[c] = 1.0;
            let back = rec709_from_xyz(xyz_from_rec709(unit));
            for k in 0..3 {
                assert!((back[k] - unit[k]).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn columns_have_the_chromaticities_of_bt_709_and_white_is_d65() {
        let xy = |rgb| {
            let [x, y, z] = xyz_from_rec709(rgb);
            (x / (x + y + z), y / (x + y + z))
        };
        let cases = [
            ([1.0, 0.0, 0.0], (0.64, 0.33)),
            ([0.0, 1.0, 0.0], (0.30, 0.60)),
            ([0.0, 0.0, 1.0], (0.15, 0.06)),
            ([1.0; 3], (0.3127, 0.3290)),
        ];
        for (rgb, (x, y)) in cases {
            let got = xy(rgb);
            assert!((got.0 - x).abs() < 1e-14 && (got.1 - y).abs() < 1e-14, "{got:?}");
        }
        assert!((luminance([1.0; 3]) - 1.0).abs() < 1e-15);
    }
}
