"""Write the colour map viridis, 256 sRGB-encoded colours, from matplotlib.

python -m venv venv && venv/bin/pip install matplotlib && venv/bin/python data/colormaps/make.py
"""

import pathlib

import matplotlib

rows = ["r,g,b"]
rows += [",".join(f"{v:.6f}" for v in rgb) for rgb in matplotlib.colormaps["viridis"].colors]
pathlib.Path(__file__).with_name("viridis.csv").write_text("\n".join(rows) + "\n")
