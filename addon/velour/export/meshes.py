"""Evaluated geometry as numpy arrays."""

import contextlib
import math
from typing import NamedTuple

import bpy
import numpy as np

from ..core.mesh_arrays import MeshArrays
from ..core.projection import box_projection
from .corner_colors import corner_colors, has_attribute

# Looking up a missing attribute on every mesh is slow.
_HAS_DOMAINS = "normals_domain" in bpy.types.Mesh.bl_rna.properties  # 4.1 and newer
# No property reveals it: whether Cycles takes normals of corners where smooth faces meet flat ones.
_SPLITS_AT_FACES = bpy.app.version >= (5, 0)


def _own(_name, count, dtype):
    return np.empty(count, dtype)


def object_arrays(obj, uv_maps=(), colors=(), empty=_own, shows_uvs=False):
    """MeshArrays of an evaluated object; None if it has no faces.

    `empty`: allocates a field, given its name, number of values and dtype.

    `uv_maps`: UvMaps of each material slot; the last one stands for all further slots. The active render map
    replaces missing ones, and is used if `uv_maps` is empty. None: no texture coordinates. Meshes without UV
    maps have none either, except for slots that project. `colors`: likewise the CornerColors of each slot.

    `shows_uvs`: always include the active render map, if there is one: as the first set if `uv_maps` names
    none, otherwise as the last.
    """
    if not _must_convert(obj):
        return mesh_arrays(obj.data, uv_maps, colors, empty, shows_uvs)
    with _mesh_of(obj) as mesh:
        return mesh_arrays(mesh, uv_maps, colors, empty, shows_uvs) if mesh else None


class Shape(NamedTuple):
    """The arrays of a mesh that change when it deforms."""

    positions: np.ndarray  # [vertices x 3]
    vertex_normals: np.ndarray | None  # [vertices x 3]
    corner_normals: np.ndarray | None  # [corners x 3]

    def fits(self, other):
        """Whether both have arrays of the same sizes."""
        return all(
            (a is None) == (b is None) and (a is None or a.shape == b.shape)
            for a, b in zip(self, other, strict=True)
        )


def object_shape(obj):
    """The Shape of an evaluated object; None if it has no faces."""
    with _mesh_of(obj) as mesh:
        if mesh is None or len(mesh.polygons) == 0:
            return None
        mesh.calc_loop_triangles()
        positions = _read(mesh.vertices, "co", (len(mesh.vertices), 3))
        corner_normals, vertex_normals, _ = _normals(mesh, len(mesh.loop_triangles), _own)
        return Shape(positions, vertex_normals, corner_normals)


def velocities(obj):
    """[vertices x 3] Velocities in units per second that the mesh of an evaluated object stores, or None.

    Liquids, caches and geometry nodes store them. Cycles then blurs by them instead of the mesh's shapes.
    """
    found = obj.data.attributes.get("velocity")
    if found is None or found.domain != "POINT" or found.data_type != "FLOAT_VECTOR":
        return None
    values = _read(found.data, "vector", (len(found.data), 3))
    return values if values.any() else None


def has_uv_map(obj, name):
    with _mesh_of(obj) as mesh:
        return mesh is not None and name in mesh.uv_layers


def has_uv_maps(obj):
    with _mesh_of(obj) as mesh:
        return mesh is not None and len(mesh.uv_layers) > 0


def has_colors(obj, asked):
    with _mesh_of(obj) as mesh:
        return mesh is not None and has_attribute(mesh, asked)


def triangle_faces(obj):
    """[triangles] Face index of each triangle that object_arrays() returns for an evaluated object."""
    with _mesh_of(obj) as mesh:
        mesh.calc_loop_triangles()
        return _faces(mesh, len(mesh.loop_triangles))


def _must_convert(obj):
    """Only objects of other types, and meshes in edit mode, need a converted copy.

    A mesh is in edit mode in all its objects if it is in one.
    """
    return obj.type != "MESH" or obj.mode == "EDIT" or obj.data.is_editmode


