"""Shader prims of USD files, and images beside them."""

import os


def add(usd_material, name, kind):
    """Adds a shader prim below the material."""
    from pxr import UsdShade

    path = usd_material.GetPath().AppendChild(name)
    shader = UsdShade.Shader.Define(usd_material.GetPrim().GetStage(), path)
    shader.CreateIdAttr(kind)
    return shader


def value_type(name):
    from pxr import Sdf

    return getattr(Sdf.ValueTypeNames, name)


def exported(context, image):
    """Writes the image beside the file, as Blender writes textures; returns its path for the file.

    context: Blender's export context.
    """
    if hasattr(context, "export_texture"):
        return context.export_texture(image)
    folder = os.path.join(os.path.dirname(context.get_stage().GetRootLayer().realPath), "textures")
    os.makedirs(folder, exist_ok=True)
    name = "".join(c if c.isalnum() else "_" for c in image.name) + ".png"
    with open(os.path.join(folder, name), "wb") as file:
        file.write(image.packed_file.data)  # always PNG, packed by approximation_image
    return f"./textures/{name}"


def coordinate_name(placed):
    """The name in the file of the texture coordinates of a Placed; "st" of the active render map."""
    from pxr import Tf

    return Tf.MakeValidIdentifier(placed.uv_map) if placed.uv_map else "st"
