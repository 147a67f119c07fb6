"""Evaluated geometry as numpy arrays."""

import contextlib
import math

import bpy
import numpy as np

from ..core.mesh_arrays import MeshArrays
from ..core.projection import box_projection
from .corner_colors import corner_colors, has_attribute

# To ask each mesh for what it has not is slow.
_HAS_DOMAINS = "normals_domain" in bpy.types.Mesh.bl_rna.properties  # 4.1 and newer


def _own(_name, count, dtype):
    return np.empty(count, dtype)


def object_arrays(obj, uv_maps=(), colors=(), empty=_own, shows_uvs=False):
    """MeshArrays of an evaluated object; None where it has no face.

    `empty`: gives memory for a field, by its name, how many numbers and of which type.

    `uv_maps`: for each material slot, of which the last stands for all beyond, the UvMaps of its faces.
    Empty, or where there is none of a name: the one that renders. None: no texture coordinates, as on
    meshes without UV maps, but for slots that project. `colors`: likewise the CornerColors that they show.

    `shows_uvs`: where there are UV maps, the one that renders is there in any case: as the first set where
    `uv_maps` names none, else as the last.
    """
    if not _must_convert(obj):
        return mesh_arrays(obj.data, uv_maps, colors, empty, shows_uvs)
    with _mesh_of(obj) as mesh:
        return mesh_arrays(mesh, uv_maps, colors, empty, shows_uvs) if mesh else None


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
    """[triangles] The face of an evaluated object that each triangle of object_arrays() is a part of."""
    with _mesh_of(obj) as mesh:
        mesh.calc_loop_triangles()
        return _faces(mesh, len(mesh.loop_triangles))


def _must_convert(obj):
    """Only what is not a mesh yet, or is being edited, needs a copy."""
    return obj.type != "MESH" or obj.mode == "EDIT"


@contextlib.contextmanager
def _mesh_of(obj):
    convert = _must_convert(obj)
    try:
        yield obj.to_mesh() if convert else obj.data
    finally:
        if convert:
            obj.to_mesh_clear()


def mesh_arrays(mesh, uv_maps=(), colors=(), empty=_own, shows_uvs=False):
    """`mesh` in its local space, split into Blender's own triangles; None where it has no face."""
    mesh.calc_loop_triangles()
    count = len(mesh.loop_triangles)
    if count == 0:
        return None
    vertices, loops = mesh.vertices, mesh.loops
    corners = _fill(empty("triangles", 3 * count, np.uint32), mesh.loop_triangles, "loops")
    arrays = MeshArrays(
        _fill(empty("positions", 3 * len(vertices), np.float32), vertices, "co").reshape(-1, 3),
        corners.reshape(-1, 3),
        # What triangles say of vertices and materials they look up one by one, many times slower.
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
    """[triangles]; None: without an attribute that says otherwise all faces are of the first slot."""
    if len(mesh.materials) <= 1 and "material_index" not in mesh.attributes:
        return None
    of_faces = _read(mesh.polygons, "material_index", (len(mesh.polygons),), np.uint32)
    return np.take(of_faces, _faces(mesh, count), out=empty("material_slots", count, np.uint32))


def _faces(mesh, count):
    return _read(mesh.loop_triangles, "polygon_index", (count,), np.uint32)


def _read(collection, attribute, shape, dtype=np.float32):
    """Indices as uint32: what Blender calls unsigned is copied item by item into anything else."""
    return _fill(np.empty(math.prod(shape), dtype), collection, attribute).reshape(shape)


def _fill(values, collection, attribute):
    collection.foreach_get(attribute, values)
    return values


def _vectors(memory, collection):
    return _fill(memory, collection, "vector").reshape(-1, 3)


def _normals(mesh, count, empty):
    """corner_normals, vertex_normals and smooth: those of corners only where they differ.

    Blender gives normals to Python one by one, and there are many more corners than vertices. A flat face is
    shaded by the triangles that it is cut into, as in Cycles, but for auto smooth.
    """
    domain = mesh.normals_domain if _HAS_DOMAINS else None
    if domain == "CORNER":
        return _read(mesh.corner_normals, "vector", (len(mesh.loops), 3)), None, None
    if domain is None and mesh.use_auto_smooth:
        return _split_normals(mesh), None, None
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


def _smooth_faces(mesh, domain):
    """Whether some faces are, whether some are not, and [faces]; None: all are alike."""
    if domain is not None:
        return domain == "POINT", domain != "POINT", None
    faces = _read(mesh.polygons, "use_smooth", (len(mesh.polygons),), bool)
    seen = faces.tobytes()  # any() and all() of few take many times as long
    return b"\1" in seen, b"\0" in seen, faces


def _split_normals(mesh):
    mesh.calc_normals_split()
    normals = _read(mesh.loops, "normal", (len(mesh.loops), 3))
    mesh.free_normals_split()
    return normals


def _coordinates(mesh, arrays, uv_maps):
    """Sets of texture coordinates, [corners x 2] each, as far as materials look at them."""
    if not mesh.uv_layers:
        return {"corner_uvs": _projected(mesh, arrays, uv_maps)}
    corners = arrays.triangles
    # Beyond the last slot the last material shows.
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
        return arrays  # they are its first set
    shown = _layer_uvs(mesh, _rendered_layer(mesh))
    if uv_maps is None:
        return arrays._replace(corner_uvs=shown)
    others = [] if arrays.more_uvs is None else list(arrays.more_uvs)
    return arrays._replace(more_uvs=np.stack([*others, shown]))


def _projected(mesh, arrays, uv_maps):
    """[corners x 2] Of slots that project; None where none does."""
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
    """Of each slot its UV map; without a name, or where there is none of it, that which renders."""
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
