"""`lesk mesh`: what there is in a mesh file."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from lesk import mesh
from lesk.cli._run import Json, emit


def main(
    file: Annotated[Path, typer.Argument(help="An OBJ, PLY, glTF or GLB file.")],
    crease_angle: Annotated[
        float | None, typer.Option(help="Edges with a larger angle between their faces are real, degrees.")
    ] = None,
    output: Annotated[Path | None, typer.Option("-o", "--output", help="Picture of the edges: .svg or .png.")] = None,
    azimuth: Annotated[float, typer.Option(help="From where the picture looks, degrees around z from -y.")] = 35.0,
    elevation: Annotated[float, typer.Option(help="How far above the horizon, degrees.")] = 25.0,
    json: Json = False,
) -> int:
    """Count faces, edges by kind, places that are not manifold, and normals that disagree with their faces.

    Edges are as stored (smoothing groups, normals) or by the crease angle; 30 degrees where nothing is stored.
    JSON: `file`, `meshes`, `warnings`; lengths in metres, angles in degrees.
    """
    facts = mesh.report(file, crease_angle_deg=crease_angle)
    if output is not None:
        mesh.draw(file, output, crease_angle_deg=crease_angle, azimuth_deg=azimuth, elevation_deg=elevation)
    if json:
        emit({"file": str(file), **facts})
        return 0
    for one in facts["meshes"]:
        print("\n".join(lines(one)))
    for warning in facts["warnings"]:
        print(f"note: {warning}")
    return 0


def lines(one: dict[str, Any]) -> list[str]:
    """Describe one mesh."""
    corners = ", ".join(f"{count} with {n}" for n, count in one["faces_by_corners"].items())
    kinds = ", ".join(f"{count} {kind.replace('_', '-')}" for kind, count in one["edges"].items())
    out = [
        f"{one['name'] or 'mesh'}: {'closed' if one['closed'] else 'open'}, area {one['area_m2']:.6g} m²",
        f"  faces      {one['faces']} ({corners} corners), {one['triangles']} triangles",
        f"  positions  {one['positions']}",
        f"  edges      {sum(one['edges'].values())}: {kinds}",
    ]
    if one["stated_normals"]:
        out.append(
            f"  normals    {one['stated_normals']} stated, {one['opposed_normals']} point to the back of their face, "
            f"largest angle to a face {one['largest_deviation_deg']:.3g} deg"
        )
    else:
        out.append("  normals    none stated")
    for key, what in (
        ("degenerate_faces", "faces without area"),
        ("bent_faces", "faces that are not flat"),
        ("twisted_edges", "edges whose faces wind against each other"),
        ("pinched_vertices", "vertices at which separate fans of faces touch"),
    ):
        if one[key]:
            out.append(f"  note       {one[key]} {what}")
    places = [f"({a[0]:.6g}, {a[1]:.6g}, {a[2]:.6g})" for a in one["pinched_at"][:3]]
    places += [
        f"({a[0]:.6g}, {a[1]:.6g}, {a[2]:.6g}) to ({b[0]:.6g}, {b[1]:.6g}, {b[2]:.6g})"
        for a, b in one["non_manifold_at"][:3]
    ]
    if places:
        out.append(f"  not manifold at {'; '.join(places)}{' ...' if len(places) >= 3 else ''}")
    return out
