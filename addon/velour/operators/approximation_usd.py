"""Exports a measured material's approximation to USD as a UsdPreviewSurface.

Blender's exporter does not read node groups, and writes a material without a surface.
"""

import numpy as np

from ..core.approximation_uv import chain
from ..export.color import working_to_rec709
from ..export.nodes import approximation_node
from .approximation_image import images_to_export, shows_behind
from .approximation_look import is_surface, shown
from .materialx_usd import READER as MATERIALX_READER
from .usd_nodes import add, coordinate_name, exported, value_type

_READER = "Velour_UV"
_READERS = {_READER: "varname", MATERIALX_READER: "geomprop"}  # names of prims and of their inputs


def write(context, material, usd_material):
    """Writes into a material that has no surface yet; a surface of the user's own, or of Solid mode, stays.

    context: Blender's export context. Returns whether anything was written.
    """
    values = shown(material) if material.node_tree else None
    if values is None or not is_surface(material) or _has_surface(usd_material):
        return False
    tree = approximation_node(material).node_tree
    shader = add(usd_material, "Velour_Approximation", "UsdPreviewSurface")
    for name, (kind, value) in _inputs(values).items():
        shader.CreateInput(name, value_type(kind)).Set(value)
    pictures = images_to_export(material)
    if pictures.colors:
        _write_images(context, usd_material, shader, tree, values, pictures)
    output = shader.CreateOutput("surface", value_type("Token"))
    usd_material.CreateSurfaceOutput().ConnectToSource(output)
    return True


def choose_uvs(stage):
    """Sets names of texture coordinates to those of the meshes, since the export may rename active ones."""
    from pxr import Usd, UsdShade

    for prim in Usd.PrimRange(stage.GetPseudoRoot()):
        readers = [
            (prim.GetChild(name), key) for name, key in _READERS.items() if prim.IsA(UsdShade.Material)
        ]
        names = _uv_names(stage, prim.GetPath()) if any(reader for reader, _key in readers) else []
        for reader, key in readers:
            wanted = UsdShade.Shader(reader).GetInput(key) if reader else None
            if names and wanted and wanted.Get() not in names:
                wanted.Set("st" if "st" in names else names[0])


def _has_surface(usd_material):
    return bool(usd_material.GetSurfaceOutput()) and usd_material.GetSurfaceOutput().HasConnectedSource()


def _inputs(values):
    """Constant inputs of the preview surface: type and value by name."""
    principled = values.principled
    color = working_to_rec709(principled["base_color"])
    inputs = {
        "diffuseColor": ("Color3f", color),
        "metallic": ("Float", principled["metallic"]),
        "roughness": ("Float", principled["roughness"]),
        "ior": ("Float", _ior(principled["specular"])),
        "clearcoat": ("Float", principled["coat"]),
        "clearcoatRoughness": ("Float", principled["coat_roughness"]),
    }
    if max(values.diffuse) > 0:  # sum of a metal and a diffuse surface: only this workflow supports both
        del inputs["metallic"], inputs["ior"]
        inputs["useSpecularWorkflow"] = ("Int", 1)
        inputs["specularColor"] = ("Color3f", color)
        inputs["diffuseColor"] = ("Color3f", working_to_rec709(values.diffuse))
    return inputs


def _ior(level):
    """IOR of a dielectric with the normal-incidence reflectance of Blender's specular level."""
    f0 = np.sqrt(min(max(0.08 * level, 0.0), 0.99))
    return float((1 + f0) / (1 - f0))


def _write_images(context, usd_material, shader, tree, values, pictures):
    def texture_of(name, image, color_space, scale):
        texture = add(usd_material, name, "UsdUVTexture")
        texture.CreateInput("file", value_type("Asset")).Set(exported(context, image))
        texture.CreateInput("sourceColorSpace", value_type("Token")).Set(color_space)
        for wrap in ("wrapS", "wrapT"):
            texture.CreateInput(wrap, value_type("Token")).Set("repeat")
        texture.CreateInput("scale", value_type("Float4")).Set((*scale, 1.0))
        texture.CreateInput("st", value_type("Float2")).ConnectToSource(uvs)
        return texture, texture.CreateOutput("rgb", value_type("Float3"))

    uvs = _write_uvs(usd_material, values.placed)
    texture, color = texture_of("Velour_Color", pictures.colors, "sRGB", working_to_rec709(values.gain))
    shader.CreateInput("diffuseColor", value_type("Color3f")).ConnectToSource(color)
    if shows_behind(tree):
        alpha = texture.CreateOutput("a", value_type("Float"))
        shader.CreateInput("opacity", value_type("Float")).ConnectToSource(alpha)
    if pictures.roughness:
        texture, _rgb = texture_of("Velour_Roughness", pictures.roughness, "raw", (1.0, 1.0, 1.0))
        red = texture.CreateOutput("r", value_type("Float"))
        shader.CreateInput("roughness", value_type("Float")).ConnectToSource(red)
    if pictures.normals:
        texture, normals = texture_of("Velour_Normals", pictures.normals, "raw", (2.0, 2.0, 2.0))
        texture.CreateInput("bias", value_type("Float4")).Set((-1.0, -1.0, -1.0, 0.0))
        shader.CreateInput("normal", value_type("Normal3f")).ConnectToSource(normals)


def _write_uvs(usd_material, placed):
    """Adds the nodes that place the image; returns the output of the last one."""
    reader = add(usd_material, _READER, "UsdPrimvarReader_float2")
    reader.CreateInput("varname", value_type("String")).Set(coordinate_name(placed))
    output = reader.CreateOutput("result", value_type("Float2"))
    for number, step in enumerate(chain(placed)):
        transform = add(usd_material, f"Velour_Placement_{number + 1}", "UsdTransform2d")
        transform.CreateInput("in", value_type("Float2")).ConnectToSource(output)
        transform.CreateInput("rotation", value_type("Float")).Set(step.degrees)
        transform.CreateInput("scale", value_type("Float2")).Set(step.scale)
        transform.CreateInput("translation", value_type("Float2")).Set(step.translation)
        output = transform.CreateOutput("result", value_type("Float2"))
    return output


def _uv_names(stage, path):
    """Names of texture coordinates of meshes with this material on all or some faces."""
    from pxr import UsdGeom, UsdShade

    names = []
    for prim in stage.Traverse():
        bound = UsdShade.MaterialBindingAPI(prim).GetDirectBindingRel().GetTargets()
        if path not in bound:
            continue
        mesh = prim.GetParent() if prim.IsA(UsdGeom.Subset) else prim
        for primvar in UsdGeom.PrimvarsAPI(mesh).GetPrimvars():
            if primvar.GetTypeName().scalarType == value_type("TexCoord2f"):
                names.append(primvar.GetPrimvarName())
    return names
