//! The clear and hazy sky of Hosek and Wilkie, *An Analytic Model for Full Spectral Sky-Dome Radiance*, ACM Transactions on
//! Graphics 31(4), 2012, and its sun, *Adding a Solar Radiance Function to the Hosek-Wilkie Skylight Model*, IEEE Computer
//! Graphics and Applications 33(3), 2013; coefficients of version 1.4a.

mod tables;

use crate::dome;
use crate::error::LightError;
use lesk_image::Image;
use lesk_quantities::upsampling::Reflectance;
use lesk_quantities::{K_M, colorspace, observer};
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::LazyLock;
use tables::{BANDS, FIRST_NM, Shape, TABLES};

/// Angular diameter of the disk for which the solar radiance is published, radians.
const DISK_DIAMETER: f64 = 0.51 * PI / 180.0;

/// K_m times the linear Rec.709 of every band, whose spectrum falls linearly to zero at its neighbours: lm/W nm.
static WEIGHTS: LazyLock<[[f64; 3]; BANDS]> = LazyLock::new(|| {
    std::array::from_fn(|band| {
        let hat = |nm: f64| tables::share(band, nm) * K_M;
        colorspace::rec709_from_xyz(observer::xyz(hat))
    })
});

/// A cloudless sky at a turbidity, in physical units: radiance at 320 to 720 nm in 11 bands with linear interpolation.
///
/// Turbidity is the optical thickness of haze and air over that of air alone: 2 is a very clear sky, 3 a clear one, 6 a
/// hazy one, 10 nearly fog.
#[derive(Clone, Debug)]
pub struct HosekSky {
    turbidity: f64,
    ground: [f64; 3],
    elevation: f64,
    azimuth: f64,
    shapes: [Shape; BANDS],
}

impl HosekSky {
    /// Turbidities of the model.
    pub const TURBIDITIES: [f64; 2] = [1.0, 10.0];

    /// A sky over a ground of this reflectance (linear Rec.709, equal channels are grey at every wavelength), with the sun
    /// at an elevation and azimuth in radians as for [`CieSky`](crate::CieSky).
    ///
    /// # Errors
    /// A turbidity that is not 1 to 10, a reflectance that is not 0 to 1, a sun that is not 0 to 90 degrees high.
    pub fn new(turbidity: f64, ground: [f64; 3], elevation: f64, azimuth: f64) -> Result<Self, LightError> {
        check_turbidity(turbidity)?;
        ground.into_iter().try_for_each(dome::check_ground)?;
        dome::check_sun(elevation, azimuth, "the model has skies of the day")?;
        let elevation = elevation.min(FRAC_PI_2);
        let albedos = albedos(ground)?;
        let shapes = std::array::from_fn(|band| TABLES.shape(band, turbidity, albedos[band], elevation));
        Ok(HosekSky { turbidity, ground, elevation, azimuth, shapes })
    }

    /// Spectral radiance at a zenith distance below π/2 and an azimuth in radians, W/(m² sr nm); zero outside 320 to
    /// 720 nm.
    pub fn spectral_radiance(&self, zenith_distance: f64, azimuth: f64, lambda_nm: f64) -> f64 {
        let bands = self.bands(zenith_distance, azimuth);
        (0..BANDS).map(|band| tables::share(band, lambda_nm) * bands[band]).sum()
    }

    /// Luminance at a zenith distance below π/2 and an azimuth in radians: linear Rec.709 whose Y is cd/m².
    pub fn radiance(&self, zenith_distance: f64, azimuth: f64) -> [f64; 3] {
        color(self.bands(zenith_distance, azimuth))
    }

    fn bands(&self, zenith_distance: f64, azimuth: f64) -> [f64; BANDS] {
        let sun = [FRAC_PI_2 - self.elevation, self.azimuth];
        let cos_gamma = dome::cos_between([zenith_distance, azimuth], sun);
        let (gamma, cos_z) = (cos_gamma.acos(), zenith_distance.cos().max(0.0));
        self.shapes.each_ref().map(|shape| shape.radiance(cos_z, gamma, cos_gamma))
    }

    /// Spectral irradiance of a plane perpendicular to the sun by its disk alone, W/(m² nm); zero outside 320 to 720 nm.
    ///
    /// That of the published function, whose disk of 0.51 degrees has the radiance of the mean sun at its centre and is
    /// darker toward its limb.
    pub fn sun_spectral_irradiance(&self, lambda_nm: f64) -> f64 {
        // the integral of the cosine over the disk
        let projected = PI * (0.5 * DISK_DIAMETER).sin().powi(2);
        let center = |band| TABLES.sun_center(band, self.turbidity, self.elevation);
        let interpolated = |of_band: &dyn Fn(usize) -> f64| -> f64 {
            (0..BANDS).map(|band| tables::share(band, lambda_nm) * of_band(band)).sum()
        };
        interpolated(&center).max(0.0) * interpolated(&|band| TABLES.sun_mean(band)) * projected
    }

    /// Illuminance of a plane perpendicular to the sun by its disk alone: linear Rec.709 whose Y is lx.
    pub fn sun_illuminance(&self) -> [f64; 3] {
        within_gamut(colorspace::rec709_from_xyz(observer::xyz(|nm| K_M * self.sun_spectral_irradiance(nm))))
    }

    /// The sky as a latitude-longitude picture in cd/m², without the sun's disk; the lower half reflects what the sky
    /// gives to a horizontal plane.
    ///
    /// # Errors
    /// None that a sky made by [`new`](Self::new) has.
    pub fn picture(&self) -> Result<Image, LightError> {
        dome::picture(|z, azimuth| self.radiance(z, azimuth), self.ground)
    }
}

/// Checks a turbidity.
fn check_turbidity(turbidity: f64) -> Result<(), LightError> {
    let [low, high] = HosekSky::TURBIDITIES;
    if (low..=high).contains(&turbidity) {
        return Ok(());
    }
    Err(LightError::new(format!("turbidity is {turbidity}, {low} to {high} is accepted"))
        .hint("2 is a very clear sky, 3 a clear one, 6 a hazy one"))
}

/// The reflectance of the ground in every band.
fn albedos(ground: [f64; 3]) -> Result<[f64; BANDS], LightError> {
    if ground[0] == ground[1] && ground[1] == ground[2] {
        return Ok([ground[0]; BANDS]);
    }
    let spectrum = Reflectance::of_srgb(ground).map_err(|e| LightError::new(e.to_string()))?;
    Ok(std::array::from_fn(|band| spectrum.at(FIRST_NM + tables::STEP_NM * band as f64)))
}

/// Linear Rec.709 of radiances per nm in each band.
fn color(bands: [f64; BANDS]) -> [f64; 3] {
    let mut rgb = [0.0; 3];
    for (value, weight) in bands.into_iter().zip(WEIGHTS.iter()) {
        (0..3).for_each(|c| rgb[c] += value * weight[c]);
    }
    within_gamut(rgb)
}

/// A colour outside the gamut loses what is negative, not its luminance.
fn within_gamut(rgb: [f64; 3]) -> [f64; 3] {
    let luminance = colorspace::luminance(rgb).max(0.0);
    let inside = rgb.map(|v| v.max(0.0));
    let left = colorspace::luminance(inside);
    if left > 0.0 { inside.map(|v| v * luminance / left) } else { [0.0; 3] }
}
