//! Wavefront MTL: the materials of an OBJ file.

use super::obj::{logical_lines, numbers};
use super::{Asset, Description, Error, ImageSource, Material, Mtl, Result, Texture, Wrap, inside_folder};
use std::collections::HashMap;
use std::path::Path;

/// Reads the text of a library alone: an asset without meshes, its materials in the order of their names.
///
/// # Errors
/// Entries before the first material, numbers that are none, not finite or out of range; each with its line.
pub fn from_bytes(bytes: &[u8]) -> Result<Asset> {
    let (mut library, mut asset) = (Library::new(), Asset::default());
    parse(bytes, Path::new(""), &mut library, &mut |w| asset.warn(w))?;
    asset.materials = library.iter().map(|(name, m)| material(name, Some(m))).collect();
    asset.materials.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(asset)
}

/// Materials by name.
pub(super) type Library = HashMap<String, Mtl>;

/// The material `name`, with the format's defaults where it is not in a library.
pub(super) fn material(name: &str, known: Option<&Mtl>) -> Material {
    Material { name: name.to_string(), description: Description::Mtl(known.cloned().unwrap_or_default()) }
}

/// Adds the materials of a library that lies at `path`.
pub(super) fn parse(bytes: &[u8], path: &Path, library: &mut Library, warn: &mut dyn FnMut(String)) -> Result<()> {
    let mut name: Option<String> = None;
    for (number, line) in logical_lines(bytes) {
        let words: Vec<&str> = line.split_ascii_whitespace().collect();
        let Some((&key, rest)) = words.split_first() else { continue };
        if key == "newmtl" {
            let new = line.trim_start()[key.len()..].trim().to_string();
            library.insert(new.clone(), Mtl::default());
            name = Some(new);
            continue;
        }
        let place = |e: Error| e.at(format!("line {number}"));
        let current = name.as_ref().and_then(|n| library.get_mut(n));
        let Some(m) = current else {
            return Err(place(Error::new(format!("`{key}` before the first `newmtl`"))));
        };
        let mut located = |w: String| warn(format!("{}: line {number}: {w}", path.display()));
        entry(m, key, rest, path, &mut located).map_err(place)?;
    }
    Ok(())
}

fn entry(m: &mut Mtl, key: &str, rest: &[&str], path: &Path, warn: &mut dyn FnMut(String)) -> Result<()> {
    match key {
        "Kd" | "Ks" | "Ke" => {
            let Some(color) = color(key, rest)? else {
                warn(format!("`{key} {}` is not supported, an RGB colour is", rest[0]));
                return Ok(());
            };
            match key {
                "Kd" => m.kd = color,
                "Ks" => m.ks = color,
                _ => m.ke = color,
            }
        }
        "Ns" => m.ns = one(key, rest)?,
        "Ni" => m.ni = one(key, rest)?,
        "d" => m.d = one(key, if rest.first() == Some(&"-halo") { &rest[1..] } else { rest })?,
        "Tr" => m.d = 1.0 - one(key, rest)?,
        "illum" => m.illum = rest.first().and_then(|w| w.parse().ok()),
        "map_Kd" => m.map_kd = texture(rest, path, warn)?,
        "map_Ks" => m.map_ks = texture(rest, path, warn)?,
        "map_Ke" => m.map_ke = texture(rest, path, warn)?,
        _ => {}
    }
    Ok(())
}

fn one(key: &str, words: &[&str]) -> Result<f32> {
    let [x] = numbers(key, words, 1)?;
    if x.is_finite() { Ok(x) } else { Err(Error::new(format!("`{key}` is {x}, a finite number is needed"))) }
}

/// `r g b`, or one number for all; `None` for a spectral curve or CIE XYZ.
fn color(key: &str, words: &[&str]) -> Result<Option<[f32; 3]>> {
    if matches!(words.first(), Some(&("spectral" | "xyz"))) {
        return Ok(None);
    }
    let c: [f32; 3] = numbers(key, words, 1)?;
    let c = if words.len() < 3 { [c[0]; 3] } else { c };
    if c.iter().all(|x| x.is_finite() && *x >= 0.0) {
        Ok(Some(c))
    } else {
        Err(Error::new(format!("`{key}` is {c:?}, numbers from 0 on are accepted")))
    }
}

