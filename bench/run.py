"""Lesk and its peers, side by side in one run: `cargo xtask bench [--quick] [SECTION ...]`.

Ratios are what counts: A and B take turns on one pinned core, so what disturbs one disturbs the other. A ratio above 1
means that Lesk is faster; it stands beside the least that is accepted (must) and what is hoped for (aim).
"""

from __future__ import annotations

import argparse
import importlib
import platform
import sys
import time
from pathlib import Path

from table import Table, save
from timing import load_average, pin

ROOT = Path(__file__).resolve().parent.parent
SECTIONS = {
    "batch": "models through NumPy",
    "rays": "rays alone and 256 at once",
    "paths": "path tracing",
    "lux": "measuring an office",
    "raster": "rasterising",
    "memory": "ten million triangles",
}


def parse() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="about three minutes: smaller and fewer repetitions")
    parser.add_argument("--out", type=Path, default=ROOT / "out" / "bench.json", help="JSON of all rows")
    listed = "; ".join(f"{name}: {what}" for name, what in SECTIONS.items())
    parser.add_argument("sections", nargs="*", metavar="SECTION", help=f"{listed}; all where absent")
    given = parser.parse_args()
    for name in given.sections:
        if name not in SECTIONS:
            parser.error(f"there is no section `{name}`, but {', '.join(SECTIONS)}")
    given.sections = given.sections or list(SECTIONS)
    return given


def about() -> dict:
    """What the numbers depend on."""
    import mitsuba_side

    import lesk
    from lesk import _lesk

    return {
        "processor": processor(),
        "lesk": lesk.__version__,
        "instruction_set": _lesk.isa,
        "mitsuba": f"{mitsuba_side.mi.__version__} {mitsuba_side.VARIANT}",
        "load_at_start": load_average(),
    }


def processor() -> str:
    lines = Path("/proc/cpuinfo").read_text().splitlines() if Path("/proc/cpuinfo").exists() else []
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.processor() or platform.machine()


def main() -> None:
    given = parse()
    core = pin()
    facts = about() | {"core": core, "quick": given.quick}
    print("\n".join(f"{key}: {value}" for key, value in facts.items()))
    if facts["load_at_start"] > 1:
        print("note: other programs are running; trust the ratios, not the absolute numbers")
    tables: list[Table] = []
    for name in given.sections:
        start = time.perf_counter()
        found = importlib.import_module(name).run(given.quick)
        tables += found
        for table in found:
            print("\n" + table.markdown(), end="")
        print(f"\n({SECTIONS[name]}: {time.perf_counter() - start:.0f} s)", flush=True)
    save(given.out, facts, tables)
    below = [f"{row.what} {row.ratio:.2f} < {row.must}" for t in tables for row in t.rows if row.verdict() == "BELOW"]
    print(f"\n{len(below)} below `must`" + "".join(f"\n- {line}" for line in below))
    print(f"written: {given.out}")


if __name__ == "__main__":
    sys.exit(main())
