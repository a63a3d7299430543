//! Where the sun stands, by place and time.

use crate::error::LightError;
use lesk_math::{Vec3, vec3};
use solar_positioning::time::JulianDate;
use solar_positioning::{Location, RefractionCorrection, SolarPositions, delta_t};

/// Angular diameter of the sun at its mean distance, radians.
pub const SUN_DIAMETER: f64 = 0.5338 * std::f64::consts::PI / 180.0;

/// A place on earth and a moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// Degrees, north positive.
    pub latitude_deg: f64,
    /// Degrees, east positive.
    pub longitude_deg: f64,
    /// Metres above sea level.
    pub altitude: f64,
    /// Year, month, day.
    pub date: [i32; 3],
    /// Hours of coordinated universal time, 0 to 24.
    pub hours_utc: f64,
    /// Seconds by which terrestrial time is ahead; `None` takes an estimate for the month.
    pub delta_t: Option<f64>,
    /// Pressure in hPa and temperature in °C of the air that refracts; `None` leaves refraction out.
    pub air: Option<[f64; 2]>,
}

/// The place of the sun: radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SunPosition {
    /// Above the horizon.
    pub elevation: f64,
    /// From north, clockwise over east.
    pub azimuth: f64,
}

impl Moment {
    /// Date and hours from `2025-06-21T12:00Z` or `2025-06-21T14:00:30+02:00`.
    ///
    /// # Errors
    /// Another form, and a time without zone.
    pub fn parse_time(text: &str) -> Result<([i32; 3], f64), LightError> {
        let wrong = || {
            LightError::new(format!(
                "time is `{}`, a date with time and zone is accepted",
                text.get(..40).unwrap_or(text)
            ))
            .hint("for example \"2025-06-21T14:00+02:00\", or \"2025-06-21T12:00Z\"")
        };
        let (date, rest) = text.trim().split_once(['T', ' ']).ok_or_else(wrong)?;
        let (clock, zone) = match rest.find(['Z', '+', '-']) {
            Some(at) => rest.split_at(at),
            None => return Err(wrong()),
        };
        let whole = |word: &str| -> Result<i32, LightError> { word.parse().map_err(|_| wrong()) };
        let parts: Vec<&str> = date.split('-').collect();
        let [year, month, day] = parts[..] else { return Err(wrong()) };
        let hours = |text: &str| -> Result<f64, LightError> {
            let mut parts = text.split(':');
            let hour = f64::from(whole(parts.next().unwrap_or(""))?);
            let minute = parts.next().map_or(Ok(0), whole)?;
            let second: f64 = parts.next().unwrap_or("0").parse().map_err(|_| wrong())?;
            let legal = hour.abs() < 24.0 && (0..60).contains(&minute) && (0.0..60.0).contains(&second);
            if legal && parts.next().is_none() {
                Ok(hour + (f64::from(minute) + second / 60.0) / 60.0)
            } else {
                Err(wrong())
            }
        };
        let ahead = match zone {
            "Z" => 0.0,
            _ if zone.starts_with('+') => hours(&zone[1..])?,
            _ if zone.starts_with('-') => -hours(&zone[1..])?,
            _ => return Err(wrong()),
        };
        let date = [whole(year)?, whole(month)?, whole(day)?];
        Ok(shifted(date, hours(clock)? - ahead))
    }
}

/// A date whose hours lie within the day.
fn shifted([year, month, day]: [i32; 3], hours: f64) -> ([i32; 3], f64) {
    let leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
    let length = |month: i32| match month {
        2 => 28 + i32::from(leap),
        4 | 6 | 9 | 11 => 30,
        _ => 31,
    };
    if hours < 0.0 {
        let date = match (month, day) {
            (1, 1) => [year - 1, 12, 31],
            (_, 1) => [year, month - 1, length(month - 1)],
            _ => [year, month, day - 1],
        };
        return (date, hours + 24.0);
    }
    if hours < 24.0 {
        return ([year, month, day], hours);
    }
    let date = match day == length(month) {
        true if month == 12 => [year + 1, 1, 1],
        true => [year, month + 1, 1],
        false => [year, month, day + 1],
    };
    (date, hours - 24.0)
}

