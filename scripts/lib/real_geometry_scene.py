"""Runs inside Blender: captures and compresses a tile; renders objects covered with its geometry, and the
same objects with its BTF and with the model of the BTF. The task is the JSON text after "--"."""

from __future__ import annotations

import json
import math
import os
import sys

import bpy
import numpy as np
from mathutils import Vector

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from blender_picture import empty_scene, measured_node, render_picture
from captured_tile import NAME, capture_and_compress
from tiled_objects import Cylinder, Plane, add_smooth, add_tiles

PERIOD = 1.0
SUN, SKY = 2.5, 0.25  # irradiance on a facing surface, radiance
# Views and lights: degrees from the normal of the plane (of the cylinder's topmost line), and around it.
# Those of "captured" belong to the sets of 81 and of 105 directions, so that nothing is interpolated.
SHOTS = {
    "captured": {"shape": "plane", "view": (45, 40), "sun": (30, 60), "sky": 0.0, "tiles": 2.5},
    "plane": {"shape": "plane", "view": (52, 250), "sun": (50, 10), "sky": SKY, "tiles": 3.0},
    "cylinder": {"shape": "cylinder", "view": (25, 0), "sun": (40, 120), "sky": SKY, "tiles": 7.2},
}
AROUND = 20  # tiles around the cylinder


def main(task: dict) -> None:
    scene = empty_scene((task["side"], task["side"]), task["samples"], task["capture"]["bounces"])
    scene.render.film_transparent = True
    folder = task["folder"]
    bpy.ops.velour.add_mesostructure(type=task["tile"], size=PERIOD, **task["options"])
    tile = bpy.context.object
    report = capture_and_compress(folder, task["capture"], task["megabytes"])
    height = _reference_height(tile, folder)
    shapes = {"plane": Plane(PERIOD, height), "cylinder": Cylinder(PERIOD, height, AROUND)}
    report["shots"] = {
        name: _take(scene, tile, shapes[SHOTS[name]["shape"]], name, folder) for name in task["shots"]
    }
    with open(os.path.join(folder, "report.json"), "w") as file:
        json.dump(report, file, indent=2)


def _reference_height(tile: bpy.types.Object, folder: str) -> float:
    """Height of the texels' reference plane above z = 0 of the tile."""
    with open(os.path.join(folder, f"{NAME}.btf", "btf.json")) as file:
        above_lowest = json.load(file)["shell"]["reference_height"]
    return min(vertex.co.z for vertex in tile.data.vertices) + above_lowest


def _take(scene, tile, shape, name: str, folder: str) -> dict:
    """Renders NAME-geometry, NAME-btf and NAME-model; returns the seconds of each render."""
    _remove_all_but(tile)
    shot = SHOTS[name]
    _aim(scene, shot, shape.middle)
    _light(scene, shot)
    tile.hide_render = True
    copies = add_tiles(tile, shape)
    seconds = {"geometry": render_picture(scene, folder, f"{name}-geometry")["seconds"]}
    for copy in copies:
        bpy.data.objects.remove(copy)
    smooth = add_smooth(shape)
    smooth.data.materials.append(bpy.data.materials[NAME])
    node = measured_node(bpy.data.materials[NAME])
    for what, itself in (("btf", True), ("model", False)):
        node.velour.use_reference = itself
        seconds[what] = render_picture(scene, folder, f"{name}-{what}")["seconds"]
    return {"seconds": seconds}


def _remove_all_but(tile: bpy.types.Object) -> None:
    for obj in [obj for obj in bpy.data.objects if obj != tile]:
        bpy.data.objects.remove(obj)


def _direction(angles: tuple[float, float]) -> Vector:
    theta, phi = (math.radians(a) for a in angles)
    return Vector((math.sin(theta) * math.cos(phi), math.sin(theta) * math.sin(phi), math.cos(theta)))


def _aim(scene, shot: dict, target: Vector) -> None:
    """Adds an orthographic camera, so that a plane is seen from a single direction."""
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.data.type, camera.data.ortho_scale = "ORTHO", shot["tiles"] * PERIOD
    toward = _direction(shot["view"])
    camera.location = target + 30 * PERIOD * toward
    camera.rotation_euler = toward.to_track_quat("Z", "Y").to_euler()
    scene.collection.objects.link(camera)
    scene.camera = camera


def _light(scene, shot: dict) -> None:
    sun = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
    sun.data.energy, sun.data.angle = SUN, 0.0
    sun.rotation_euler = _direction(shot["sun"]).to_track_quat("Z", "Y").to_euler()
    scene.collection.objects.link(sun)
    world = scene.world = bpy.data.worlds.new("World")
    world.use_nodes = True
    background = next(n for n in world.node_tree.nodes if n.bl_idname == "ShaderNodeBackground")
    background.inputs["Color"].default_value = (*np.full(3, shot["sky"]), 1)


if __name__ == "__main__":
    main(json.loads(sys.argv[sys.argv.index("--") + 1]))
