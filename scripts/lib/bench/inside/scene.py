"""Builds and renders scenes inside Blender."""

import logging
import math
import os
import time

import addon_utils
import bpy
from mathutils import Vector

NAME = "tile"  # name of the material of a captured tile; its BTF is in NAME.btf


def empty(size, samples, bounces):
    """An empty scene for Velour, with the display transform that changes least."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    addon_utils.enable("velour", default_set=False, handle_error=refuse)
    scene = bpy.context.scene
    scene.render.engine = "VELOUR"
    scene.render.resolution_x, scene.render.resolution_y = size
    scene.view_settings.view_transform = "Standard"
    scene.velour.samples, scene.velour.bounces, scene.velour.seed = samples, bounces, 1
    return scene


def refuse(error):
    raise error


def link(name, data, location=(0, 0, 0)):
    """A new object in the scene."""
    found = bpy.data.objects.new(name, data)
    found.location = location
    bpy.context.scene.collection.objects.link(found)
    return found


def turn(obj, towards):
    """Makes a light or a camera look at a point."""
    way = Vector(towards) - Vector(obj.location)
    obj.rotation_euler = way.to_track_quat("-Z", "Y").to_euler()
    return obj


def camera(location, towards=(0, 0, 0), **settings):
    """`settings`: properties of the camera's data."""
    found = turn(link("Camera", bpy.data.cameras.new("Camera"), location), towards)
    for name, value in settings.items():
        setattr(found.data, name, value)
    bpy.context.scene.camera = found
    return found


def lamp(kind, energy, location=(0, 0, 0), towards=None, **settings):
    """`settings`: properties of the light's data."""
    data = bpy.data.lights.new("Lamp", kind)
    data.energy = energy
    for name, value in settings.items():
        setattr(data, name, value)
    found = link("Lamp", data, location)
    return turn(found, towards) if towards else found


def material(name="Material", shader="Principled BSDF", **inputs):
    """`shader`: the Principled BSDF, or the name of another shader node. Colors have three components."""
    found = bpy.data.materials.new(name)
    found.use_nodes = True
    tree = found.node_tree
    node = tree.nodes["Principled BSDF"]
    if shader != node.name:
        tree.nodes.remove(node)
        node = tree.nodes.new(f"ShaderNode{shader}")
        tree.links.new(node.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
    for socket, value in inputs.items():
        color = (*value, 1) if isinstance(value, tuple) else value
        node.inputs[socket.replace("_", " ")].default_value = color
    return found


def polygons(name, points, faces, own_material=None):
    """A new object of points and faces."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(points, [], faces)
    if own_material:
        mesh.materials.append(own_material)
    return link(name, mesh)


def ball(center, radius, own_material=None, segments=48):
    bpy.ops.mesh.primitive_uv_sphere_add(
        radius=radius, location=center, segments=segments, ring_count=segments // 2
    )
    bpy.ops.object.shade_smooth()
    if own_material:
        bpy.context.object.data.materials.append(own_material)
    return bpy.context.object


def monkey(size=2.0, turned=(0, 0), levels=3):
    """Suzanne, smooth. `turned`: degrees about x and about z."""
    rotation = (math.radians(turned[0]), 0, math.radians(turned[1]))
    bpy.ops.mesh.primitive_monkey_add(size=size, rotation=rotation)
    found = bpy.context.object
    smooth = found.modifiers.new("Smooth", "SUBSURF")
    smooth.levels = smooth.render_levels = levels
    bpy.ops.object.shade_smooth()
    return found


def set_down(obj):
    """Makes an object stand on the plane z = 0."""
    shaped = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    obj.location.z -= min((shaped.matrix_world @ vertex.co).z for vertex in shaped.data.vertices)
    return obj


def world(picture=None, strength=1.0, color=(0, 0, 0), rotation=0.0):
    """`picture`: the path of an environment map, or the name of one that comes with Blender. `rotation`:
    about z, in degrees."""
    found = bpy.context.scene.world = bpy.data.worlds.new("World")
    found.use_nodes = True
    nodes, links = found.node_tree.nodes, found.node_tree.links
    background = next(node for node in nodes if node.bl_idname == "ShaderNodeBackground")
    background.inputs["Color"].default_value = (*color, 1)
    background.inputs["Strength"].default_value = strength
    if picture:
        own = os.path.join(bpy.utils.system_resource("DATAFILES"), "studiolights", "world")
        image = nodes.new("ShaderNodeTexEnvironment")
        image.image = bpy.data.images.load(
            picture if os.sep in picture else os.path.join(own, f"{picture}.exr")
        )
        links.new(image.outputs["Color"], background.inputs["Color"])
        if rotation:
            mapping, place = nodes.new("ShaderNodeMapping"), nodes.new("ShaderNodeTexCoord")
            mapping.inputs["Rotation"].default_value[2] = math.radians(rotation)
            links.new(place.outputs["Generated"], mapping.inputs["Vector"])
            links.new(mapping.outputs["Vector"], image.inputs["Vector"])


def measured_node(of):
    """The MeasuredNode of a material."""
    from velour.export.nodes import velour_node

    return velour_node(of)


def render(folder, name):
    """Writes NAME.exr and NAME.png; returns the engine's report."""
    scene, reports = bpy.context.scene, _ReportHandler()
    bpy.ops.render.render()
    reports.close()
    picture, settings = bpy.data.images["Render Result"], scene.render.image_settings
    for suffix, file_format, depth in ((".exr", "OPEN_EXR", "32"), (".png", "PNG", "8")):
        settings.file_format, settings.color_depth = file_format, depth
        picture.save_render(os.path.join(folder, name + suffix), scene=scene)
    return reports.last


class _ReportHandler(logging.Handler):
    """Takes the report of each render from the engine's log."""

    def __init__(self):
        super().__init__()
        self.last = {}
        self._log = logging.getLogger("velour.engine")
        self._log.setLevel(logging.INFO)
        self._log.addHandler(self)

    def emit(self, record):
        if isinstance(record.args, dict):
            self.last = dict(record.args)

    def close(self):
        self._log.removeHandler(self)
        super().close()


def capture_and_compress(folder, capture, megabytes):
    """Captures the active object, a tile, as a BTF and makes the material NAME of it.

    `capture`: arguments of the operator; `megabytes`: 0: the library chooses. Returns seconds and bytes.
    """
    btf = os.path.join(folder, f"{NAME}.btf")
    start = time.perf_counter()
    bpy.ops.velour.capture_btf(directory=btf, sides="ONE", **capture)
    middle = time.perf_counter()
    bpy.ops.velour.compress_btf(filepath=btf, megabytes=megabytes)
    return {
        "capture_seconds": middle - start,
        "compress_seconds": time.perf_counter() - middle,
        "btf_bytes": sum(entry.stat().st_size for entry in os.scandir(btf)),
        "model_bytes": measured_node(bpy.data.materials[NAME]).image.packed_file.size,
    }
