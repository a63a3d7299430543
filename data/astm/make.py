"""Write the reference spectra of sunlight of ASTM G173-03 from pvlib.

    python -m venv venv && venv/bin/pip install pvlib==0.16.1 && venv/bin/python data/astm/make.py

The script refuses to write if the integrals miss those that the standard's table is known by (W/m2, trapezoid rule):
1347.93 above the atmosphere to 4 um, 1000.37 on the tilted plane, 900.14 direct.
"""

import importlib.util
import itertools
import pathlib

PACKAGE = pathlib.Path(importlib.util.find_spec("pvlib").origin).parent
COLUMNS = {"extraterrestrial": ("AM0", 1347.93), "global": ("AM1.5G", 1000.37), "direct": ("AM1.5D", 900.14)}

lines = (PACKAGE / "data" / "ASTMG173.csv").read_text().splitlines()
head = lines[1].split(",")
rows = [[float(number) for number in line.split(",")] for line in lines[2:]]
for source, (name, known) in COLUMNS.items():
    column = head.index(source)
    total = sum((b[0] - a[0]) * (a[column] + b[column]) / 2 for a, b in itertools.pairwise(rows))
    if abs(total - known) > 0.005:
        raise SystemExit(f"{name} integrates to {total} W/m2 instead of {known}")
places = [head.index(source) for source in COLUMNS]
text = [",".join(["lambda_nm", *(name for name, _ in COLUMNS.values())])]
text += [",".join(f"{row[place]:.9g}" for place in (0, *places)) for row in rows]
pathlib.Path(__file__).with_name("g173.csv").write_text("\n".join(text) + "\n")
