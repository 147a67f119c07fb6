"""Exports a measured material's approximation to glTF: color, metallic, roughness, coat, specular and images.

Exporters that read node groups themselves find no constants in them, since inputs of the group change all
values.
"""

import copy
import importlib

import bpy

from ..core.approximation_gltf import base_and_metallic, extensions
from ..core.approximation_uv import gltf_transform, nearest_step
from ..export.color import working_to_rec709
from ..export.nodes import approximation_node
from .approximation_image import TileImages, built_nodes, images_to_export
from .approximation_look import is_surface, shown

_TRANSFORM = "KHR_texture_transform"
# The exporter's module in Blender 3.6 and 4.0, and before. Newer ones read images in groups themselves.
_TEXTURE_INFOS = (
    "io_scene_gltf2.blender.exp.material.gltf2_blender_gather_texture_info",
    "io_scene_gltf2.blender.exp.gltf2_blender_gather_texture_info",
)


def fill(gltf_material, material, export_settings):
    """Replaces what the exporter has read of a measured material's node group."""
    pbr, values = gltf_material.pbr_metallic_roughness, shown(material)
    if values is None or pbr is None or not is_surface(material):
        return
    tree = approximation_node(material).node_tree
    writes_images = export_settings.get("gltf_image_format") != "NONE"
    pictures = images_to_export(material) if writes_images else TileImages()
    colors = {name: working_to_rec709(values.principled[name]) for name in ("base_color", "specular_tint")}
    principled = {**values.principled, **colors}
    base, pbr.metallic_factor = base_and_metallic(principled, working_to_rec709(values.diffuse))
    color = working_to_rec709(values.gain) if pictures.colors else base
    pbr.base_color_factor = [*(min(max(c, 0.0), 1.0) for c in color), 1.0]
    _extend(gltf_material, extensions(principled, values.diffuse))
    if pictures.colors:
        _fill_images(gltf_material, tree, pictures, export_settings)
        _place(gltf_material, material, values.placed)
    if not pictures.roughness:
        pbr.metallic_roughness_texture = None
    has_map = pbr.metallic_roughness_texture is not None
    pbr.roughness_factor = None if has_map else principled["roughness"]  # None: 1, times the map


def _extend(gltf_material, wanted):
    """Sets the coat and the specular reflection; images that the exporter has found for them stay."""
    from io_scene_gltf2.io.com.gltf2_io_extensions import Extension

    given = dict(gltf_material.extensions or {})
    for name in ("KHR_materials_clearcoat", "KHR_materials_specular"):
        found = given.pop(name, None)
        parts = found.extension if found else {}
        # The exporter sets texture coordinates of its images after this, also of a coat without a weight.
        values = {key: each for key, each in parts.items() if hasattr(each, "tex_coord")}
        values.update(wanted.get(name, {}))
        if values:
            given[name] = Extension(name, values, required=False)
    gltf_material.extensions = given


def _fill_images(gltf_material, tree, pictures, export_settings):
    """Adds the images that the exporter has not found."""
    pbr = gltf_material.pbr_metallic_roughness
    shader, *_others = built_nodes(tree, "ShaderNodeBsdfPrincipled")
    color, alpha = shader.inputs["Base Color"], shader.inputs["Alpha"]
    if not pbr.base_color_texture:
        pictured = (color, alpha) if alpha.is_linked else (color,)
        pbr.base_color_texture = _texture("gather_texture_info", pictured, export_settings)
    if pictures.roughness and not pbr.metallic_roughness_texture:
        rough = (shader.inputs["Roughness"],)
        pbr.metallic_roughness_texture = _texture("gather_texture_info", rough, export_settings)
    if pictures.normals and not gltf_material.normal_texture:
        relief = (shader.inputs["Normal"],)
        gltf_material.normal_texture = _texture(
            "gather_material_normal_texture_info_class", relief, export_settings
        )


def _texture(gather, sockets, export_settings):
    """The TextureInfo of images in the group; None: this exporter reads them itself, and has found none."""
    for name in _TEXTURE_INFOS:
        try:
            infos = importlib.import_module(name)
        except ModuleNotFoundError:
            continue
        return getattr(infos, gather)(sockets[0], sockets, export_settings)[0]
    return None


def _place(gltf_material, material, placed):
    """Places all images of a material, on the UV map that it names."""
    from io_scene_gltf2.io.com.gltf2_io_extensions import Extension

    step, is_exact = nearest_step(placed)
    if not is_exact:
        print(
            f"Velour: glTF cannot show tiles that are rotated and not square. Those of material"
            f" '{material.name}' are scaled to the nearest shape. Use equal repeats or no rotation.",
            flush=True,
        )
    transform, pbr = gltf_transform(step), gltf_material.pbr_metallic_roughness
    added = [each.extension for each in (gltf_material.extensions or {}).values()]
    for owner in (vars(pbr), vars(gltf_material), *added):
        for name, shared in owner.items():
            if not hasattr(shared, "tex_coord"):
                continue
            info = copy.copy(shared)  # the exporter may share it among materials of the same group
            given = info.extensions or {}
            info.extensions = {key: each for key, each in given.items() if key != _TRANSFORM}
            if transform:  # not required: viewers without it show the tiles unplaced rather than nothing
                info.extensions[_TRANSFORM] = Extension(_TRANSFORM, dict(transform), required=False)
            if placed.uv_map:
                info.tex_coord = _coordinates(material, placed.uv_map) or None
            owner[name] = info


def _coordinates(material, uv_map):
    """Index of the texture coordinates of a UV map, which is that of the first mesh with the material."""
    for mesh in bpy.data.meshes:
        if uv_map in mesh.uv_layers and any(each == material for each in mesh.materials):
            return mesh.uv_layers.find(uv_map)
    return 0
