//! Files that others made: the synthetic corpus with its expected results, and real ones. They lie outside of the
//! repository; without them these tests say so and pass.

use lesk_light::photometry::{Counted, Photometry, ReadOptions};
use serde_json::Value;
use std::path::PathBuf;

/// The folder of photometric files, if it is there.
fn folder() -> Option<PathBuf> {
    let shared = std::env::var_os("LESK_SHARED").map(PathBuf::from);
    let beside = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared");
    let folder = shared.unwrap_or(beside).join("data/lights");
    if folder.is_dir() {
        return Some(folder);
    }
    eprintln!("SKIPPED: {} is not there", folder.display());
    None
}

fn read(path: PathBuf) -> Result<Photometry, String> {
    Photometry::read(path, ReadOptions::default()).map_err(|e| e.to_string())
}

fn number(value: &Value, key: &str) -> Option<f64> {
    value[key].as_f64()
}

#[test]
fn the_whole_synthetic_corpus_is_read_as_expected() {
    let Some(folder) = folder() else { return };
    let text = std::fs::read_to_string(folder.join("synthetic/expected.json")).unwrap();
    let expected: Value = serde_json::from_str(&text).unwrap();
    let expected = expected.as_object().unwrap();
    assert_eq!(expected.len(), 64);
    let mut faults = Vec::new();
    for (name, facts) in expected {
        let result = read(folder.join("synthetic").join(name));
        let verdict = match (facts["ok"].as_bool().unwrap(), result) {
            (true, Ok(photometry)) => compare(name, &photometry, facts),
            (false, Err(_)) => Ok(()),
            (true, Err(e)) => Err(format!("is refused: {e}")),
            (false, Ok(_)) => Err("is accepted".into()),
        };
        if let Err(fault) = verdict {
            faults.push(format!("{name}: {fault}"));
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// The expected flux; for the fans of types A and B, by the geometry of LM-63: H is the longitude of A, the latitude of B.
fn expected_flux(name: &str, facts: &Value) -> f64 {
    let key = match name {
        "fanH_typeA.ies" => "flux_lm_if_H_is_longitude",
        "fanH_typeB.ies" => "flux_lm_if_H_is_latitude",
        _ => "flux_lm",
    };
    number(facts, key).or_else(|| facts["flux_lm_by_set"][0].as_f64()).unwrap()
}

fn compare(name: &str, photometry: &Photometry, facts: &Value) -> Result<(), String> {
    let close = |what: &str, got: f64, wanted: f64, tolerance: f64| {
        let fine = (got - wanted).abs() <= tolerance * wanted.abs().max(1e-9);
        if fine { Ok(()) } else { Err(format!("{what} is {got}, not {wanted}")) }
    };
    // the file's six decimals and the table's own error, as expected.json states it
    let tolerance = number(facts, "flux_rel_tol").unwrap_or(0.004);
    close("flux", photometry.flux(), expected_flux(name, facts), tolerance)?;
    if let Some(peak) = number(facts, "peak_cd") {
        close("peak", photometry.peak().0, peak, 1e-6)?;
    }
    for at in facts["cd_at"].as_array().into_iter().flatten() {
        let [theta, phi, cd] = [0, 1, 2].map(|i| at[i].as_f64().unwrap());
        let got = photometry.intensity(theta.to_radians(), phi.to_radians());
        close(&format!("intensity at {theta}, {phi}"), got, cd, 1e-6)?;
    }
    if let Some(ratio) = number(facts, "light_output_ratio") {
        close("light output ratio", photometry.light_output_ratio().unwrap(), ratio, tolerance)?;
    }
    if let Some(lumens) = number(facts, "lamp_lumens_total") {
        close("lamp flux", photometry.lamp_flux().unwrap(), lumens, 1e-12)?;
    }
    if let Some(shape) = facts["luminous_opening"].as_str() {
        let opening = photometry.opening;
        let round = number(facts, "diameter_m");
        let wanted = [round.or(number(facts, "length_m")).unwrap(), round.or(number(facts, "width_m")).unwrap()];
        if opening.name() != shape {
            return Err(format!("opening is a {}", opening.name()));
        }
        close("length", opening.size[0], wanted[0], 1e-9)?;
        close("width", opening.size[1], wanted[1], 1e-9)?;
    }
    if let Some(factor) = number(facts, "tilt_factor_at_45") {
        let tilt = photometry.tilt.as_ref().unwrap();
        close("tilt factor", tilt.factor(45.0), factor, 1e-12)?;
        assert_eq!(f64::from(tilt.geometry), number(facts, "tilt_geometry").unwrap());
    }
    if facts["absolute"].as_bool() == Some(true) && !photometry.absolute {
        return Err("is not absolute".into());
    }
    if facts["warn"].as_bool() == Some(true) && photometry.warnings.is_empty() {
        return Err("is read without a warning".into());
    }
    Ok(())
}

#[test]
fn warnings_name_lines_and_strict_reading_refuses_them() {
    let Some(folder) = folder() else { return };
    for (name, line, field) in [
        ("wild_ballast_zero.ies", 9, "ballast factor"),
        ("wild_tilt_spaces.ies", 7, "TILT"),
        ("free_0_345_no360.ies", 14, "horizontal angles"),
        ("wild_version_space.ies", 1, "version"),
        ("wild_bom.ldt", 1, "first line"),
    ] {
        let path = folder.join("synthetic").join(name);
        let warnings = read(path.clone()).unwrap().warnings;
        assert!(warnings.iter().any(|w| w.line == line && w.field == field), "{name}: {warnings:?}");
        let strict = Photometry::read(path, ReadOptions { strict: true, lamp_set: 0 });
        assert!(strict.unwrap_err().message().contains(field));
    }
    // the good files are fine in strict reading, too
    for name in
        ["iso_1995.ies", "lamb_commas.ies", "quad_0_90.ies", "free_isym0.ldt", "lamb_1986.ies", "wild_latin1.ies"]
    {
        let path = folder.join("synthetic").join(name);
        Photometry::read(path, ReadOptions { strict: true, lamp_set: 0 }).unwrap();
    }
}

#[test]
fn both_lamp_sets_have_their_flux() {
    let Some(folder) = folder() else { return };
    for (lamp_set, lumens) in [(0, 1000.0), (1, 2000.0)] {
        let path = folder.join("synthetic/lamb_two_sets.ldt");
        let flux = Photometry::read(path, ReadOptions { strict: false, lamp_set }).unwrap().flux();
        assert!((flux / lumens - 1.0).abs() < 0.004);
    }
}

/// All files with an ending below a folder.
fn files(folder: PathBuf, ending: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![folder];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            match path.is_dir() {
                true => folders.push(path),
                false if path.extension().is_some_and(|e| e == ending) => found.push(path),
                false => {}
            }
        }
    }
    found.sort();
    found
}

#[test]
fn real_eulumdat_files_have_the_output_ratio_of_their_header() {
    let Some(folder) = folder() else { return };
    let mut all = files(folder.join("ldt"), "ldt");
    all.extend(files(folder.join("ugr"), "ldt"));
    assert!(all.len() >= 20);
    for path in all {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let photometry = read(path.clone()).unwrap();
        // the dummy files of photometric-viewer repeat one invented table under a header that states 100 %
        if path.to_string_lossy().contains("photometric-viewer") {
            let (declared, _) = photometry.declared_flux().unwrap();
            let off = (photometry.flux() / declared - 1.0).abs() > 0.01;
            assert_eq!(off, photometry.warnings.iter().any(|w| w.field == "light output ratio"), "{name}");
            continue;
        }
        let (ratio, stated) = (photometry.light_output_ratio().unwrap(), photometry.stated_lor.unwrap());
        // narrow beams in steps of 5 degrees: of sample_05, I sin γ Δγ summed gives 98.6 %, means of zones give 104.5 %, the
        // bilinear contract 102.5 %, and the header, by a rule that it does not name, 100.1 %; likewise sample_01
        let tolerance = if ["sample_01.ldt", "sample_05.ldt"].contains(&&*name) { 0.03 } else { 0.005 };
        assert!((ratio / stated - 1.0).abs() < tolerance, "{name}: {ratio} is not {stated}");
    }
}

#[test]
fn real_ies_files_have_the_flux_that_others_read() {
    let Some(folder) = folder() else { return };
    // MANIFEST.md beside the files: integrated by an independent reader, in lm and mW
    for (name, flux) in [
        ("visa_CB1210-2LF13.ies", 1149.1),
        ("visa_CB1900-NGT.ies", 11.86),
        ("visa_CB1948PSX-LNW850-CL.ies", 593.4),
        ("acuity_ASA_15M_R2.ies", 9560.8),
        ("radiance_examp1_Ledalite.ies", 5296.7),
        ("guv_B1_module_Ushio.ies", 0.1211),
    ] {
        let path = folder.join("ies").join(name);
        if !path.is_file() {
            eprintln!("SKIPPED: {name} is not there");
            continue;
        }
        let photometry = read(path).unwrap();
        assert!((photometry.flux() / flux - 1.0).abs() < 0.005, "{name}: {}", photometry.flux());
        let power = name.starts_with("guv");
        assert_eq!(photometry.counted == Counted::Power, power, "{name}");
    }
    for path in files(folder.join("ies"), "ies") {
        let refused = path.ends_with("mdl_test_file_format_error.ies");
        assert_eq!(read(path.clone()).is_err(), refused, "{}", path.display());
    }
}

#[test]
fn openings_of_1995_have_the_shapes_of_their_names() {
    let Some(folder) = folder() else { return };
    for (name, shape) in [
        ("point_opening", "point"),
        ("round_opening", "circle"),
        ("round_opening_with_height", "vertical cylinder"),
        ("rectangular_opening", "rectangle"),
        ("rectangular_opening_with_height", "box"),
        ("sphere_opening", "sphere"),
        ("ellipsoid_opening_along_length", "ellipsoid"),
        ("ellipsoid_opening_along_width", "ellipsoid"),
        ("horizontal_cylinder_opening_along_length", "horizontal cylinder"),
        ("horizontal_cylinder_opening_along_width", "horizontal cylinder"),
        // by the standard's table an elliptic cylinder: it has a height
        ("ellipse_opening_along_length", "vertical cylinder"),
        ("ellipse_opening_along_width", "vertical cylinder"),
    ] {
        let photometry = read(folder.join("ies/photometric-viewer").join(name).with_extension("ies")).unwrap();
        assert_eq!(photometry.opening.name(), shape, "{name}");
    }
}

#[test]
fn glare_tables_lie_between_those_of_dialux_and_relux() {
    let Some(folder) = folder() else { return };
    let table = |name: String| -> Vec<Vec<f64>> {
        let text = std::fs::read_to_string(folder.join("ugr").join(name)).unwrap();
        let cell = |cell: &str| cell.trim_start_matches('<').parse().unwrap();
        text.lines().filter(|line| !line.trim().is_empty()).map(|line| line.split(',').map(cell).collect()).collect()
    };
    for sample in ["01", "02", "03", "04", "05", "11"] {
        let photometry = read(folder.join(format!("ugr/sample_{sample}.ldt"))).unwrap();
        let ours = photometry.ugr_table(0.25).unwrap();
        for program in ["Dialux", "Relux"] {
            let theirs = table(format!("ugr_table_{sample}_{program}.csv"));
            assert_eq!(theirs.len(), ours.values.len());
            let mut worst: (f64, usize, usize) = (0.0, 0, 0);
            let mut sum = 0.0;
            for (i, (row, other)) in ours.values.iter().zip(&theirs).enumerate() {
                for (j, (a, b)) in row.iter().zip(other).enumerate() {
                    sum += a - b;
                    if (a - b).abs() > worst.0.abs() {
                        worst = (a - b, i, j);
                    }
                }
            }
            eprintln!("sample {sample}, {program}: mean {:+.2}, worst {worst:?}", sum / 190.0);
            // the two programs differ by up to 1.0 from each other
            assert!(worst.0.abs() < 1.0, "sample {sample}, {program}: {worst:?}");
        }
    }
}