impl SunPosition {
    /// Where the sun stands (Reda & Andreas, *Solar Position Algorithm for Solar Radiation Applications*, NREL 2008,
    /// through the crate `solar-positioning`): 0.0003 degrees for the years -2000 to 6000.
    ///
    /// # Errors
    /// A place or a moment that does not exist.
    pub fn at(moment: &Moment) -> Result<Self, LightError> {
        let [year, month, day] = moment.date;
        let minutes = moment.hours_utc * 60.0;
        let legal = (0.0..24.0).contains(&moment.hours_utc) && (1..=12).contains(&month) && (1..=31).contains(&day);
        if !legal {
            let text = format!("{year}-{month}-{day} at {} h is no moment", moment.hours_utc);
            return Err(LightError::new(text).hint("give a date and 0 to below 24 h of universal time"));
        }
        let failed = |e: solar_positioning::Error| LightError::new(e.to_string().to_lowercase());
        let hour = moment.hours_utc.floor();
        let minute = (minutes - 60.0 * hour).floor().min(59.0);
        let second = (60.0 * (minutes - 60.0 * hour - minute)).clamp(0.0, 59.999_999_9);
        let ahead = match moment.delta_t {
            Some(seconds) => seconds,
            None => delta_t::estimate_from_date(year, month as u32).map_err(failed)?,
        };
        let date = JulianDate::from_utc(year, month as u32, day as u32, hour as u32, minute as u32, second, ahead)
            .map_err(failed)?;
        let refraction = moment.air.map(|[hpa, celsius]| RefractionCorrection::new(hpa, celsius)).transpose();
        let location = Location { latitude: moment.latitude_deg, longitude: moment.longitude_deg };
        let position = SolarPositions::new()
            .at_from_julian(date, location, moment.altitude, refraction.map_err(failed)?)
            .map_err(failed)?;
        Ok(SunPosition {
            elevation: (90.0 - position.zenith_angle()).to_radians(),
            azimuth: position.azimuth().to_radians(),
        })
    }

    /// The unit direction to the sun: x east, y north, z up.
    pub fn direction(&self) -> Vec3<f64> {
        let (cos_e, (sin_a, cos_a)) = (self.elevation.cos(), self.azimuth.sin_cos());
        vec3(cos_e * sin_a, cos_e * cos_a, self.elevation.sin())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nrel_example_has_its_printed_position() {
        // Reda & Andreas, table A5.1: 2003-10-17 12:30:30 UTC-7, 820 hPa, 11 °C, ΔT 67 s
        let (date, hours_utc) = Moment::parse_time("2003-10-17T12:30:30-07:00").unwrap();
        let air = Some([820.0, 11.0]);
        let (latitude_deg, longitude_deg, altitude) = (39.742476, -105.1786, 1830.14);
        let moment = Moment { latitude_deg, longitude_deg, altitude, date, hours_utc, delta_t: Some(67.0), air };
        let sun = SunPosition::at(&moment).unwrap();
        assert!((90.0 - sun.elevation.to_degrees() - 50.11162).abs() < 6e-6); // printed digits
        assert!((sun.azimuth.to_degrees() - 194.34024).abs() < 6e-6);
    }

    #[test]
    fn suns_of_four_towns_stand_where_pvlib_has_them() {
        // lights.md, section 5: pvlib's SPA with ΔT 69.2 s, geometric
        for (latitude_deg, longitude_deg, time, elevation, azimuth) in [
            (51.5, 0.0, "2025-03-20T12:00Z", 38.5234, 177.6478),
            (35.6895, 139.6917, "2025-06-21T03:00Z", 77.2074, 197.8746),
            (-33.87, 151.21, "2025-12-21T02:00Z", 79.4591, 351.3627),
            (69.65, 18.96, "2025-12-21T11:00Z", -3.1450, 184.0600),
        ] {
            let (date, hours_utc) = Moment::parse_time(time).unwrap();
            let delta_t = Some(69.2);
            let moment = Moment { latitude_deg, longitude_deg, altitude: 0.0, date, hours_utc, delta_t, air: None };
            let sun = SunPosition::at(&moment).unwrap();
            // printed digits
            assert!((sun.elevation.to_degrees() - elevation).abs() < 6e-5, "{time}: {:?}", sun.elevation.to_degrees());
            assert!((sun.azimuth.to_degrees() - azimuth).abs() < 6e-5, "{time}: {:?}", sun.azimuth.to_degrees());
        }
    }

    #[test]
    fn zones_shift_the_date() {
        assert_eq!(Moment::parse_time("2024-03-01T01:00+02:00").unwrap(), ([2024, 2, 29], 23.0));
        assert_eq!(Moment::parse_time("2024-12-31T23:30-01:00").unwrap(), ([2025, 1, 1], 0.5));
        for bad in
            ["", "2024-03-01", "2024-03-01T12:00", "2024-03T12:00Z", "2024-03-01T25:00Z", "x", "2024-03-01T12:00Z1"]
        {
            assert!(Moment::parse_time(bad).is_err(), "{bad}");
        }
    }
}