/// How many numbers follow an option of a texture, at most; `None` for what is no option.
fn option_length(word: &str) -> Option<usize> {
    Some(match word {
        "-blendu" | "-blendv" | "-cc" | "-clamp" | "-bm" | "-boost" | "-texres" | "-imfchan" | "-type" => 1,
        "-mm" => 2,
        "-o" | "-s" | "-t" => 3,
        _ => return None,
    })
}

fn texture(words: &[&str], path: &Path, warn: &mut dyn FnMut(String)) -> Result<Option<Texture>> {
    let (mut scale, mut offset, mut wrap) = ([1.0; 2], [0.0; 2], Wrap::Repeat);
    let mut left = words;
    while let Some(length) = left.first().and_then(|w| option_length(w)) {
        let (option, rest) = (left[0], &left[1..]);
        // the second and third number of a vector may be left out
        let is_value = |i: usize| length == 1 || rest[i].parse::<f32>().is_ok();
        let count = (0..length.min(rest.len())).take_while(|&i| is_value(i)).count();
        let values = &rest[..count];
        match option {
            "-s" => {
                let [u, v]: [f32; 2] = numbers(option, values, 1)?;
                scale = if count > 1 { [u, v] } else { [u, 1.0] };
            }
            "-o" => offset = numbers(option, values, 1)?,
            "-clamp" if values == ["on"] => wrap = Wrap::Clamp,
            _ => {}
        }
        left = &rest[count..];
    }
    let name = left.join(" ");
    if name.is_empty() {
        return Err(Error::new("texture has no file name"));
    }
    if scale.iter().chain(&offset).any(|x| !x.is_finite()) {
        return Err(Error::new(format!(
            "texture has the scale {scale:?} and the offset {offset:?}, both must be finite"
        )));
    }
    match inside_folder(path, &name) {
        Ok(file) => {
            let image = ImageSource::File(file);
            let uv = [[scale[0], 0.0, offset[0]], [0.0, scale[1], offset[1]]];
            Ok(Some(Texture { image, uv_set: 0, uv, wrap: [wrap; 2], smooth: true }))
        }
        Err(e) => {
            warn(format!("texture left out: {e}"));
            Ok(None)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<(Library, Vec<String>)> {
        let (mut library, mut warnings) = (Library::new(), vec![]);
        parse(text.as_bytes(), Path::new("/m/a.mtl"), &mut library, &mut |w| warnings.push(w))?;
        Ok((library, warnings))
    }

    #[test]
    fn all_supported_entries_are_read() {
        let text = "newmtl a b\nKd 0.1 0.2 0.3\nKs .5\nNs 20\nKe 1 2 3\nd 0.5\nNi 1.5\nillum 2\n\
                    map_Kd -s 2 3 1 -o 0.5 -clamp on img/my map.png\nmap_Ks k.png\n";
        let (library, warnings) = read(text).unwrap();
        let m = &library["a b"];
        assert_eq!((m.kd, m.ks, m.ke), ([0.1, 0.2, 0.3], [0.5; 3], [1.0, 2.0, 3.0]));
        assert_eq!((m.ns, m.d, m.ni, m.illum), (20.0, 0.5, 1.5, Some(2)));
        let t = m.map_kd.as_ref().unwrap();
        assert_eq!(t.image, ImageSource::File("/m/img/my map.png".into()));
        assert_eq!((t.uv, t.wrap), ([[2.0, 0.0, 0.5], [0.0, 3.0, 0.0]], [Wrap::Clamp; 2]));
        assert!(m.map_ks.is_some() && warnings.is_empty());
    }

    #[test]
    fn textures_outside_the_folder_are_left_out_with_a_warning() {
        let (library, warnings) = read("newmtl a\nmap_Kd ../secret.png\n").unwrap();
        assert_eq!(library["a"].map_kd, None);
        assert!(warnings[0].contains("line 2: texture left out"), "{warnings:?}");
    }

    #[test]
    fn wrong_entries_are_errors_with_their_line() {
        let message = |t| read(t).unwrap_err().to_string();
        assert_eq!(message("Kd 1 1 1\n"), "line 1: `Kd` before the first `newmtl`");
        assert_eq!(message("newmtl a\nKd 1 x 1\n"), "line 2: `x` is no number");
        assert!(message("newmtl a\nKd -1 0 0\n").contains("numbers from 0 on"));
        assert_eq!(message("newmtl a\nNs nan\n"), "line 2: `Ns` is NaN, a finite number is needed");
        assert_eq!(message("newmtl a\nmap_Kd -s 1 1 1\n"), "line 2: texture has no file name");
    }
}
