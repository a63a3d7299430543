//! CIE XYZ, linear Rec.709 RGB (the primaries of sRGB, white D65 at x = 0.3127, y = 0.3290) and wider RGB spaces.

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

/// A linear RGB space: the chromaticities of its primaries and white.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RgbSpace {
    name: &'static str,
    primaries: [[f64; 2]; 3],
    white: [f64; 2],
}

const D65: [f64; 2] = [0.3127, 0.3290];

impl RgbSpace {
    /// IEC 61966-2-1, the primaries of ITU-R BT.709-6.
    pub const SRGB: RgbSpace =
        RgbSpace { name: "srgb", primaries: [[0.64, 0.33], [0.30, 0.60], [0.15, 0.06]], white: D65 };
    /// Display P3: the primaries of SMPTE RP 431-2 with the white D65 (SMPTE EG 432-1).
    pub const DISPLAY_P3: RgbSpace =
        RgbSpace { name: "display-p3", primaries: [[0.680, 0.320], [0.265, 0.690], [0.150, 0.060]], white: D65 };
    /// ITU-R BT.2020-2.
    pub const REC2020: RgbSpace =
        RgbSpace { name: "rec2020", primaries: [[0.708, 0.292], [0.170, 0.797], [0.131, 0.046]], white: D65 };
    /// ACEScg: the primaries AP1, white of about 6000 K (Academy S-2014-004).
    pub const ACESCG: RgbSpace = RgbSpace {
        name: "acescg",
        primaries: [[0.713, 0.293], [0.165, 0.830], [0.128, 0.044]],
        white: [0.32168, 0.33767],
    };
    /// All of them.
    pub const ALL: [RgbSpace; 4] = [Self::SRGB, Self::DISPLAY_P3, Self::REC2020, Self::ACESCG];

    /// `srgb`, `display-p3`, `rec2020`, `acescg`.
    pub fn name(self) -> &'static str {
        self.name
    }

    /// Columns are XYZ of the primaries, scaled so that they add to the white with Y = 1.
    fn matrix(self) -> [[f64; 3]; 3] {
        let columns = self.primaries.map(xyz_of_xy);
        let rows = transpose(columns);
        let scale = times(inverse(rows), xyz_of_xy(self.white));
        rows.map(|row| [row[0] * scale[0], row[1] * scale[1], row[2] * scale[2]])
    }

    /// XYZ of linear RGB, without adaptation.
    pub fn xyz(self, rgb: [f64; 3]) -> [f64; 3] {
        times(self.matrix(), rgb)
    }

    /// Linear RGB of XYZ, without adaptation; negative outside the gamut.
    pub fn rgb(self, xyz: [f64; 3]) -> [f64; 3] {
        times(inverse(self.matrix()), xyz)
    }

    /// Linear RGB of another space; where the whites differ, adapted by the Bradford transform, so that white stays white.
    pub fn convert(self, to: RgbSpace, rgb: [f64; 3]) -> [f64; 3] {
        let xyz = self.xyz(rgb);
        if self.white == to.white {
            return to.rgb(xyz);
        }
        let (from, into) = (times(BRADFORD, xyz_of_xy(self.white)), times(BRADFORD, xyz_of_xy(to.white)));
        let cone = times(BRADFORD, xyz);
        to.rgb(times(inverse(BRADFORD), [0, 1, 2].map(|c| cone[c] * into[c] / from[c])))
    }
}

/// Lam's Bradford transform (ICC.1:2022, annex E).
const BRADFORD: [[f64; 3]; 3] = [[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]];

fn xyz_of_xy([x, y]: [f64; 2]) -> [f64; 3] {
    [x / y, 1.0, (1.0 - x - y) / y]
}

fn times(m: [[f64; 3]; 3], v: [f64; 3]) -> [f64; 3] {
    m.map(|row| dot(row, v))
}

fn transpose(m: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    std::array::from_fn(|i| std::array::from_fn(|k| m[k][i]))
}

/// By cofactors.
fn inverse(m: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let minor = |i: usize, k: usize| {
        let (a, b, c, d) = ((i + 1) % 3, (i + 2) % 3, (k + 1) % 3, (k + 2) % 3);
        m[a][c] * m[b][d] - m[a][d] * m[b][c]
    };
    let det: f64 = (0..3).map(|k| m[0][k] * minor(0, k)).sum();
    std::array::from_fn(|k| std::array::from_fn(|i| minor(i, k) / det))
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_space_srgb_is_rec_709() {
        for (mine, theirs) in RgbSpace::SRGB.matrix().into_iter().zip(XYZ_FROM_REC709) {
            for c in 0..3 {
                assert!((mine[c] - theirs[c]).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn white_stays_white_and_colors_come_back_between_all_spaces() {
        for from in RgbSpace::ALL {
            for to in RgbSpace::ALL {
                let white = from.convert(to, [1.0; 3]);
                let back = to.convert(from, from.convert(to, [0.2, 0.7, 0.4]));
                for c in 0..3 {
                    assert!((white[c] - 1.0).abs() < 1e-14, "{from:?} {to:?}");
                    assert!((back[c] - [0.2, 0.7, 0.4][c]).abs() < 1e-14, "{from:?} {to:?}");
                }
            }
        }
    }

    #[test]
    fn display_p3_green_is_outside_srgb_as_css_says() {
        // CSS Color 4, example of its conversion code: color(display-p3 0 1 0) has linear sRGB -0.2249, 1.0421, -0.0786
        let rgb = RgbSpace::DISPLAY_P3.convert(RgbSpace::SRGB, [0.0, 1.0, 0.0]);
        for (got, expected) in rgb.into_iter().zip([-0.2249, 1.0421, -0.0786]) {
            assert!((got - expected).abs() < 5e-5, "{rgb:?}");
        }
    }

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
