"""Wavefront OBJ, with its materials in an MTL file beside it."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np

from ..native.tile import TileMesh
from . import files


def write_obj(path: str | os.PathLike, mesh: TileMesh, materials: list[dict]) -> None:
    """`materials`, written to NAME.mtl, by slot: name, base_color (linear Rec. 709), metallic, roughness."""
    path = Path(path)
    library = path.with_suffix(".mtl")
    files.write_text(library, "".join(map(_material_text, materials)))
    files.write_text(path, _mesh_text(mesh, [_word(m["name"]) for m in materials], library.name))


def _mesh_text(mesh: TileMesh, names: list[str], library: str) -> str:
    uvs, uv_numbers = np.unique(mesh.corner_uvs.reshape(-1, 2), axis=0, return_inverse=True)
    normals, normal_numbers = np.unique(mesh.corner_normals.reshape(-1, 3), axis=0, return_inverse=True)
    corners = np.stack(
        [mesh.triangles.astype(np.int64), uv_numbers.reshape(-1, 3), normal_numbers.reshape(-1, 3)], axis=-1
    )
    lines = [f"mtllib {library}"]
    for key, rows in (("v", mesh.positions), ("vt", uvs), ("vn", normals)):
        lines += [" ".join([key, *(f"{x:.9g}" for x in row)]) for row in rows]
    for slot, name in enumerate(names):
        lines.append(f"usemtl {name}")
        for face in corners[mesh.material_slots == slot] + 1:
            lines.append("f " + " ".join("/".join(map(str, corner)) for corner in face))
    return "\n".join(lines) + "\n"


def _material_text(material: dict) -> str:
    color = " ".join(f"{c:.6g}" for c in material["base_color"])
    return (
        f"newmtl {_word(material['name'])}\nKd {color}\n"
        f"Pr {material['roughness']:.6g}\nPm {material['metallic']:.6g}\n"
    )


def _word(name: str) -> str:
    """Names in OBJ end at a blank."""
    return name.replace(" ", "_")
