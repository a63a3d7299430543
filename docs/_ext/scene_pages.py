"""The reference of scene files, written from the JSON Schema, which is made from the table that the reader checks."""

from pathlib import Path

from model_pages import table

import lesk

# headings of the tables, in the order in which an author meets them
CHAPTERS = {
    "camera": "[camera]",
    "film": "[film]",
    "render": "[render]",
    "raster": "[raster]",
    "materials": "[materials.NAME]",
    "objects": "[[objects]]",
    "groups": "[groups.NAME]",
    "lights": "[[lights]]",
    "environment": "[environment]",
    "sensors": "[[sensors]]",
    "measure": "[measure]",
}


def accepted(value):
    """What a key accepts, in words."""
    if "const" in value:
        return f"`{value['const']}`"
    if "enum" in value:
        return ", ".join(f"`{word}`" for word in value["enum"])
    if "$ref" in value:
        return {"step": "a step", "texture": "a picture"}.get(value["$ref"].rsplit("/", 1)[1], "a table")
    if "anyOf" in value:
        return " or ".join(dict.fromkeys(accepted(one) for one in value["anyOf"]))
    kind = value.get("type")
    if kind == "string":
        examples = [f'`"{text}"`' for text in value.get("examples", [])]
        return "a quantity like " + ", ".join(examples) if examples else "text"
    if kind in ("number", "integer"):
        return limits(kind, value)
    if kind == "boolean":
        return "`true`, `false`"
    if kind == "array":
        return listed(value)
    return "a table"


def limits(kind, value):
    """A number with its range."""
    low, high = value.get("minimum"), value.get("maximum")
    article = "an integer" if kind == "integer" else "a number"
    # borders that only keep files sane say nothing to an author
    low = None if low is not None and abs(low) > 1e6 else low
    high = None if high is not None and abs(high) > 1e8 else high
    if low is not None and 0 < low < 1e-30:
        return f"{article} above 0" + ("" if high is None else f", up to {high:g}")
    if low is not None and high is not None:
        return f"`{low:g}`" if low == high else f"{article}, {low:g} to {high:g}"
    if low is not None:
        return f"{article} from {low:g} on"
    return article if high is None else f"{article} up to {high:g}"


def listed(value):
    """A list with its length."""
    items, count = value.get("items", {}), value.get("minItems")
    if count is not None and items.get("type") == "array":
        return f"{count} lists of {items['minItems']} numbers"
    if count is not None and items.get("type") in ("number", "integer"):
        return f"{count} {'integers' if items['type'] == 'integer' else 'numbers'}"
    if "enum" in items:
        return "a list of " + accepted(items)
    return "a list of steps" if "$ref" in items else "a list of tables"


def rows(section, skip=()):
    """One row per key: name, what it accepts, meaning."""
    required = section.get("required", [])
    for name, value in section["properties"].items():
        if name not in skip:
            needed = ", required" if name in required else ""
            yield f"`{name}`", accepted(value) + needed, value.get("description", "")


def keys(section, skip=()):
    """The table of a section, and one for every table in it that has no chapter."""
    text = table(["key", "accepts", "meaning"], rows(section, skip))
    for name, value in section["properties"].items():
        if name not in skip and value.get("type") == "object" and "properties" in value:
            text += f"\n`{name}` has these keys:\n\n" + table(["key", "accepts", "meaning"], rows(value))
    return text


def variants(cases, tag):
    """Keys that all variants have, then those of each."""
    common = set.intersection(*(set(case["properties"]) for case in cases)) - {tag}
    shared = {**cases[0], "properties": {k: v for k, v in cases[0]["properties"].items() if k in common}}
    words = ", ".join(f"`{case['properties'][tag]['const']}`" for case in cases)
    text = f"`{tag}` is one of {words}.\n"
    if common:
        text += "\n" + keys(shared)
    for case in cases:
        own = [row for row in rows(case, common | {tag})]
        if own:
            text += f'\n`{tag} = "{case["properties"][tag]["const"]}"`:\n\n' + table(["key", "accepts", "meaning"], own)
    return text


def chapter(name, value, definitions):
    """What stands under a key of the file."""
    if name == "materials":
        cases = definitions["material"]["oneOf"]
        common = set.intersection(*(set(case["properties"]) for case in cases)) - {"model"}
        first = {**cases[0], "properties": {k: v for k, v in cases[0]["properties"].items() if k in common}}
        return (
            "`model` is the name of a [model](models/index.md); its parameters are keys, each a number, three numbers for "
            "a colour, or a picture.\n\n"
            + keys(first)
            + "\nA picture on a parameter has these keys; the value is texel times `scale` plus `offset`, clamped to the "
            "legal range:\n\n" + keys(definitions["texture"])
        )
    if name == "groups":
        return f'{keys(value["additionalProperties"])}\nAn object with `shape = "group"` places it.\n'
    if name == "objects":
        steps = keys(definitions["step"])
        return (
            variants(definitions["object"]["oneOf"], "shape")
            + "\nA step of `transform` has exactly one of these keys (`axis` goes with `rotate`):\n\n"
            + steps
        )
    if name in ("lights", "sensors"):
        return variants(value["items"]["oneOf"], "type")
    if "oneOf" in value:
        return variants(value["oneOf"], "type")
    return keys(value)


def reference(schema):
    """The whole reference."""
    root = schema["properties"]
    if missing := root.keys() - CHAPTERS.keys() - {"version", "title"}:
        raise KeyError(f"no chapter is written for {sorted(missing)}")
    top = {**schema, "properties": {name: root[name] for name in ("version", "title")}}
    text = keys(top)
    for name, heading in CHAPTERS.items():
        body = chapter(name, root[name], schema["$defs"])
        text += f"\n### `{heading}`\n\n{root[name].get('description', '')}\n\n{body}"
    return text


def write(path):
    """Write the reference, if it changed."""
    text = reference(lesk.scene.schema())
    path.parent.mkdir(exist_ok=True)
    if not path.exists() or path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8")


def setup(app):
    """Write the reference when the build starts."""
    app.connect("builder-inited", lambda app: write(Path(app.srcdir) / "generated" / "scene_reference.txt"))
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
