//! A failed write keeps the previous file and says where it stopped.
#![cfg(unix)]

use lesk_image::io::{png, write_bytes};
use lesk_image::{Image, ImageError, Transfer, atomic_write};
use std::fs;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::Path;
use std::process::Command;

/// Names in a folder, sorted: a left-over temporary file would show.
fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn a_new_file_has_the_bytes_and_nothing_else_is_left() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.bin");
    write_bytes(&path, b"first").unwrap();
    write_bytes(&path, b"second").unwrap();
    assert_eq!(fs::read(&path).unwrap(), b"second");
    assert_eq!(names(folder.path()), ["a.bin"]);
}

#[test]
fn a_full_device_is_an_error_with_place_and_size() {
    let error = write_bytes("/dev/full", &vec![0; 200_000]).unwrap_err();
    assert_eq!(
        error.to_string().lines().next().unwrap(),
        "cannot write `/dev/full`: no space left on device after 0 of 200000 bytes"
    );
    assert!(matches!(error, ImageError::Write { written: 0, size: Some(200_000), .. }));
    // it is still a device
    assert!(!fs::metadata("/dev/full").unwrap().is_file());
}

#[test]
fn a_device_that_takes_everything_is_written_to_directly() {
    write_bytes("/dev/null", b"gone").unwrap();
    assert!(!fs::metadata("/dev/null").unwrap().is_file());
}

#[test]
fn an_error_while_filling_keeps_the_previous_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.bin");
    write_bytes(&path, b"previous").unwrap();
    let error = atomic_write(&path, None, |out| {
        out.write_all(&vec![1; 100_000])?;
        Err(std::io::Error::other("stopped"))
    });
    assert!(error.unwrap_err().to_string().contains("stopped"));
    assert_eq!(fs::read(&path).unwrap(), b"previous");
    assert_eq!(names(folder.path()), ["a.bin"]);
}

#[test]
fn a_folder_a_missing_folder_and_a_read_only_file_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let first = |path: &Path| write_bytes(path, b"x").unwrap_err().to_string().lines().next().unwrap().to_string();
    assert!(first(folder.path()).contains("it is a folder"));
    assert!(first(&folder.path().join("missing/a.bin")).contains("no such file or directory after 0 of 1 bytes"));
    let missing = write_bytes(folder.path().join("missing/a.bin"), b"x").unwrap_err().to_string();
    assert!(missing.ends_with("hint: the folder does not exist, make it first"), "{missing}");
    let path = folder.path().join("read_only.bin");
    write_bytes(&path, b"kept").unwrap();
    fs::set_permissions(&path, fs::Permissions::from_mode(0o444)).unwrap();
    // the superuser may write to everything
    if fs::OpenOptions::new().write(true).open(&path).is_err() {
        assert!(first(&path).contains("permission denied"));
        assert_eq!(fs::read(&path).unwrap(), b"kept");
    }
}

#[test]
fn permissions_and_symbolic_links_stay() {
    let folder = tempfile::tempdir().unwrap();
    let (path, link) = (folder.path().join("a.bin"), folder.path().join("link"));
    write_bytes(&path, b"one").unwrap();
    fs::set_permissions(&path, fs::Permissions::from_mode(0o640)).unwrap();
    symlink("a.bin", &link).unwrap();
    write_bytes(&link, b"two").unwrap();
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_eq!(fs::read(&path).unwrap(), b"two");
    assert_eq!(fs::metadata(&path).unwrap().permissions().mode() & 0o777, 0o640);
}

#[test]
fn the_same_image_gives_the_same_file() {
    let folder = tempfile::tempdir().unwrap();
    let image = Image::from_fn(50, 40, Transfer::Linear, |x, y| [x as f32 * 0.02, y as f32 * 0.02, 0.5]).unwrap();
    for name in ["a.exr", "a.png", "a.hdr"] {
        let path = folder.path().join(name);
        let bytes = [(), ()].map(|()| {
            lesk_image::io::write(&path, &image).unwrap();
            fs::read(&path).unwrap()
        });
        assert_eq!(bytes[0], bytes[1], "{name}");
        assert_eq!(lesk_image::io::read(&path).unwrap().width(), 50);
    }
    assert!(lesk_image::io::write(folder.path().join("a.tif"), &image).is_err());
    assert!(png::encode(&image, png::Depth::Sixteen, &[("", "no keyword")]).is_err());
}

/// Environment of the child: the path to write to.
const CHILD: &str = "LESK_TEST_WRITE";

/// Runs in a child process whose files may have 512 or 1024 bytes.
#[test]
fn child_writes_more_than_it_may() {
    if let Some(path) = std::env::var_os(CHILD) {
        let error = write_bytes(&path, &vec![7; 1 << 20]).unwrap_err();
        println!("{error}");
        assert!(matches!(error, ImageError::Write { written: 512..=1024, size: Some(1_048_576), .. }));
    }
}

#[test]
fn a_limit_on_file_sizes_keeps_the_previous_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.bin");
    write_bytes(&path, b"previous").unwrap();
    // the signal is ignored, as Python does; then the system returns an error
    let script = "trap '' XFSZ; ulimit -f 1; exec \"$0\" --exact child_writes_more_than_it_may --nocapture";
    let output = Command::new("sh")
        .args(["-c", script])
        .arg(std::env::current_exe().unwrap())
        .env(CHILD, &path)
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success() && text.contains("file too large after"), "{output:?}");
    assert!(text.contains("of 1048576 bytes"), "{text}");
    assert_eq!(fs::read(&path).unwrap(), b"previous");
    assert_eq!(names(folder.path()), ["a.bin"]);
}