@contextlib.contextmanager
def _mesh_of(obj):
    convert = _must_convert(obj)
    try:
        yield obj.to_mesh() if convert else obj.data
    finally:
        if convert:
            obj.to_mesh_clear()


def mesh_arrays(mesh, uv_maps=(), colors=(), empty=_own, shows_uvs=False):
    """MeshArrays of `mesh` in local space, with Blender's own triangulation; None if it has no faces."""
    mesh.calc_loop_triangles()
    count = len(mesh.loop_triangles)
    if count == 0:
        return None
    vertices, loops = mesh.vertices, mesh.loops
    corners = _fill(empty("triangles", 3 * count, np.uint32), mesh.loop_triangles, "loops")
    arrays = MeshArrays(
        _fill(empty("positions", 3 * len(vertices), np.float32), vertices, "co").reshape(-1, 3),
        corners.reshape(-1, 3),
        # Reading vertices and materials from triangles looks them up one by one and is many times slower.
        _fill(empty("corner_vertices", len(loops), np.uint32), loops, "vertex_index"),
        _material_slots(mesh, count, empty),
        *_normals(mesh, count, empty),
    )
    if uv_maps is not None:
        arrays = arrays._replace(**_coordinates(mesh, arrays, uv_maps))
    if shows_uvs and mesh.uv_layers:
        arrays = _with_rendered_uvs(mesh, arrays, uv_maps)
    return arrays._replace(corner_colors=corner_colors(mesh, arrays, colors)) if colors else arrays


def _material_slots(mesh, count, empty):
    """[triangles]; None: all faces use the first slot, as there is no attribute."""
    if len(mesh.materials) <= 1 and "material_index" not in mesh.attributes:
        return None
    of_faces = _read(mesh.polygons, "material_index", (len(mesh.polygons),), np.uint32)
    return np.take(of_faces, _faces(mesh, count), out=empty("material_slots", count, np.uint32))


def _faces(mesh, count):
    return _read(mesh.loop_triangles, "polygon_index", (count,), np.uint32)


def _read(collection, attribute, shape, dtype=np.float32):
    """Reads an attribute. Use uint32 for indices: Blender copies them into any other type item by item."""
    return _fill(np.empty(math.prod(shape), dtype), collection, attribute).reshape(shape)


def _fill(values, collection, attribute):
    collection.foreach_get(attribute, values)
    return values


def _vectors(memory, collection):
    return _fill(memory, collection, "vector").reshape(-1, 3)


def _normals(mesh, count, empty):
    """corner_normals, vertex_normals and smooth; corner normals only if the corners of a vertex differ.

    Blender passes normals to Python one by one, and there are many more corners than vertices. Flat faces are
    shaded with the normals of their triangles, as in Cycles, except with auto smooth.
    """
    domain = _normals_domain(mesh)
    if domain == "CORNER":
        if not _HAS_DOMAINS:
            return _split_normals(mesh), None, None
        return _read(mesh.corner_normals, "vector", (len(mesh.loops), 3)), None, None
    some_smooth, some_flat, faces = _smooth_faces(mesh, domain)
    of_vertices = smooth = None
    if some_smooth:
        memory = empty("vertex_normals", 3 * len(mesh.vertices), np.float32)
        of_vertices = _vectors(memory, mesh.vertex_normals)
    if some_flat:
        smooth = empty("smooth", count, np.uint8)
        if some_smooth:
            np.take(faces.view(np.uint8), _faces(mesh, count), out=smooth)
        else:
            smooth.fill(0)
    return None, of_vertices, smooth


def _normals_domain(mesh):
    """Where Cycles reads normals: CORNER, POINT, FACE; None: each face is smooth or flat.

    Cycles does not use custom normals of faces.
    """
    if not _HAS_DOMAINS:
        return "CORNER" if mesh.use_auto_smooth else None
    domain, is_custom = mesh.normals_domain, mesh.has_custom_normals
    if domain == "CORNER":
        return domain if is_custom or _SPLITS_AT_FACES or _has_sharp_edges(mesh) else None
    # Smooth faces may have custom normals of another kind, or only sharp edges.
    return None if (is_custom or domain == "FACE") and "sharp_face" in mesh.attributes else domain


