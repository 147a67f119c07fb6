"""Small scenes, and their pictures as numpy arrays."""

from pathlib import Path

import bpy
import numpy as np

SIZE = 32
# What the former layout keeps of an approximation.
FORMER_FIT = """{"principled": {"base_color": [0.5, 0.25, 0.125], "metallic": 0.0, "roughness": 0.4,
"specular": 0.5, "specular_tint": [1, 1, 1], "coat": 0.0, "coat_roughness": 0.03}, "diffuse": [0, 0, 0],
"color": [0.5, 0.25, 0.125], "anisotropic": 0.0, "turned": false, "tile_metres": null}"""


def use_engine(samples=64, bounces=0, size=SIZE):
    scene = bpy.context.scene
    scene.render.engine = "VELOUR"
    scene.render.resolution_x = scene.render.resolution_y = size
    scene.render.resolution_percentage = 100
    scene.velour.samples = samples
    scene.velour.bounces = bounces
    scene.view_settings.view_transform = "Standard"
    return scene


def use_picture(samples, width=80, height=60):
    """A small picture by Velour; direct light."""
    scene = use_engine(samples)
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.velour.split = 1  # every direction has its own place in the pixel
    return scene


def add_camera(distance=5.0, ortho_scale=None):
    """Looks along -y... from +z down at the origin: picture x is world x, picture y is world y."""
    data = bpy.data.cameras.new("Camera")
    if ortho_scale:
        data.type, data.ortho_scale = "ORTHO", ortho_scale
    camera = bpy.data.objects.new("Camera", data)
    camera.location = (0, 0, distance)
    bpy.context.scene.collection.objects.link(camera)
    bpy.context.scene.camera = camera
    return camera


def remove_all_but_camera():
    for obj in list(bpy.data.objects):
        if obj.type != "CAMERA":
            bpy.data.objects.remove(obj)


def add_sphere(material=None, radius=1.0):
    bpy.ops.mesh.primitive_uv_sphere_add(segments=32, ring_count=16, radius=radius)
    return _finish(material, smooth=True)


def add_plane(material=None, size=2.0):
    bpy.ops.mesh.primitive_plane_add(size=size)
    return _finish(material, smooth=False)


def _finish(material, smooth):
    obj = bpy.context.object
    for polygon in obj.data.polygons:
        polygon.use_smooth = smooth
    if material:
        obj.data.materials.append(material)
    return obj


def set_world(color=(1, 1, 1), strength=1.0):
    world = bpy.data.worlds.new("World")
    world.use_nodes = True
    background = world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (*color, 1)
    background.inputs["Strength"].default_value = strength
    bpy.context.scene.world = world
    return world


