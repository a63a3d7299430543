//! EV100: the exposure value at ISO 100, a logarithm to base 2.
//!
//! EV100 = log2(N²/t · 100/S). A meter that looks at a scene (K = 12.5) sets it to the mean luminance
//! L = 12.5/100 · 2^EV = 0.125 · 2^EV; one that holds a dome into the light (C = 250) to E = 2.5 · 2^EV.

/// Reflected-light meter constant K, cd s/m² (ISO 2720; Canon, Nikon and Sekonic use 12.5).
pub const K: f64 = 12.5;
/// Incident-light meter constant C for a dome, lx s (ISO 2720).
pub const C: f64 = 250.0;

/// EV100 of a camera: f-number N, exposure time t in s, sensitivity S (ISO).
pub fn ev100(f_number: f64, time_s: f64, iso: f64) -> f64 {
    (f_number * f_number / time_s * 100.0 / iso).log2()
}

/// The mean luminance in cd/m² that a reflected-light meter turns into this EV100.
pub fn mean_luminance(ev100: f64) -> f64 {
    K / 100.0 * ev100.exp2()
}

/// EV100 that a reflected-light meter reads for a mean luminance in cd/m².
pub fn ev100_of_luminance(luminance: f64) -> f64 {
    (luminance * 100.0 / K).log2()
}

/// The illuminance in lx that an incident-light meter turns into this EV100.
pub fn illuminance(ev100: f64) -> f64 {
    C / 100.0 * ev100.exp2()
}

/// The luminance in cd/m² that just saturates the sensor: 78/(100 · 0.65) · 2^EV = 1.2 · 2^EV.
///
/// ISO 12232: saturation-based speed with 78, lens transmission and vignetting q = 0.65.
pub fn saturation_luminance(ev100: f64) -> f64 {
    1.2 * ev100.exp2()
}

/// The factor from cd/m² to a picture in which 1 is white: 1 / [`saturation_luminance`].
pub fn scale(ev100: f64) -> f64 {
    1.0 / saturation_luminance(ev100)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ev_0_6_10_15_stand_for_the_luminances_of_iso_2720() {
        for (ev, l) in [(0.0, 0.125), (6.0, 8.0), (10.0, 128.0), (15.0, 4096.0)] {
            assert_eq!(mean_luminance(ev), l);
            assert_eq!(ev100_of_luminance(l), ev);
        }
        assert_eq!(illuminance(0.0), 2.5);
        assert_eq!(saturation_luminance(3.0), 9.6);
        assert_eq!(scale(0.0) * 1.2, 1.0);
    }

    #[test]
    fn sunny_sixteen_is_ev_14_6() {
        // f/16, 1/100 s, ISO 100: log2(25600) = 14.64
        assert!((ev100(16.0, 0.01, 100.0) - 25_600f64.log2()).abs() < 1e-12);
        // twice the sensitivity is one stop less
        assert!((ev100(16.0, 0.01, 200.0) - (25_600f64.log2() - 1.0)).abs() < 1e-12);
    }
}
