"""Write the CIE 1931 2 degree observer, 360 to 830 nm at 1 nm, from colour-science.

    python -m venv venv && venv/bin/pip install colour-science==0.4.7 && venv/bin/python data/cie/make.py

The y function is V(lambda) of 1924: the script refuses to write if the two tables differ.
Nine significant digits are all that the published table has; more is noise of the lookup.
"""

import pathlib
import warnings

warnings.filterwarnings("ignore")
import colour  # noqa: E402

FUNCTIONS = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"]
PHOTOPIC = colour.colorimetry.SDS_LEFS_PHOTOPIC["CIE 1924 Photopic Standard Observer"]

rows = ["lambda_nm,x,y,z"]
for nm in range(360, 831):
    x, y, z = (float(v) for v in FUNCTIONS[float(nm)])
    if abs(y - float(PHOTOPIC[float(nm)])) > 1e-12:
        raise SystemExit(f"V and y differ at {nm} nm")
    rows.append(f"{nm},{x:.9g},{y:.9g},{z:.9g}")

pathlib.Path(__file__).with_name("cie1931_2deg_1nm.csv").write_text("\n".join(rows) + "\n")
