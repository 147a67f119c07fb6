"""Captures and compresses a tile; renders objects covered with its geometry, and the same objects with its
BTF and with the model of the BTF."""

import json
import math
import os

import bpy
from bench.inside import scene as build
from mathutils import Vector

from .tiled_objects import Cylinder, Plane, add_smooth, add_tiles

PERIOD = 1.0
SUN, SKY = 2.5, 0.25  # irradiance on a facing surface, radiance
# Views and lights: degrees from the normal of the plane (of the cylinder's topmost line), and around it.
# Those of "captured" belong to the sets of 81 and of 105 directions, so that nothing is interpolated.
SHOTS = {
    "captured": {"shape": "plane", "view": (45, 40), "sun": (30, 60), "sky": 0.0, "tiles": 2.5},
    "cylinder": {"shape": "cylinder", "view": (25, 0), "sun": (40, 120), "sky": SKY, "tiles": 7.2},
}
AROUND = 20  # tiles around the cylinder


def main(task):
    scene = build.empty((task["side"], task["side"]), task["samples"], task["capture"]["bounces"])
    scene.render.film_transparent = True
    folder = task["folder"]
    bpy.ops.velour.add_mesostructure(type=task["tile"], size=PERIOD, **task["options"])
    tile = bpy.context.object
    report = build.capture_and_compress(folder, task["capture"], task["megabytes"])
    height = _reference_height(tile, folder)
    shapes = {"plane": Plane(PERIOD, height), "cylinder": Cylinder(PERIOD, height, AROUND)}
    report["shots"] = {n: _take(tile, shapes[SHOTS[n]["shape"]], n, folder) for n in task["shots"]}
    return report


def _reference_height(tile, folder):
    """Height of the texels' reference plane above z = 0 of the tile."""
    with open(os.path.join(folder, f"{build.NAME}.btf", "btf.json")) as file:
        above_lowest = json.load(file)["shell"]["reference_height"]
    return min(vertex.co.z for vertex in tile.data.vertices) + above_lowest


def _take(tile, shape, name, folder):
    """Renders NAME-geometry, NAME-btf and NAME-model; returns the seconds of each render."""
    for obj in [obj for obj in bpy.data.objects if obj != tile]:
        bpy.data.objects.remove(obj)
    shot = SHOTS[name]
    # An orthographic camera sees a plane from a single direction.
    eye = shape.middle + 30 * PERIOD * _direction(shot["view"])
    build.camera(eye, shape.middle, type="ORTHO", ortho_scale=shot["tiles"] * PERIOD)
    build.lamp("SUN", SUN, _direction(shot["sun"]), (0, 0, 0), angle=0.0)
    build.world(color=(shot["sky"],) * 3)
    tile.hide_render = True
    copies = add_tiles(tile, shape)
    seconds = {"geometry": build.render(folder, f"{name}-geometry")["seconds"]}
    for copy in copies:
        bpy.data.objects.remove(copy)
    add_smooth(shape).data.materials.append(bpy.data.materials[build.NAME])
    node = build.measured_node(bpy.data.materials[build.NAME])
    for what, itself in (("btf", True), ("model", False)):
        node.velour.use_reference = itself
        seconds[what] = build.render(folder, f"{name}-{what}")["seconds"]
    return {"seconds": seconds}


def _direction(angles):
    theta, phi = (math.radians(a) for a in angles)
    return Vector((math.sin(theta) * math.cos(phi), math.sin(theta) * math.sin(phi), math.cos(theta)))
