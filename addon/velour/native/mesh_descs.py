"""Structs that describe meshes to the library; the arrays of all meshes lie back to back."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from . import structs
from .arrays import address, checked
from .errors import refuse

# Arrays of Scene.add_mesh: type, element (c and k: corner, t: triangle, v: vertex), shape per element.
MESH_ARRAYS = {
    "positions": (np.float32, "v", (3,)),
    "triangles": (np.uint32, "t", (3,)),
    "corner_normals": (np.float32, "c", (3,)),
    "corner_uvs": (np.float32, "c", (2,)),
    "more_uvs": (np.float32, "c", (2,)),
    "relief_uvs": (np.float32, "c", (2,)),
    "corner_colors": (np.float32, "c", (3,)),
    "material_slots": (np.uint32, "t", ()),
    "smooth": (np.uint8, "t", ()),
    "corner_vertices": (np.uint32, "k", ()),
    "vertex_normals": (np.float32, "v", (3,)),
    "moved_positions": (np.float32, "v", (3,)),
    "moved_corner_normals": (np.float32, "c", (3,)),
    "moved_vertex_normals": (np.float32, "v", (3,)),
}


def checked_mesh(arrays: Mapping[str, np.ndarray]) -> dict[str, tuple[np.ndarray, list[int]]]:
    """Converts the arguments of Scene.add_mesh to those of Scene.add_meshes for one mesh."""
    if unknown := arrays.keys() - MESH_ARRAYS.keys():
        raise refuse(f"Meshes have no array {min(unknown)!r}; the arrays are {', '.join(MESH_ARRAYS)}.")
    corners = (None, 3) if arrays.get("corner_vertices") is None else (None,)
    found = {}
    for name, array in arrays.items():
        if array is not None:
            dtype, size, rest = MESH_ARRAYS[name]
            lengths = corners if size == "c" else (None,)
            sets = (None,) if name in _SETS else ()
            checked(name, array, (*sets, *lengths, *rest), dtype)
            found[name] = (array.reshape(-1), [array.size])
    return found


def mesh_descs(meshes: Mapping[str, tuple]) -> np.ndarray:
    """vlr_mesh_descs [n] of the arguments of Scene.add_meshes, which must outlive them."""
    for name in ("positions", "triangles"):
        if name not in meshes:
            raise refuse(f"The mesh has no {name}; they are required.")
    sizes = {name: np.asarray(each, np.int64) for name, (_, each) in meshes.items()}
    descs = np.zeros(len(sizes["positions"]), structs.MeshDesc)
    counts = _counts(sizes, len(descs))
    descs["struct_size"] = descs.itemsize
    for name, field in _COUNT_FIELDS.items():
        descs[field] = counts[name]
    for name, (joined, _) in meshes.items():
        checked(name, joined, (int(sizes[name].sum()),), MESH_ARRAYS[name][0])
        ends = joined.itemsize * np.cumsum(sizes[name])
        places = address(joined) + (ends - joined.itemsize * sizes[name]).astype(np.uint64)
        must = name in ("positions", "triangles")
        descs[name] = places if must else np.where(sizes[name] > 0, places, 0)
    return descs


_COUNT_FIELDS = {
    "v": "vertex_count",
    "t": "triangle_count",
    "k": "corner_count",
    "more_uvs": "more_uv_sets",
    "corner_colors": "color_sets",
    "moved_positions": "steps",
}
_MOVED = ("moved_positions", "moved_corner_normals", "moved_vertex_normals")
_SETS = ("more_uvs", "corner_colors", *_MOVED)  # arrays with several sets, back to back


def _counts(sizes, meshes):
    """Numbers of elements of each kind, [n]. Refuses sizes that do not agree."""
    none = np.zeros(meshes, np.int64)
    counts = {
        "v": sizes["positions"] // 3,
        "t": sizes["triangles"] // 3,
        "k": sizes.get("corner_vertices", none),
    }
    counts["c"] = np.where(counts["k"] > 0, counts["k"], 3 * counts["t"])
    for name in _SETS:
        of_set = counts[MESH_ARRAYS[name][1]] * int(np.prod(MESH_ARRAYS[name][2]))
        counts[name] = sizes.get(name, none) // np.maximum(of_set, 1)
    counts |= {name: counts["moved_positions"] for name in _MOVED}
    for name, size in sizes.items():
        _, kind, rest = MESH_ARRAYS[name]
        wanted = counts[kind] * int(np.prod(rest)) * (counts[name] if name in _SETS else 1)
        wrong = np.flatnonzero((size != wanted) & (size > 0))
        if len(wrong):
            raise refuse(f"{name} has {size[wrong[0]]} numbers; {wanted[wrong[0]]} are needed.")
    return counts
