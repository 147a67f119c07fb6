"""Exports a measured material's approximation to USD as a UsdPreviewSurface.

Blender's exporter does not read node groups, and writes a material without a surface.
"""

import os

import numpy as np

from ..export.color import working_to_rec709
from ..export.nodes import approximation_node
from .approximation_group import images
from .approximation_look import is_surface, shown
from .approximation_uv import chain

_READER = "Velour_UV"


def write(context, material, usd_material):
    """Writes into a material that has no surface yet; a surface of the user's own, or of Solid mode, stays.

    context: Blender's export context. Returns whether anything was written.
    """
    values = shown(material) if material.node_tree else None
    if values is None or not is_surface(material) or _has_surface(usd_material):
        return False
    tree = approximation_node(material).node_tree
    shader = _add(usd_material, "Velour_Approximation", "UsdPreviewSurface")
    for name, (kind, value) in _inputs(values).items():
        shader.CreateInput(name, _type(kind)).Set(value)
    if images(tree):
        _write_images(context, usd_material, shader, tree, values)
    output = shader.CreateOutput("surface", _type("Token"))
    usd_material.CreateSurfaceOutput().ConnectToSource(output)
    return True


def choose_uvs(stage):
    """Sets names of texture coordinates to those of the meshes, since the export may rename active ones."""
    from pxr import Usd, UsdShade

    for prim in Usd.PrimRange(stage.GetPseudoRoot()):
        if not (prim.IsA(UsdShade.Material) and prim.GetChild(_READER)):
            continue
        wanted = UsdShade.Shader(prim.GetChild(_READER)).GetInput("varname")
        names = _uv_names(stage, prim.GetPath())
        if names and wanted.Get() not in names:
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


def _write_images(context, usd_material, shader, tree, values):
    def add(name, image, color_space, scale):
        texture = _add(usd_material, name, "UsdUVTexture")
        texture.CreateInput("file", _type("Asset")).Set(_exported(context, image))
        texture.CreateInput("sourceColorSpace", _type("Token")).Set(color_space)
        for wrap in ("wrapS", "wrapT"):
            texture.CreateInput(wrap, _type("Token")).Set("repeat")
        texture.CreateInput("scale", _type("Float4")).Set((*scale, 1.0))
        texture.CreateInput("st", _type("Float2")).ConnectToSource(uvs)
        return texture, texture.CreateOutput("rgb", _type("Float3"))

    uvs = _write_uvs(usd_material, values.placed)
    pictures = images(tree)
    texture, color = add("Velour_Color", pictures[0], "sRGB", working_to_rec709(values.gain))
    shader.CreateInput("diffuseColor", _type("Color3f")).ConnectToSource(color)
    principled = next(node for node in tree.nodes if node.bl_idname == "ShaderNodeBsdfPrincipled")
    if principled.inputs["Alpha"].is_linked:
        alpha = texture.CreateOutput("a", _type("Float"))
        shader.CreateInput("opacity", _type("Float")).ConnectToSource(alpha)
    if len(pictures) > 1:
        texture, normals = add("Velour_Normals", pictures[1], "raw", (2.0, 2.0, 2.0))
        texture.CreateInput("bias", _type("Float4")).Set((-1.0, -1.0, -1.0, 0.0))
        shader.CreateInput("normal", _type("Normal3f")).ConnectToSource(normals)


def _write_uvs(usd_material, placed):
    """Adds the nodes that place the image; returns the output of the last one."""
    from pxr import Tf

    reader = _add(usd_material, _READER, "UsdPrimvarReader_float2")
    name = placed.uv_map
    reader.CreateInput("varname", _type("String")).Set(Tf.MakeValidIdentifier(name) if name else "st")
    output = reader.CreateOutput("result", _type("Float2"))
    for number, step in enumerate(chain(placed)):
        transform = _add(usd_material, f"Velour_Placement_{number + 1}", "UsdTransform2d")
        transform.CreateInput("in", _type("Float2")).ConnectToSource(output)
        transform.CreateInput("rotation", _type("Float")).Set(step.degrees)
        transform.CreateInput("scale", _type("Float2")).Set(step.scale)
        transform.CreateInput("translation", _type("Float2")).Set(step.translation)
        output = transform.CreateOutput("result", _type("Float2"))
    return output


def _exported(context, image):
    """Writes the image beside the file, as Blender writes textures; returns its path for the file."""
    if hasattr(context, "export_texture"):
        return context.export_texture(image)
    folder = os.path.join(os.path.dirname(context.get_stage().GetRootLayer().realPath), "textures")
    os.makedirs(folder, exist_ok=True)
    name = "".join(c if c.isalnum() else "_" for c in image.name) + ".png"
    with open(os.path.join(folder, name), "wb") as file:
        file.write(image.packed_file.data)  # always PNG, packed by approximation_image
    return f"./textures/{name}"


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
            if primvar.GetTypeName().scalarType == _type("TexCoord2f"):
                names.append(primvar.GetPrimvarName())
    return names


def _add(usd_material, name, kind):
    from pxr import UsdShade

    path = usd_material.GetPath().AppendChild(name)
    shader = UsdShade.Shader.Define(usd_material.GetPrim().GetStage(), path)
    shader.CreateIdAttr(kind)
    return shader


def _type(name):
    from pxr import Sdf

    return getattr(Sdf.ValueTypeNames, name)