def _has_sharp_edges(mesh):
    sharp = mesh.attributes.get("sharp_edge")
    return sharp is not None and bool(_read(sharp.data, "value", (len(mesh.edges),), bool).any())


def _smooth_faces(mesh, domain):
    """Whether some faces are smooth, whether some are flat, and [faces] of bool; None: all are alike."""
    if domain is not None:
        return domain == "POINT", domain != "POINT", None
    faces = _read(mesh.polygons, "use_smooth", (len(mesh.polygons),), bool)
    seen = faces.tobytes()  # any() and all() are many times slower for few faces
    return b"\1" in seen, b"\0" in seen, faces


def _split_normals(mesh):
    mesh.calc_normals_split()
    normals = _read(mesh.loops, "normal", (len(mesh.loops), 3))
    mesh.free_normals_split()
    return normals


def _coordinates(mesh, arrays, uv_maps):
    """Sets of texture coordinates that materials use, [corners x 2] each."""
    if not mesh.uv_layers:
        return {"corner_uvs": _projected(mesh, arrays, uv_maps)}
    corners = arrays.triangles
    # Slots beyond the last use the last material.
    shown = np.minimum(arrays.slots, len(uv_maps) - 1) if len(uv_maps) > 1 else None

    def uvs(names):
        return _corner_uvs(mesh, corners, shown, names)

    found = {"corner_uvs": uvs([maps.first for maps in uv_maps])}
    count = max((len(maps.names) for maps in uv_maps), default=1)
    if count > 1:
        sets = [
            [maps.names[i] if i < len(maps.names) else maps.first for maps in uv_maps]
            for i in range(1, count)
        ]
        found["more_uvs"] = np.stack([uvs(names) for names in sets])
    if any(maps.relief is not None for maps in uv_maps):
        found["relief_uvs"] = uvs([maps.first if maps.relief is None else maps.relief for maps in uv_maps])
    return found


def _with_rendered_uvs(mesh, arrays, uv_maps):
    if uv_maps is not None and not uv_maps:
        return arrays  # already the first set
    shown = _layer_uvs(mesh, _rendered_layer(mesh))
    if uv_maps is None:
        return arrays._replace(corner_uvs=shown)
    others = [] if arrays.more_uvs is None else list(arrays.more_uvs)
    return arrays._replace(more_uvs=np.stack([*others, shown]))


def _projected(mesh, arrays, uv_maps):
    """[corners x 2] Box projection for the slots that project; None if none does."""
    projects = np.array([maps.projects for maps in uv_maps], bool)
    if not projects.any():
        return None
    faces = np.empty(len(arrays.corner_vertices), np.uint32)
    faces[arrays.triangles] = _faces(mesh, len(arrays.triangles))[:, None]
    normals = _read(mesh.polygon_normals, "vector", (len(mesh.polygons), 3))
    uvs = box_projection(arrays.positions[arrays.corner_vertices], normals[faces])
    uvs[arrays.triangles[~projects[np.minimum(arrays.slots, len(projects) - 1)]]] = 0
    return uvs


def _corner_uvs(mesh, corners, shown, names):
    """[corners x 2] UV map of each slot; the active render map if it is unnamed or missing."""
    rendered = _rendered_layer(mesh)
    layers = [mesh.uv_layers.get(name) or rendered if name else rendered for name in names] or [rendered]
    uvs = _layer_uvs(mesh, layers[0])
    for slot, layer in enumerate(layers[1:], 1):
        if layer != layers[0]:
            of_slot = corners[shown == slot]
            uvs[of_slot] = _layer_uvs(mesh, layer)[of_slot]
    return uvs


def _rendered_layer(mesh):
    return next((layer for layer in mesh.uv_layers if layer.active_render), mesh.uv_layers[0])


def _layer_uvs(mesh, layer):
    return _read(layer.data, "uv", (len(mesh.loops), 2))
