"""A picture all around, another one on the ground."""

QUANTITY = "a turned environment picture as light and background, an image texture and a normal map"
# Velour follows Blender in the Principled BSDF and in steep normals, so their references differ.
MEANINGS = ("", "layered", "shadowed")


def meaning():
    import bpy

    from support import principled

    return "shadowed" if bpy.app.version >= (4, 5) else principled.meaning()


def build(folder):
    import numpy as np

    from parity import stage
    from support import scenes

    scenes.use_picture(samples=256)
    rows, columns = np.mgrid[0:32, 0:64]
    sky = np.full((32, 64, 3), 0.2, np.float32)
    sky[16:] = (0.3, 0.5, 0.9)
    sky[(rows - 24) ** 2 + (columns - 40) ** 2 < 12] = (25, 20, 14)
    _surround(scenes.set_world(strength=0.8).node_tree, _image("Sky", sky), 0.8)
    ground = stage.ground(8)
    ground.data.uv_layers.new()
    checkers = (rows // 4 + columns // 4) % 2
    colors = np.where(checkers[..., None], (0.8, 0.7, 0.5), (0.1, 0.2, 0.3))
    waves = np.stack([0.5 + 0.2 * np.sin(columns), 0.5 + 0.2 * np.cos(rows), 0.9 + 0 * rows], axis=-1)
    ground.data.materials[0] = _material(_image("Checkers", colors), _image("Waves", waves, "Non-Color"))
    stage.sphere(0.8, 0.8, 32, 16).location.z = 0.8
    stage.camera((0, -6, 1.6), (1.42, 0, 0), 32)


def _surround(tree, image, angle):
    environment, mapping = (tree.nodes.new(f"ShaderNode{kind}") for kind in ("TexEnvironment", "Mapping"))
    environment.image, mapping.inputs["Rotation"].default_value = image, (0, 0, angle)
    place = tree.nodes.new("ShaderNodeTexCoord").outputs["Generated"]
    tree.links.new(place, mapping.inputs["Vector"])
    tree.links.new(mapping.outputs[0], environment.inputs["Vector"])
    tree.links.new(environment.outputs[0], tree.nodes["Background"].inputs["Color"])


def _image(name, pixels, space=None):
    """Packed, [height x width x 3]; without `space` linear, as images of floats are."""
    import bpy
    import numpy as np

    height, width = pixels.shape[:2]
    image = bpy.data.images.new(name, width, height, float_buffer=True)
    if space:
        image.colorspace_settings.name = space
    image.pixels.foreach_set(np.dstack([pixels, np.ones((height, width))]).astype(np.float32).ravel())
    image.pack()
    return image


def _material(color, normal):
    import bpy

    material = bpy.data.materials.new("Tiles")
    material.use_nodes = True
    tree = material.node_tree
    shader = tree.nodes["Principled BSDF"]
    shader.inputs["Roughness"].default_value = 0.6
    for image, target in ((color, shader.inputs["Base Color"]), (normal, None)):
        texture = tree.nodes.new("ShaderNodeTexImage")
        texture.image = image
        if target is None:
            bumps = tree.nodes.new("ShaderNodeNormalMap")
            tree.links.new(texture.outputs["Color"], bumps.inputs["Color"])
            tree.links.new(bumps.outputs["Normal"], shader.inputs["Normal"])
        else:
            tree.links.new(texture.outputs["Color"], target)
    return material
