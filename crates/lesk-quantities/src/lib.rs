//! Radiometry, photometry and units.
