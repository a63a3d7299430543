//! The sky and sun of Hosek and Wilkie against the code of its authors (version 1.4a), which was compiled and run for these
//! numbers, and against integrals of the formula.

use lesk_light::{Environment, HosekSky, Up};
use lesk_math::Color;
use std::f64::consts::{FRAC_PI_2, PI};

fn sky(turbidity: f64, albedo: f64, elevation_deg: f64) -> HosekSky {
    HosekSky::new(turbidity, [albedo; 3], elevation_deg.to_radians(), 0.0).unwrap()
}

fn luminance(rgb: [f64; 3]) -> f64 {
    lesk_quantities::colorspace::luminance(rgb)
}

fn near(got: f64, expected: f64, tolerance: f64, what: &str) {
    assert!((got / expected - 1.0).abs() < tolerance, "{what}: {got} is not {expected}");
}

#[test]
fn spectral_radiances_are_those_of_the_authors_code() {
    // arhosekskymodel_radiance: turbidity, albedo, elevation, zenith distance, azimuth from the sun, nm, W/(m² sr nm)
    for (turbidity, albedo, elevation, z, azimuth, nm, expected) in [
        (2.0, 0.2, 40.0, 30.0f64, 60.0f64, 450.0, 8.791535026e-02),
        (3.7, 0.5, 10.0, 85.0, 15.0, 560.0, 4.550495096e-01),
        (10.0, 0.0, 5.0, 60.0, 180.0, 700.0, 2.329504192e-02),
        (1.0, 1.0, 90.0, 0.0, 0.0, 330.0, 1.034981406e-01),
        (5.5, 0.25, 25.3, 65.0, 0.5, 610.0, 6.569053898e-01),
    ] {
        let got = sky(turbidity, albedo, elevation).spectral_radiance(z.to_radians(), azimuth.to_radians(), nm);
        near(got, expected, 1e-8, &format!("{turbidity} {nm}"));
    }
}

#[test]
fn spectral_radiances_are_those_of_mitsuba() {
    // emitter `sunsky` of Mitsuba 3.9.1 in scalar_spectral, sun_scale 0; its numbers are W/(m² sr nm) as ours
    for (turbidity, albedo, elevation, z, azimuth, nm, expected) in [
        (2.0, 0.2, 40.0, 30.0f64, 60.0f64, 560.0, 0.038290269672870636),
        (3.0, 0.5, 10.0, 80.0, 15.0, 610.0, 0.2665875554084778),
        (10.0, 0.0, 5.0, 60.0, 180.0, 450.0, 0.03703243285417557),
        (6.0, 0.25, 60.0, 65.0, 0.5, 700.0, 0.11259947717189789),
    ] {
        let got = sky(turbidity, albedo, elevation).spectral_radiance(z.to_radians(), azimuth.to_radians(), nm);
        // single precision
        near(got, expected, 4e-6, &format!("{turbidity} {nm}"));
    }
}

#[test]
fn the_suns_spectral_irradiance_is_that_of_the_authors_code() {
    // arhosekskymodel_solar_radiance_internal2 times the cosine, integrated over its disk of 0.51 degrees by 20,000 rings
    for (turbidity, elevation, nm, expected) in [
        (2.0, 40.0, 450.0, 8.2343918e-01),
        (3.7, 10.0, 560.0, 5.0558901e-01),
        (10.0, 60.0, 700.0, 6.6028004e-01),
        (1.0, 90.0, 400.0, 6.0299842e-01),
        (5.5, 25.3, 610.0, 8.3472972e-01),
        (2.0, 5.0, 620.0, 5.0225946e-01),
    ] {
        let got = sky(turbidity, 0.2, elevation).sun_spectral_irradiance(nm);
        // 1e-6: the rings
        near(got, expected, 1e-6, &format!("{turbidity} {elevation} {nm}"));
    }
}

#[test]
fn the_suns_illuminance_is_that_of_the_authors_code() {
    // the same summed over 360 to 720 nm with K_m y, turbidity, elevation, lx
    for (turbidity, elevation, expected) in [(2.0, 40.0, 76792.72), (3.0, 20.0, 60910.68), (6.0, 60.0, 72777.56)] {
        // 3e-6: 2,000 rings
        near(luminance(sky(turbidity, 0.2, elevation).sun_illuminance()), expected, 3e-6, "sun");
    }
}

/// The authors' code over 360 to 719 nm with K_m = 683.002 lm/W, ground albedo 0.2, no sun: turbidity, elevation,
/// horizontal illuminance in lx, luminance of the zenith in cd/m².
const DAYS: [(f64, f64, f64, f64); 9] = [
    (2.0, 20.0, 11218.3, 1576.3),
    (2.0, 40.0, 14034.7, 2322.4),
    (2.0, 60.0, 15206.3, 3108.5),
    (3.0, 20.0, 12627.0, 1655.7),
    (3.0, 40.0, 16227.2, 2564.3),
    (3.0, 60.0, 17585.0, 3840.7),
    (5.0, 20.0, 16725.1, 2035.8),
    (5.0, 40.0, 23051.9, 3402.2),
    (5.0, 60.0, 25499.1, 6202.3),
];

