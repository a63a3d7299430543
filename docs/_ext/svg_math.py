"""Formulas as SVG, drawn while building: readable offline, without a script or a font."""

import xml.etree.ElementTree as ET

import ziamath
from docutils import nodes

# pixels; the text of the theme is 16 px
INLINE_SIZE = 17.6
DISPLAY_SIZE = 19.2

# a path per glyph: identifiers of shared glyphs would clash between formulas of a page
ziamath.config.svg2 = False
ziamath.config.precision = 2


def draw(latex, *, display):
    """Draw a formula.

    Parameters
    ----------
    latex : str
        The formula, without dollar signs.
    display : bool
        Whether it stands on a line of its own.

    Returns
    -------
    str
        An `svg` element whose baseline is that of the text, labelled with its source.

    """
    size = DISPLAY_SIZE if display else INLINE_SIZE
    formula = ziamath.Latex(latex, size=size, color="currentColor", inline=not display)
    svg = formula.svgxml()
    svg.set("class", "formula")
    svg.set("role", "img")
    svg.set("aria-label", " ".join(latex.split()))
    if not display:
        svg.set("style", f"vertical-align: {formula.getyofst():.2f}px")
    return ET.tostring(svg, encoding="unicode")


def visit_inline(translator, node):
    """Write a formula of a line of text."""
    translator.body.append(draw(node.astext(), display=False))
    raise nodes.SkipNode


def visit_display(translator, node):
    """Write a formula that stands alone, with its number where it has one."""
    number = node.get("number")
    label = f'<span class="number">({number})</span>' if number else ""
    identifier = f' id="{node["ids"][0]}"' if node.get("ids") else ""
    svg = draw(node.astext(), display=True)
    translator.body.append(f'<div class="formula"{identifier}>{label}{svg}</div>\n')
    raise nodes.SkipNode


def setup(app):
    """Register the renderer `svg`."""
    app.add_html_math_renderer("svg", (visit_inline, None), (visit_display, None))
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
