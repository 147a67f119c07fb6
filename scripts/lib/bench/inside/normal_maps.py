"""A model's approximation in Cycles, without and with normal map, against Velour."""

import math
import tempfile
import time
from pathlib import Path

import bpy
import numpy as np
from support import scenes
from velour.core import normal_map
from velour.export.nodes import approximation_node
from velour.native import Model
from velour.operators import approximation_group

from . import scene as build

_SIZE, _SAMPLES = 192, 16
_ANGLES, _AZIMUTHS = (30, 60, 75), (0.4, 2.5)  # sun: degrees from the normal; radians


def main(task):
    material, sun = _scene(task["model"])
    found = _approximate(material, task["model"])
    sockets = _unlinked(approximation_node(material).node_tree)
    with tempfile.TemporaryDirectory(prefix="velour-maps-") as folder:
        errors = [_errors(material, sun, sockets, math.radians(a), Path(folder)) for a in _ANGLES]
    return found | {"by_angle": errors}


def _scene(model):
    """Two by two tiles, which fill the picture, lit only by a sun."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scenes.use_engine(samples=_SAMPLES, size=_SIZE)
    scenes.set_world(strength=0.0)
    scenes.add_camera(ortho_scale=2.0)
    plane = scenes.add_plane()
    sun = build.lamp("SUN", 1.0, angle=0)
    bpy.ops.velour.load_material(filepath=model)
    placement = scenes.velour_node(plane.active_material).velour.placement
    placement.mode, placement.repeats = "REPEATS", (2, 2)
    cycles = bpy.context.scene.cycles
    cycles.samples, cycles.max_bounces, cycles.use_denoising = _SAMPLES, 0, False
    return plane.active_material, sun


def _approximate(material, path):
    """Creates the approximation, always with a normal map. Returns its own error estimates and seconds."""
    decided, normal_map._LEAST_GAIN = normal_map._LEAST_GAIN, -math.inf
    opened = Model.load(path)
    steps = approximation_group.steps(opened)
    seconds = dict.fromkeys(("fit", "colors", "normals"), 0.0)
    # The fit and the colors take two jobs each: the first tabulates the model.
    for step in ("fit", "fit", "colors", "colors", "normals"):
        begin, job = time.perf_counter(), steps.next_job()
        job.start().wait()
        seconds[step] += time.perf_counter() - begin
    steps.next_job()
    approximation_group.put(build.measured_node(material), material, steps.result, opened.info())
    normals, without, with_map = job.result()
    return {
        "texels": steps.result.color_map.shape[1::-1],
        "judged": [without, with_map],
        "has_map": normals is not None and with_map <= (1 - decided) * without,
        "seconds": seconds,
    }


def _unlinked(group):
    """Unlinks the normal maps; returns pairs of their output sockets and the inputs they were linked to."""
    links = [link for link in group.links if link.from_node.bl_idname == "ShaderNodeNormalMap"]
    sockets = [(link.from_socket, link.to_socket) for link in links]
    for link in links:
        group.links.remove(link)
    return sockets


def _errors(material, sun, sockets, angle, folder):
    """Relative root mean square errors without and with the normal map."""
    group, squares = approximation_node(material).node_tree, np.zeros(3)
    for azimuth in _AZIMUTHS:
        sun.rotation_euler = 0, angle, azimuth
        truth, without = _picture("VELOUR", folder), _picture("CYCLES", folder)
        for pair in sockets:
            group.links.new(*pair)
        with_map = _picture("CYCLES", folder)
        _unlinked(group)
        squares += [np.square(p).mean() for p in (truth, without - truth, with_map - truth)]
    return np.sqrt(squares[1:] / squares[0]).tolist()


def _picture(engine, folder):
    bpy.context.scene.render.engine = engine
    return scenes.render(folder)[..., :3]
