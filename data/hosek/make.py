"""Write the tables of Hosek and Wilkie's sky and sun from the header of their published code.

    python data/hosek/make.py ArHosekSkyModelData_Spectral.h

The header's lists are flat; this script gives every number its place and changes none.
"""

import pathlib
import re
import sys

FOLDER = pathlib.Path(__file__).parent
BANDS = range(320, 721, 40)
TURBIDITIES = range(1, 11)
PIECES = 45

text = re.sub(r"//.*", "", pathlib.Path(sys.argv[1]).read_text(encoding="latin-1"))


def numbers(name, count):
    """Give the list of this name in the header; another length is an error."""
    body = re.search(rf"double\s+{name}\[\]\s*=\s*\{{(.*?)\}}", text, re.DOTALL)[1]
    found = [float(word) for word in body.replace(",", " ").split()]
    if len(found) != count:
        raise SystemExit(f"{name} has {len(found)} numbers, {count} are expected")
    return found


def write(name, head, rows):
    """Write one table."""
    lines = [head] + [",".join(f"{value:.9g}" for value in row) for row in rows]
    (FOLDER / name).write_text("\n".join(lines) + "\n")


sky, sun, limb = [], [], []
for band in BANDS:
    shape = numbers(f"dataset{band}", 2 * 10 * 6 * 9)
    radiance = numbers(f"datasetRad{band}", 2 * 10 * 6)
    for i in range(2 * 10 * 6):
        albedo, turbidity, point = i // 60, TURBIDITIES[i // 6 % 10], i % 6
        sky.append([band, albedo, turbidity, point, *shape[9 * i : 9 * i + 9], radiance[i]])
    pieces = numbers(f"solarDataset{band}", 10 * PIECES * 4)
    for i in range(10 * PIECES):
        sun.append([band, TURBIDITIES[i // PIECES], i % PIECES, *pieces[4 * i : 4 * i + 4]])
    limb.append([band, *numbers(f"limbDarkeningDataset{band}", 6)])

write("sky.csv", "band_nm,albedo,turbidity,point,a,b,c,d,e,f,g,h,i,radiance", sky)
write("sun.csv", "band_nm,turbidity,piece,c3,c2,c1,c0", sun)
write("limb.csv", "band_nm,l0,l1,l2,l3,l4,l5", limb)
