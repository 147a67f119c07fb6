"""Scenes for the viewport, and repeatable changes to them."""

import math

import bpy
from guide import chapters
from mathutils import Euler, Quaternion
from support import viewport

from ..project import ROOT
from . import large_scenes
from . import scene as build

PAINT = ROOT / "blend-tests/scenes/data/paint.velour"
OBJECTS, FACES = 500, 5000  # 10,000 triangles each
INSTANCES = 100_000


def monkey():
    """One smooth object in a measured paint under an environment map and a light."""
    chapters.add_world()
    with viewport.override():
        subject = chapters.add_monkey()
        bpy.ops.velour.load_material(filepath=str(PAINT), pack=False)
    subject.name = "Subject"


def objects():
    """Five million triangles in 500 objects, each with a mesh of its own."""
    with viewport.override():
        first = _grid(FACES, 0.9)
    first.data.materials.append(_gray())
    side = math.ceil(math.sqrt(OBJECTS))
    for i in range(1, OBJECTS):
        build.link("Object", first.data.copy(), (i % side - side / 2, i // side - side / 2, 0))
    first.location, first.name = (-side / 2, -side / 2, 0), "Subject"


def instances():
    """100,000 instances of a sphere of 992 triangles, at the vertices of a plane."""
    with viewport.override():
        sphere, _ = large_scenes.instances(INSTANCES)
    sphere.data.materials.append(_gray())
    sphere.name = "Subject"


SCENES = {"monkey": monkey, "objects": objects, "instances": instances}


def start(name):
    """Builds the scene in Blender's startup file, without its cube."""
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    SCENES[name]()
    view = viewport.space().region_3d
    view.view_rotation, view.view_distance = Euler((0.9, 0, 0.6)).to_quaternion(), 14


def turn_view(_time):
    view = viewport.space().region_3d
    view.view_rotation = Quaternion((0, 0, 1), 0.05) @ view.view_rotation


def change_lamp(time):
    bpy.data.lights["Light"].energy = 800 + 100 * time


def change_world(time):
    background = bpy.context.scene.world.node_tree.nodes["Background"]
    background.inputs["Strength"].default_value = 0.8 + 0.1 * time


def change_material(time):
    """Changes the color, or the placement of a measured material."""
    material = bpy.data.objects["Subject"].active_material
    if material.name == "Gray":
        node = next(node for node in material.node_tree.nodes if node.type == "BSDF_DIFFUSE")
        node.inputs["Color"].default_value = (0.5, 0.1 * (time % 9), 0.3, 1)
    else:
        group = next(node for node in material.node_tree.nodes if node.type == "GROUP")
        group.inputs["Rotation"].default_value = 0.1 * (time + 1)


def move_object(time):
    bpy.data.objects["Subject"].location.z += 0.01 * (-1) ** time


def edit_mesh(_time):
    mesh = bpy.data.objects["Subject"].data
    mesh.vertices[0].co.z += 0.01
    mesh.update()


CHANGES = {
    "the view turns": turn_view,
    "strength of a lamp": change_lamp,
    "strength of the world": change_world,
    "a material": change_material,
    "an object moves": move_object,
    "a mesh is edited": edit_mesh,
}


def _grid(faces, size):
    side = round(math.sqrt(faces))
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=side, y_subdivisions=side, size=size)
    grid = bpy.context.object
    for vertex in grid.data.vertices:
        vertex.co.z = 0.1 * math.sin(20 * vertex.co.x) * math.sin(20 * vertex.co.y)
    bpy.ops.object.shade_smooth()
    return grid


def _gray():
    return build.material("Gray", "BsdfDiffuse")
