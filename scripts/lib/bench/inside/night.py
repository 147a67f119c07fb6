"""The shot of a whole night on a farm: measured paint, cloth, glass, motion blur and two view layers."""

import json
import logging
import math
import time

import bpy

from . import FRAME_MARK
from . import scene as build

_BOUNCES = 4
_SHUTTER = 0.5  # frames
_CLOTH_CELLS = 24  # along a side
_FAR = 40.0


def main(task):
    """Saves the .blend of `frames` frames."""
    scene = build.empty(task["size"], task["samples"], _BOUNCES)
    scene.frame_start, scene.frame_end = 1, task["frames"]
    scene.render.use_motion_blur = True
    scene.render.motion_blur_shutter = _SHUTTER
    scene.render.image_settings.file_format = "OPEN_EXR_MULTILAYER"
    scene.render.image_settings.color_depth = "32"
    scene.world = _studio(scene)
    _surroundings()
    _paint(task["frames"])
    cloth = _cloth(task["frames"])
    _glass(task["frames"])
    build.lamp("AREA", 160, (2.5, -3, 4), (0, 0, 0.5), size=1.2)
    build.lamp("POINT", 60, (-2.5, -2.5, 3), shadow_soft_size=0.1)
    build.camera((0, -9, 2.4), (0, 0, 0.9), lens=58)
    _without(scene, cloth)
    _animate(scene, "velour.seed", {1: 1, task["frames"]: task["frames"]})
    bpy.ops.wm.save_as_mainfile(filepath=task["blend"])


def _studio(scene):
    """The studio's world of the look scene, which is removed."""
    before = set(bpy.data.scenes)
    bpy.ops.velour.new_look()
    (look,) = set(bpy.data.scenes) - before
    world = look.world
    bpy.context.window.scene = scene
    bpy.data.scenes.remove(look)
    return world


def _surroundings():
    """A floor and a wall; nothing that moves comes near the left part of the picture."""
    gray = build.material("Gray", Base_Color=(0.35, 0.34, 0.33), Roughness=0.8)
    floor = [(-_FAR, -_FAR, 0), (_FAR, -_FAR, 0), (_FAR, 3, 0), (-_FAR, 3, 0)]
    wall = [(-_FAR, 3, 0), (_FAR, 3, 0), (_FAR, 3, _FAR), (-_FAR, 3, _FAR)]
    build.polygons("Surroundings", floor + wall, [(0, 1, 2, 3), (4, 5, 6, 7)], gray)


def _paint(frames):
    """A monkey in car paint, which turns from a grazing view to one that faces the camera, and on.

    Flat: Blender 3.4 adds up the normals of large smooth meshes in the order in which its threads come.
    """
    obj = build.monkey(1.5, (-10, 0), levels=3)
    bpy.ops.object.shade_flat()
    obj.location = (0.2, 0.6, 1.0)
    bpy.ops.velour.add_preset(preset="Midnight Car Paint", object=obj.name)
    _animate(obj, "rotation_euler", {1: math.radians(-85), frames: math.radians(85)}, index=2)


def _cloth(frames):
    """A hanging cloth with the silhouette of its yarns; waves run through it."""
    bpy.ops.mesh.primitive_grid_add(
        x_subdivisions=_CLOTH_CELLS, y_subdivisions=_CLOTH_CELLS, size=1.6, location=(2.0, 0.2, 1.0),
        rotation=(math.radians(80), 0, math.radians(-12)),
    )  # fmt: skip
    cloth = bpy.context.object
    cloth.name = "Cloth"
    bpy.ops.object.shade_smooth()
    bpy.ops.velour.add_preset(preset="Denim", object=cloth.name)
    cloth.shape_key_add(name="Basis")
    key = cloth.shape_key_add(name="Waves")
    for point in key.data:
        x, y, _ = point.co
        point.co.z = 0.14 * math.sin(5 * x + 2 * y)
        point.co.x += 0.05 * math.sin(4 * y)
    _animate(key, "value", {1: 0.0, 1 + frames // 2: 1.0, frames: 0.2})
    return cloth


def _glass(frames):
    """A glass ball that rolls along the floor."""
    glass = build.material("Glass", "BsdfGlass", Roughness=0.0, IOR=1.5)
    ball = build.ball((0, -1.6, 0.35), 0.35, glass, segments=32)
    _animate(ball, "location", {1: 0.0, frames: 1.6}, index=0)


def _without(scene, obj):
    """A second view layer, which leaves an object out."""
    own = bpy.data.collections.new(obj.name)
    scene.collection.children.link(own)
    scene.collection.objects.unlink(obj)
    own.objects.link(obj)
    layer = scene.view_layers.new(f"Without {obj.name}")
    layer.layer_collection.children[own.name].exclude = True


def _animate(owner, path, values, index=-1):
    """Linear keyframes: `values` by frame. `owner`: a data-block, or a part of one."""
    scope, _, name = path.rpartition(".")
    part = owner.path_resolve(scope) if scope else owner
    for frame, value in values.items():
        if index < 0:
            setattr(part, name, value)
        else:
            getattr(part, name)[index] = value
        part.keyframe_insert(name, index=index, frame=frame)
    for curve in part.id_data.animation_data.action.fcurves:
        for point in curve.keyframe_points:
            point.interpolation = "LINEAR"


def listen():
    """Makes Blender print a line for each frame that it renders: seconds, rays and samples of all its view
    layers, and the memory of the process afterwards."""
    listener = _Listener()
    log = logging.getLogger("velour.engine")
    log.setLevel(logging.INFO)
    log.addHandler(listener)
    bpy.app.handlers.render_pre.append(listener.begin)
    bpy.app.handlers.render_write.append(listener.end)


class _Listener(logging.Handler):
    def __init__(self):
        super().__init__()
        self._reports, self._start = [], 0.0

    def emit(self, record):
        if isinstance(record.args, dict):
            self._reports.append(dict(record.args))

    def begin(self, *_):
        self._reports, self._start = [], time.monotonic()

    def end(self, scene, *_):
        found = {
            "frame": scene.frame_current,
            "seconds": time.monotonic() - self._start,
            "rays": sum(report["rays"] for report in self._reports),
            "noise": max(report["noise"] for report in self._reports),
            "tracing": sum(report["seconds"] for report in self._reports),
            "nan_samples": sum(report["nan_samples"] for report in self._reports),
            **_memory(),
        }
        print(f"{FRAME_MARK}{json.dumps(found)}", flush=True)


def _memory():
    with open("/proc/self/status", encoding="ascii") as file:
        fields = dict(line.split(":", 1) for line in file)
    return {name: int(fields[key].split()[0]) / 1024 for name, key in (("mib", "VmRSS"), ("peak", "VmHWM"))}
