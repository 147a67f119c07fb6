"""Exports a measured material's approximation to glTF: color, metallic, roughness and images.

The exporter of Blender 4.0 and newer reads node groups itself.
"""

from ..export.nodes import approximation_node


def fill(gltf_material, material, export_settings):
    """Fills in a material whose node group the exporter has not read."""
    node, pbr = approximation_node(material), gltf_material.pbr_metallic_roughness
    if node is None or pbr is None or pbr.base_color_factor or pbr.base_color_texture:
        return
    shader = next(each for each in node.node_tree.nodes if each.bl_idname == "ShaderNodeBsdfPrincipled")
    color, alpha = shader.inputs["Base Color"], shader.inputs["Alpha"]
    pbr.base_color_factor = [*(min(max(c, 0.0), 1.0) for c in _factor(color)), 1.0]
    pbr.metallic_factor = shader.inputs["Metallic"].default_value
    pbr.roughness_factor = shader.inputs["Roughness"].default_value
    pictured = tuple(socket for socket in (color, alpha) if socket.is_linked)
    if pictured:
        pbr.base_color_texture = _texture("gather_texture_info", pictured, export_settings)
    if shader.inputs["Normal"].is_linked:
        relief = (shader.inputs["Normal"],)
        gltf_material.normal_texture = _texture(
            "gather_material_normal_texture_info_class", relief, export_settings
        )


def _factor(color):
    """The factor on an image, or the color itself."""
    if color.is_linked:
        *_, color = (socket for socket in color.links[0].from_node.inputs if socket.enabled)
    return color.default_value[:3]


def _texture(gather, sockets, export_settings):
    from io_scene_gltf2.blender.exp import gltf2_blender_gather_texture_info as infos

    return getattr(infos, gather)(sockets[0], sockets, export_settings)[0]
