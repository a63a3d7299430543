"""Renders of Lesk against Mitsuba 3: `cargo xtask validate`, or `python bench/validate.py` where both are installed.

Every scene is rendered by both with independent seeds; the means of tiles must not differ by more than chance. With
`--store` Mitsuba's means are written to data/mitsuba, where `cargo test` compares with them without Mitsuba.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from pathlib import Path

import agreement
import numpy as np
from tiles import TileMeans, sidak_limit, z_of_scatter, z_scores

ROOT = Path(__file__).resolve().parent.parent
STORE = ROOT / "data" / "mitsuba"
SIDE = 8
# of the whole comparison: one in a thousand runs fails by chance
ALPHA = 1e-3


def parse() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--store", action="store_true", help="render with Mitsuba only and write data/mitsuba")
    parser.add_argument("--quick", action="store_true", help="a quarter of the pictures")
    parser.add_argument("--pictures", type=int, default=32, help="pictures of independent seeds per renderer")
    parser.add_argument("--spp", type=int, default=64, help="samples per pixel of each picture")
    parser.add_argument("scenes", nargs="*", help=f"of {', '.join(agreement.SCENES)}; all where absent")
    given = parser.parse_args()
    for name in given.scenes:
        if name not in agreement.SCENES:
            parser.error(f"there is no scene `{name}`, but {', '.join(agreement.SCENES)}")
    given.scenes = given.scenes or list(agreement.SCENES)
    given.pictures = max(8, given.pictures // 4) if given.quick else given.pictures
    return given


def mitsuba_tiles(name: str, pictures: int, spp: int) -> TileMeans:
    import agreement_mitsuba
    from mitsuba_side import mi

    scene = agreement_mitsuba.load(name)
    return TileMeans.of([np.array(mi.render(scene, spp=spp, seed=k)) for k in range(pictures)], SIDE)


def lesk_tiles(name: str, pictures: int, spp: int, folder: Path) -> TileMeans:
    import lesk_side

    file = folder / f"{name}.toml"
    file.write_text(agreement.toml(name, "environment.exr"))
    return TileMeans.of([lesk_side.render(file, spp, seed=k)[0] for k in range(pictures)], SIDE)


def write_environment(folder: Path) -> None:
    import lesk

    w, h = agreement.MAP_SIZE
    x, y = np.meshgrid((np.arange(w) + 0.5) / w, (np.arange(h) + 0.5) / h)
    lesk.image.write(folder / "environment.exr", agreement.radiance_of_map(x, y).astype(np.float32))


def compare(given: argparse.Namespace) -> bool:
    """Prints one row per scene; true if no tile differs by more than chance."""
    from mitsuba_side import VARIANT, mi

    tiles = (agreement.SIZE // SIDE) ** 2
    # every tile, the whole picture and the scatter of the tiles, three channels each
    limit = sidak_limit(len(given.scenes) * (tiles + 2) * 3, ALPHA)
    print(f"Mitsuba {mi.__version__} {VARIANT}, {given.pictures} pictures of {given.spp} samples by each renderer")
    print(f"{tiles} tiles of {SIDE} x {SIDE} pixels; |z| below {limit:.2f} is chance (Sidak, {ALPHA:g} in all)\n")
    print(
        "| scene | Lesk / Mitsuba | its standard error | z of the picture | z of the scatter | largest z of a tile | |"
    )
    print("|---|---|---|---|---|---|---|")
    agrees = True
    with tempfile.TemporaryDirectory() as folder:
        write_environment(Path(folder))
        for name in given.scenes:
            ours = lesk_tiles(name, given.pictures, given.spp, Path(folder))
            agrees &= report(name, ours, mitsuba_tiles(name, given.pictures, given.spp), limit)
    return agrees


def report(name: str, ours: TileMeans, theirs: TileMeans, limit: float) -> bool:
    z = z_scores(ours, theirs)
    whole = z_scores(ours.whole(), theirs.whole())[0]
    scatter = z_of_scatter(z)
    tile, channel = np.unravel_index(np.abs(z).argmax(), z.shape)
    agrees = max(np.abs(z).max(), np.abs(whole).max(), scatter.max()) < limit
    ratio = ours.mean.sum() / theirs.mean.sum()
    error = np.hypot(ours.relative_error(), theirs.relative_error())
    print(
        f"| {name} | {ratio:.5f} | {error:.5f} | {whole[np.abs(whole).argmax()]:+.2f} | {scatter.max():+.2f} "
        f"| {z[tile, channel]:+.2f} (tile {tile}) | {'agrees' if agrees else 'DIFFERS'} |",
        flush=True,
    )
    return bool(agrees)


def store(given: argparse.Namespace) -> None:
    """Writes scenes, tile means and where they come from."""
    from mitsuba_side import VARIANT, mi

    STORE.mkdir(parents=True, exist_ok=True)
    rows = ["scene,tile,mean_r,mean_g,mean_b,variance_r,variance_g,variance_b"]
    for name in given.scenes:
        start = time.perf_counter()
        (STORE / f"{name}.toml").write_text(agreement.toml(name, "environment.exr"))
        tiles = mitsuba_tiles(name, given.pictures, given.spp)
        for i, (mean, variance) in enumerate(zip(tiles.mean, tiles.variance, strict=True)):
            rows.append(
                f"{name},{i}," + ",".join(f"{v:.6g}" for v in mean) + "," + ",".join(f"{v:.3g}" for v in variance)
            )
        print(f"{name}: {time.perf_counter() - start:.1f} s, standard error {tiles.relative_error():.5f}", flush=True)
    (STORE / "tiles.csv").write_text("\n".join(rows) + "\n")
    (STORE / "PROVENANCE.md").write_text(
        PROVENANCE.format(version=mi.__version__, variant=VARIANT, **vars(given), side=SIDE)
    )


PROVENANCE = """# Renders of Mitsuba 3, to compare with

Made by `python bench/validate.py --store --pictures {pictures} --spp {spp}` with Mitsuba {version}, variant {variant},
from the scenes of `bench/agreement.py`; `*.toml` are the same scenes for Lesk. {pictures} pictures of independent seeds,
{spp} samples per pixel each.

`tiles.csv`: per scene and tile of {side} x {side} pixels (row by row from the upper left) the mean of linear Rec.709 in
cd/m2 and the variance of that mean, from the scatter of the pictures. `environment.exr`, which scenes name, is not
stored: it is the closed form `radiance_of_map` of `bench/agreement.py` at the centres of 512 x 256 texels.
"""


if __name__ == "__main__":
    given = parse()
    if given.store:
        store(given)
    elif not compare(given):
        sys.exit("error: Lesk and Mitsuba differ by more than chance")
