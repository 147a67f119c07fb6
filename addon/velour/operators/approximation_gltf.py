"""Exports a measured material's approximation to glTF: color, metallic, roughness and images.

Exporters that read node groups themselves find no constants in them, since inputs of the group change all
values.
"""

from ..export.nodes import approximation_node
from .approximation_image import images_of
from .approximation_look import is_surface, shown


def fill(gltf_material, material, export_settings):
    """Replaces what the exporter has read of a measured material's node group."""
    pbr, values = gltf_material.pbr_metallic_roughness, shown(material)
    if values is None or pbr is None or not is_surface(material):
        return
    tree = approximation_node(material).node_tree
    pictures = images_of(tree)
    factor = values.gain if pictures.colors else values.principled["base_color"]
    pbr.base_color_factor = [*(min(max(c, 0.0), 1.0) for c in factor), 1.0]
    pbr.metallic_factor = values.principled["metallic"]
    pbr.roughness_factor = values.principled["roughness"]
    if not pictures.colors:
        return
    shader = next(each for each in tree.nodes if each.bl_idname == "ShaderNodeBsdfPrincipled")
    color, alpha = shader.inputs["Base Color"], shader.inputs["Alpha"]
    if not pbr.base_color_texture:
        pictured = (color, alpha) if alpha.is_linked else (color,)
        pbr.base_color_texture = _texture("gather_texture_info", pictured, export_settings)
    if pictures.normals and not gltf_material.normal_texture:
        relief = (shader.inputs["Normal"],)
        gltf_material.normal_texture = _texture(
            "gather_material_normal_texture_info_class", relief, export_settings
        )


def _texture(gather, sockets, export_settings):
    from io_scene_gltf2.blender.exp import gltf2_blender_gather_texture_info as infos

    return getattr(infos, gather)(sockets[0], sockets, export_settings)[0]