def diffuse_material(color=(1, 1, 1), name="Diffuse"):
    """A Diffuse BSDF: its picture under a constant world is its color."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.remove(tree.nodes["Principled BSDF"])
    shader = tree.nodes.new("ShaderNodeBsdfDiffuse")
    shader.inputs["Color"].default_value = (*color, 1)
    tree.links.new(shader.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
    return material


def measured_material(data, name="Paint"):
    """A material whose node holds the packed model `data`, made as the import operator makes it."""
    from .inputs import ADDON, native

    measured = __import__(f"{ADDON}.operators.measured", fromlist=["measured"])
    material, info = measured.new_material(name), None
    if data.startswith(b"\x76\x2f\x31\x01"):  # an OpenEXR file: a model, and not what only poses as one
        with native().Model.from_bytes(data, name) as model:
            info = model.info()
    image = measured.packed_model(data, name)
    measured.set_model(material, velour_node(material), image, print, info=info)
    return material


def former_material(data, name="Former"):
    """A material of the former layout: the model is in a muted, unlinked node beside a group for others."""
    from .inputs import ADDON

    measured = __import__(f"{ADDON}.operators.measured", fromlist=["measured"])
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    node = tree.nodes.new("ShaderNodeTexImage")
    node.name = node.label = "Velour"
    node.velour.enabled = node.mute = True
    node.image = measured.packed_model(data, name)
    _add_former_group(tree, output)
    return material


def new_group(name, output, kind="NodeSocketShader", inputs=None):
    """A node group with one output of this kind. `inputs`: kinds of sockets by name."""
    group = bpy.data.node_groups.new(name, "ShaderNodeTree")
    for socket, each in (inputs or {}).items():
        if hasattr(group, "interface"):  # 4.0 and newer
            group.interface.new_socket(name=socket, in_out="INPUT", socket_type=each)
        else:
            group.inputs.new(each, socket)
    if hasattr(group, "interface"):
        group.interface.new_socket(name=output, in_out="OUTPUT", socket_type=kind)
    else:
        group.outputs.new(kind, output)
    return group


def _add_former_group(tree, output):
    group = new_group("Velour approximation", "BSDF")
    shader, sink = group.nodes.new("ShaderNodeBsdfPrincipled"), group.nodes.new("NodeGroupOutput")
    group.links.new(shader.outputs[0], sink.inputs[0])
    group.velour.is_approximation = True
    group.velour.fitted = FORMER_FIT
    node = tree.nodes.new("ShaderNodeGroup")
    node.node_tree = group
    tree.links.new(node.outputs[0], output.inputs["Surface"])


def worn_file(path):
    """A lit ball that wears the model file `path`, which is written; the image that names it."""
    path.write_bytes((Path(__file__).parent.parent / "scenes/data/paint.velour").read_bytes())
    use_picture(samples=4)
    add_camera()
    set_world()
    add_sphere()
    bpy.ops.velour.load_material(filepath=str(path), pack=False)
    return velour_node(bpy.context.object.active_material).image


def velour_node(material):
    """The MeasuredNode of a material."""
    from .inputs import ADDON

    return __import__(f"{ADDON}.export.nodes", fromlist=["nodes"]).velour_node(material)


def set_look(material, **values):
    """Sets inputs of a measured material's node: tint, exposure, roughness, rotation, scale."""
    inputs = velour_node(material).group.inputs
    for name, value in values.items():
        value = (*value, 1.0) if name == "tint" else value
        inputs["Roughness Offset" if name == "roughness" else name.title()].default_value = value


def render(folder, name="picture", layer="Combined"):
    """Renders the scene through a 32-bit EXR file; [height x width x 4], row 0 at the bottom."""
    path = folder / f"{name}.exr"
    settings = bpy.context.scene.render
    settings.image_settings.file_format = "OPEN_EXR"
    settings.image_settings.color_mode = "RGBA"
    settings.image_settings.color_depth = "32"
    settings.filepath = str(path)
    bpy.ops.render.render(write_still=True)
    return read(path)


def composite(scene):
    """Makes a compositor that shows one pass; returns the function that says which."""
    if hasattr(scene, "compositing_node_group"):  # 5.0 and newer
        tree = scene.compositing_node_group = bpy.data.node_groups.new("Compositor", "CompositorNodeTree")
        tree.interface.new_socket(name="Image", in_out="OUTPUT", socket_type="NodeSocketColor")
        sink = tree.nodes.new("NodeGroupOutput")
    else:
        scene.use_nodes = True
        tree = scene.node_tree
        tree.nodes.clear()
        sink = tree.nodes.new("CompositorNodeComposite")
    source = tree.nodes.new("CompositorNodeRLayers")
    return lambda name: tree.links.new(source.outputs[name], sink.inputs["Image"])


def compositor(scene):
    """The node tree that composite() made."""
    group = getattr(scene, "compositing_node_group", None)
    return group or scene.node_tree


def read(path):
    image = bpy.data.images.load(str(path), check_existing=False)
    try:
        width, height = image.size
        pixels = np.empty(width * height * image.channels, np.float32)
        image.pixels.foreach_get(pixels)
        return pixels.reshape(height, width, image.channels)
    finally:
        bpy.data.images.remove(image)


def middle(pixels, share=0.25):
    """Mean RGB of the middle of a picture."""
    height, width = pixels.shape[:2]
    dy, dx = max(1, int(height * share / 2)), max(1, int(width * share / 2))
    return pixels[height // 2 - dy : height // 2 + dy, width // 2 - dx : width // 2 + dx, :3].mean(
        axis=(0, 1)
    )
