"""Write the CIE's tables of observers, illuminants and test colours from colour-science.

    python -m venv venv && venv/bin/pip install colour-science==0.4.7 && venv/bin/python data/cie/make.py

The y function of 1931 is V(lambda) of 1924: the script refuses to write if the two tables differ.
Nine significant digits are all that the published tables have; more is noise of the lookup.
"""

import pathlib
import warnings

warnings.filterwarnings("ignore")
import colour  # noqa: E402
from colour.quality.datasets import SDS_TCS  # noqa: E402

FOLDER = pathlib.Path(__file__).parent
ILLUMINANTS = [
    *(f"FL{i}" for i in range(1, 13)),
    *(f"FL3.{i}" for i in range(1, 16)),
    *(f"HP{i}" for i in range(1, 6)),
    *(f"LED-{name}" for name in ("B1", "B2", "B3", "B4", "B5", "BH1", "RGB1", "V1", "V2")),
]


def write(name, columns, first, last, step):
    """Write one table: a column of wavelengths in nm, then one per spectrum."""
    rows = [",".join(["lambda_nm", *columns])]
    for nm in range(first, last + 1, step):
        rows.append(",".join([str(nm), *(f"{float(column(nm)):.9g}" for column in columns.values())]))
    (FOLDER / name).write_text("\n".join(rows) + "\n")


def of(spectrum):
    """Look up one wavelength; outside the table is an error."""
    shape = spectrum.shape

    def value(nm):
        if not shape.start <= nm <= shape.end:
            raise SystemExit(f"{spectrum.name} has no value at {nm} nm")
        return spectrum[float(nm)]

    return value


def observer(name):
    """The three functions of an observer."""
    functions = colour.MSDS_CMFS[name]
    return {axis: (lambda nm, i=i: functions[float(nm)][i]) for i, axis in enumerate("xyz")}


photopic = of(colour.colorimetry.SDS_LEFS_PHOTOPIC["CIE 1924 Photopic Standard Observer"])
scotopic = of(colour.colorimetry.SDS_LEFS_SCOTOPIC["CIE 1951 Scotopic Standard Observer"])
cie1931 = observer("CIE 1931 2 Degree Standard Observer")
for nm in range(360, 831):
    if abs(float(cie1931["y"](nm)) - float(photopic(nm))) > 1e-12:
        raise SystemExit(f"V and y differ at {nm} nm")

write("cie1931_2deg_1nm.csv", cie1931, 360, 830, 1)
write("cie1964_10deg_1nm.csv", observer("CIE 1964 10 Degree Standard Observer"), 360, 830, 1)
write("cie2006_2deg_1nm.csv", observer("CIE 2015 2 Degree Standard Observer"), 390, 830, 1)
write("cie2006_10deg_1nm.csv", observer("CIE 2015 10 Degree Standard Observer"), 390, 830, 1)
write("scotopic_1nm.csv", {"v": scotopic}, 380, 780, 1)
lamps = colour.SDS_ILLUMINANTS
write("illuminants_5nm.csv", {name: of(lamps[name]) for name in ILLUMINANTS}, 380, 780, 5)
basis = colour.colorimetry.SDS_BASIS_FUNCTIONS_CIE_ILLUMINANT_D_SERIES
write("daylight_5nm.csv", {name: of(basis[name]) for name in ("S0", "S1", "S2")}, 300, 830, 5)
samples = SDS_TCS["CIE 1995"]
write("test_colours_5nm.csv", {name: of(samples[name]) for name in samples}, 360, 830, 5)