#[test]
fn luminances_of_the_zenith_are_those_of_the_authors_code() {
    for (turbidity, elevation, _, zenith) in DAYS {
        // printed digits; the band from 719 to 720 nm adds 1e-5
        near(luminance(sky(turbidity, 0.2, elevation).radiance(0.0, 0.0)), zenith, 5e-5, "zenith");
    }
}

#[test]
fn a_sky_in_a_scene_gives_the_illuminance_of_the_formula() {
    for (turbidity, elevation, horizontal, _) in DAYS {
        let picture = sky(turbidity, 0.2, elevation).picture().unwrap();
        let map = Environment::new(picture, Color::splat(1.0), Up::Z, 0.0).unwrap();
        // 6e-4: texels of a third of a degree, as for the CIE skies
        near(map.illuminance(), horizontal, 6e-4, &format!("turbidity {turbidity}, {elevation} deg"));
        assert_eq!(map.repaired(), 0);
        // the ground: ρ E / π over half of all directions
        let mean = map.mean_luminance();
        let below = 0.2 * map.illuminance() / PI;
        let down = map.radiance(lesk_math::vec3(0.6, 0.0, -0.8)).luminance();
        near(f64::from(down), below, 1e-3, "ground");
        assert!(mean > below, "{mean} {below}");
    }
}

#[test]
fn the_sun_stands_where_its_azimuth_says() {
    let east = HosekSky::new(3.0, [0.0; 3], 0.5, FRAC_PI_2).unwrap();
    let map = Environment::new(east.picture().unwrap(), Color::splat(1.0), Up::Z, 0.0).unwrap();
    let toward = |x: f32, y: f32| map.radiance(lesk_math::vec3(x * 0.5f32.cos(), y * 0.5f32.cos(), 0.5f32.sin()));
    assert!(toward(1.0, 0.0).luminance() > 4.0 * toward(-1.0, 0.0).luminance());
    // brightest in the aureole
    let here = luminance(east.radiance(FRAC_PI_2 - 0.5, FRAC_PI_2));
    near(f64::from(toward(1.0, 0.0).luminance()), here, 0.02, "aureole");
}

#[test]
fn a_green_ground_makes_the_sky_greener() {
    let grey = sky(3.0, 0.3, 45.0).radiance(0.5, 2.0);
    let green = HosekSky::new(3.0, [0.1, 0.6, 0.1], FRAC_PI_2 / 2.0, 0.0).unwrap().radiance(0.5, 2.0);
    assert!(green[1] / green[0] > grey[1] / grey[0] && green[1] / green[2] > grey[1] / grey[2], "{green:?} {grey:?}");
}

#[test]
fn the_low_sun_is_red_and_weak() {
    let (high, low) = (sky(3.0, 0.2, 60.0).sun_illuminance(), sky(3.0, 0.2, 3.0).sun_illuminance());
    assert!(luminance(low) < 0.2 * luminance(high));
    assert!(low[0] / low[2] > 3.0 * high[0] / high[2]);
}

#[test]
fn every_state_is_finite_and_not_negative() {
    for turbidity in [1.0, 1.5, 6.2, 9.99, 10.0] {
        for elevation in [0.0, 0.3, 10.0, 45.0, 90.0] {
            for albedo in [0.0, 0.5, 1.0] {
                let sky = sky(turbidity, albedo, elevation);
                let sun = sky.sun_illuminance();
                assert!(sun.iter().all(|v| v.is_finite() && *v >= 0.0), "{sun:?}");
                for (z, azimuth) in [(0.0, 0.0), (FRAC_PI_2, 0.0), (FRAC_PI_2 - 0.01, 1.0), (1.0, PI)] {
                    let rgb = sky.radiance(z, azimuth);
                    assert!(rgb.iter().all(|v| v.is_finite() && *v >= 0.0), "{turbidity} {elevation} {z}: {rgb:?}");
                }
            }
        }
    }
}

#[test]
fn states_outside_the_model_are_refused_with_what_is_accepted() {
    let text =
        |turbidity, albedo, elevation| HosekSky::new(turbidity, [albedo; 3], elevation, 0.0).unwrap_err().to_string();
    assert_eq!(
        text(0.9, 0.2, 1.0),
        "turbidity is 0.9, 1 to 10 is accepted\nhint: 2 is a very clear sky, 3 a clear one, 6 a hazy one"
    );
    assert!(text(f64::NAN, 0.2, 1.0).starts_with("turbidity is NaN"));
    assert!(text(2.0, 1.1, 1.0).starts_with("reflectance of the ground is 1.1, 0 to 1"));
    assert!(text(2.0, 0.1, -0.1).contains("0 to 90 deg is accepted"));
}
