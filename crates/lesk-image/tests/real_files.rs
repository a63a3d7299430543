//! Files that other programs wrote, against other readers: OpenCV 5.0.0 for HDR, JPEG and PNG, OpenEXR 3.5.3 for EXR.
//!
//! Channel means of the whole file as those read it: `cv2.imread(path, IMREAD_UNCHANGED).mean((0, 1))` over 255, and
//! `OpenEXR.File(path).channels()[c].pixels.mean()` in f64.

use lesk_image::io;
use std::path::PathBuf;

/// The folder of shared data; not part of the project.
fn shared() -> PathBuf {
    let beside = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared");
    std::env::var_os("LESK_SHARED").map_or(beside, PathBuf::from).join("data")
}

#[test]
fn channel_means_of_real_files_are_those_of_other_readers() {
    // a last digit of the six printed; JPEG decoders round the inverse transform differently, by less than one code value
    let (exact, jpeg) = (2e-6, 1.0 / 255.0);
    let cases = [
        ("lights/hdr/venice_sunset_1k.hdr", (1024, 512), [0.404657, 0.416238, 0.573429], exact),
        ("textures/hdri/irradiance/table_mountain.hdr", (256, 128), [0.448288, 0.4154, 0.30665], exact),
        ("meshes/matpreview/envmap.exr", (512, 256), [0.396962, 0.316211, 0.27836], exact),
        ("meshes/spot/spot_texture.png", (1024, 1024), [0.949033, 0.875318, 0.83941], exact),
        (
            "textures/svbrdf/MetalPlates006/MetalPlates006_Normal.png",
            (1024, 1024),
            [0.504789, 0.502036, 0.961212],
            exact,
        ),
        ("textures/svbrdf/Onyx003/albedo.jpg", (1024, 1024), [0.663972, 0.590159, 0.491314], jpeg),
    ];
    for (name, size, means, tolerance) in cases {
        let path = shared().join(name);
        if !path.exists() {
            println!("skipped: no {name} in the shared data");
            continue;
        }
        let image = io::read(&path).unwrap();
        assert_eq!((image.width(), image.height()), size, "{name}");
        for c in 0..3 {
            let sum: f64 = image.rgb_pixels().map(|p| f64::from(p[c])).sum();
            let mean = sum / f64::from(size.0 * size.1);
            assert!((mean - means[c]).abs() <= tolerance * means[c].max(1.0), "{name}: {mean} not {}", means[c]);
        }
    }
}
