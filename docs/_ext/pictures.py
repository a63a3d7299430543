"""Every picture of the book, made by Lesk itself while the book is built; kept until Lesk or its maker changes."""

import subprocess
from pathlib import Path

import lesk

FOLDER = "pictures"
SCENES = Path(__file__).parents[2] / "examples" / "scenes"

# models that differ much from one another, for pages that show one plot of each kind
SHOWN = {
    "polar": lambda: lesk.plot.polar(
        [lesk.models.create(name) for name in ("lambert", "oren_nayar", "blinn_phong", "ggx")], theta_i_deg=45
    ),
    "lobe3d": lambda: lesk.plot.lobe3d(lesk.models.ward(alpha_x=0.15, alpha_y=0.4)),
    "slice": lambda: lesk.plot.slice(lesk.models.disney_2012(sheen=1, clearcoat=1)),
    "albedo": lambda: lesk.plot.albedo([lesk.models.ggx(alpha_x=a, alpha_y=a) for a in (0.1, 0.4, 0.7, 1.0)]),
    "sphere": lambda: lesk.plot.sphere(lesk.models.ggx_conductor()),
    "term": lambda: lesk.plot.term("fresnel.dielectric", eta=[1.33, 1.5, 2.4]),
}

# single figures of pages
FIGURES = {
    "observers": lesk.plot.observers,
    "lamps": lambda: lesk.plot.spectrum(["A", "D65", "FL2", "LED-B3"]),
    "luminaire-polar": lambda: lesk.plot.intensity(lesk.light.read(SCENES / "batwing.ies")),
    "luminaire-web": lambda: lesk.plot.web(lesk.light.read(SCENES / "batwing.ies")),
    "skies": lambda: lesk.plot.sky(
        [lesk.light.HosekSky(t, elevation_deg=e, ground=0.2) for t in (2, 4, 8) for e in (3, 15, 40, 70)]
    ),
}


def plots(name):
    """The plots of a model's page, by the ends of their names."""
    model = lesk.models.create(name)
    return {
        "sphere": lambda: lesk.plot.sphere(model, resolution=220, samples=64, title=False),
        "polar": lambda: lesk.plot.polar(model),
        "albedo": lambda: lesk.plot.albedo(model),
    }


def rendered(scene, *, size, spp, **settings):
    """A scene of the examples, smaller."""
    text = (SCENES / scene).read_text(encoding="utf-8")
    lines = [f"size = [{size[0]}, {size[1]}]" if line.startswith("size =") else line for line in text.splitlines()]
    return lesk.render("\n".join(lines) + "\n", spp=spp, **settings)


def layers(path):
    """The light-path layers of a scene side by side: all with the exposure of the whole."""
    import numpy as np

    names = ["direct", "indirect", "specular", "caustic"]
    picture = rendered("glass_and_metal.toml", size=(240, 180), spp=100, split=names)
    shown = []
    for name in names:
        linear = np.stack([picture.layers[f"{name}.{c}"] for c in "RGB"], axis=-1)
        shown.append(lesk.image.develop(linear, ev100=picture.ev100))
    row = np.concatenate(shown, axis=1)
    lesk.image.write(path, decoded(row))


def decoded(encoded):
    """Linear values of sRGB-encoded ones, as `lesk.image.write` takes them (IEC 61966-2-1)."""
    import numpy as np

    return np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4).astype(np.float32)


def renders():
    """Renders by file name."""
    return {
        "scene.png": lambda path: rendered("glass_and_metal.toml", size=(480, 360), spp=81).save(path),
        "layers.png": layers,
        "clear_sky.png": lambda path: rendered("clear_sky.toml", size=(480, 270), spp=100).save(path),
    }


def shader(path):
    """The source that the page on shaders shows."""
    command = ["lesk", "shader", "ggx", "--to", "glsl", "--part", "eval", "-o", str(path)]
    subprocess.run(command, check=True)


def make(folder):
    """Make all that are missing or older than the package."""
    package = Path(lesk.__file__).parent
    sources = [Path(__file__), *package.rglob("*.so"), *package.rglob("*.pyd"), *(package / "plot").glob("*.py")]
    newest = max(source.stat().st_mtime for source in sources)
    folder.mkdir(exist_ok=True)

    def fresh(path):
        return path.exists() and path.stat().st_mtime > newest

    for name in lesk.models.ALL:
        paths = {folder / f"{name}-{kind}.png": draw for kind, draw in plots(name).items()}
        save(paths, fresh)
    save({folder / f"kind-{kind}.png": draw for kind, draw in SHOWN.items()}, fresh)
    save({folder / f"{name}.png": draw for name, draw in FIGURES.items()}, fresh)
    for name, render in renders().items():
        if not fresh(folder / name):
            render(folder / name)
    if not fresh(folder / "ggx.glsl"):
        shader(folder / "ggx.glsl")


def save(paths, fresh):
    """Draw and save what is not fresh."""
    for path, draw in paths.items():
        if not fresh(path):
            draw().savefig(path, dpi=110)


def setup(app):
    """Make the pictures before pages look for them."""
    app.connect("builder-inited", lambda app: make(Path(app.srcdir) / FOLDER))
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
