"""Runs inside Blender: variants of a scene for run_check_bench, and planted changes of them.

The task: "blend" (to open), "save" (paths by variant or by change), "models" (folder of models), "report".
"""

import math
from pathlib import Path

import bpy
import inside
import numpy as np
from mathutils import Matrix

from support import scenes

BALL, CUBE, TILES, PLASTIC = "Bench ball", "Bench cube", "Bench tiles", "Bench plastic"
_PROP_METERS = 4.0  # from a camera without depth of field


def main(task):
    for name, path in task["save"].items():
        inside.open_file(task["blend"], scripts=False)
        inside.enable_velour(bpy.context.scene)
        (_VARIANTS | _CHANGES)[name](bpy.context.scene, Path(task["models"]))
        bpy.ops.wm.save_as_mainfile(filepath=path)


def _variant(change):
    def make(scene, models):
        _dress_up(scene, models)
        change(scene)

    return make


def _dress_up(scene, models):
    """A sky where the world is one color, a textured ball and a measured cube in the picture."""
    if scene.world is None or not _mapping(scene):
        _add_sky(scene)
    camera = scene.camera
    lens = camera.data.dof
    distance = lens.focus_distance if lens.use_dof else _PROP_METERS
    bpy.context.view_layer.update()
    frame = [distance / -corner.z * corner for corner in camera.data.view_frame(scene=scene)]
    left, right = (side(corner.x for corner in frame) for side in (min, max))
    bottom, top = (side(corner.y for corner in frame) for side in (min, max))
    size = 0.28 * (top - bottom)
    for name, share in ((BALL, 0.35), (CUBE, 0.65)):
        obj = _ball(size / 2) if name == BALL else _cube(0.7 * size)
        obj.name, obj.parent = name, camera
        obj.matrix_parent_inverse = Matrix()
        x, y = left + share * (right - left), bottom + 0.3 * (top - bottom)
        obj.location, obj.rotation_euler = (x, y, -distance), (0.5, 0.6, 0.2)
    _put(BALL, _tiles(0))
    _put(CUBE, _plastic(models / "plastic.velour"))


def _ball(radius):
    bpy.ops.mesh.primitive_uv_sphere_add(segments=32, ring_count=16, radius=radius)
    return bpy.context.object


def _cube(size):
    bpy.ops.mesh.primitive_cube_add(size=size)
    return bpy.context.object


def _put(name, material):
    slots = bpy.data.objects[name].data.materials
    slots.clear()
    slots.append(material)


def _tiles(phase):
    material = scenes.diffuse_material(name=TILES)
    rows, columns = np.mgrid[0:16, 0:16]
    checkers = (rows // 4 + columns // 4 + phase) % 2
    texture = material.node_tree.nodes.new("ShaderNodeTexImage")
    texture.image = _image(f"Tiles {phase}", np.where(checkers[..., None], (0.8, 0.7, 0.5), (0.1, 0.2, 0.3)))
    material.node_tree.links.new(
        texture.outputs["Color"], material.node_tree.nodes["Diffuse BSDF"].inputs["Color"]
    )
    return material


def _plastic(path):
    return scenes.measured_material(path.read_bytes(), PLASTIC)


def _image(name, pixels):
    height, width = pixels.shape[:2]
    image = bpy.data.images.new(name, width, height, float_buffer=True)
    image.pixels.foreach_set(np.dstack([pixels, np.ones((height, width))]).astype(np.float32).ravel())
    image.pack()
    return image


def _mapping(scene):
    nodes = scene.world.node_tree.nodes if scene.world.use_nodes else ()
    return next((node for node in nodes if node.type == "MAPPING"), None)


def _add_sky(scene):
    """Hills under a blue sky with clouds, as bright as the color before."""
    color, strength = (0.05, 0.05, 0.05), 1.0
    if scene.world and scene.world.use_nodes:
        inputs = scene.world.node_tree.nodes["Background"].inputs
        color, strength = tuple(inputs["Color"].default_value)[:3], inputs["Strength"].default_value
    rows, columns = np.mgrid[0:64, 0:128]
    clouds = 1 + 0.4 * np.sin(columns * math.pi / 8) * np.cos(rows / 5)
    above = rows > 32 + 4 * np.sin(columns * math.pi / 16)
    sky = np.where(above[..., None], (1.0, 1.2, 1.6), (0.5, 0.45, 0.3))
    world = scenes.set_world(strength=strength)
    scene.world, tree = world, world.node_tree
    source, place, picture = (
        tree.nodes.new(f"ShaderNode{kind}") for kind in ("TexCoord", "Mapping", "TexEnvironment")
    )
    picture.image = _image("Bench sky", sky * clouds[..., None] * color)
    tree.links.new(source.outputs["Generated"], place.inputs["Vector"])
    tree.links.new(place.outputs[0], picture.inputs["Vector"])
    tree.links.new(picture.outputs["Color"], tree.nodes["Background"].inputs["Color"])


def _orbit(degrees):
    def turn(scene):
        camera = scene.camera
        camera.matrix_world = Matrix.Rotation(math.radians(degrees), 4, "Z") @ camera.matrix_world

    return turn


def _dim(scene):
    """Three fifths of the light of lamps, half as much again of the world's."""
    for light in bpy.data.lights:
        light.energy *= 0.6
    scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value *= 1.5


def _turn_sky(scene):
    _mapping(scene).inputs["Rotation"].default_value[2] += 2.0


_VARIANTS = {
    "as is": _variant(lambda scene: None),
    "from the left": _variant(_orbit(-12)),
    "from the right": _variant(_orbit(15)),
    "other lamps": _variant(_dim),
    "other sky": _variant(_turn_sky),
}


def _expose(scene, _models):
    scene.cycles.film_exposure *= 1.01


def _turn_world(scene, _models):
    _mapping(scene).inputs["Rotation"].default_value[2] += math.radians(1)


def _swap_texture(_scene, _models):
    texture, other = (
        material.node_tree.nodes["Image Texture"] for material in (bpy.data.materials[TILES], _tiles(1))
    )
    texture.image = other.image


def _refit(_scene, models):
    former = bpy.data.materials[PLASTIC]
    former.name = "Former"
    _put(CUBE, _plastic(models / "plastic_worse.velour"))


def _shift_uv_map(_scene, _models):
    for corner in bpy.data.objects[BALL].data.uv_layers.active.data:
        corner.uv[0] += 0.05


_CHANGES = {
    "exposure 1 %": _expose,
    "world 1 degree": _turn_world,
    "texture swapped": _swap_texture,
    "model refitted": _refit,
    "UV map shifted": _shift_uv_map,
}
