"""Runs inside Blender: a model's approximation in Cycles, without and with normal map, against Velour."""

from __future__ import annotations

import json
import math
import sys
import time
from pathlib import Path

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "blend-tests"))

from support import scenes
from velour.core import normal_map
from velour.core.approximation import Steps
from velour.export.nodes import approximation_node
from velour.native import Model
from velour.operators import approximation_group

_SIZE, _SAMPLES = 192, 16
_ANGLES, _AZIMUTHS = (30, 60, 75), (0.4, 2.5)  # sun: degrees from the normal; radians


def main(task: dict) -> None:
    material, sun = _scene(task["model"])
    found = _approximate(material, task["model"])
    sockets = _unlinked(approximation_node(material).node_tree)
    folder = Path(task["report"]).parent
    found["by_angle"] = [_errors(material, sun, sockets, math.radians(a), folder) for a in _ANGLES]
    Path(task["report"]).write_text(json.dumps(found))


def _scene(model: str):
    """Two by two tiles, which fill the picture, lit only by a sun."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scenes.use_engine(samples=_SAMPLES, size=_SIZE)
    scenes.set_world(strength=0.0)
    scenes.add_camera(ortho_scale=2.0)
    plane = scenes.add_plane()
    sun = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
    sun.data.angle = 0
    bpy.context.scene.collection.objects.link(sun)
    bpy.ops.velour.load_material(filepath=model)
    placement = scenes.velour_node(plane.active_material).velour.placement
    placement.mode, placement.repeats = "REPEATS", (2, 2)
    cycles = bpy.context.scene.cycles
    cycles.samples, cycles.max_bounces, cycles.use_denoising = _SAMPLES, 0, False
    return plane.active_material, sun


def _approximate(material, path: str) -> dict:
    """Creates the approximation, always with a normal map. Returns its own error estimates and seconds."""
    decided, normal_map._LEAST_GAIN = normal_map._LEAST_GAIN, -math.inf
    model = Model.load(path)
    steps = Steps(model, approximation_group.has_layers())
    seconds = []
    while job := steps.next_job():
        begin = time.perf_counter()
        job.start().wait()
        seconds.append(time.perf_counter() - begin)
        last = job
    approximation_group.put(scenes.velour_node(material), material, steps.result, model.info())
    normals, without, with_map = last.result()
    return {
        "texels": steps.result.color_map.shape[1::-1],
        "judged": [without, with_map],
        "has_map": normals is not None and with_map <= (1 - decided) * without,
        "seconds": dict(zip(("fit", "colors", "normals"), seconds, strict=True)),
    }


def _unlinked(group) -> list:
    """Unlinks the normal maps; returns pairs of their output sockets and the inputs they were linked to."""
    links = [link for link in group.links if link.from_node.bl_idname == "ShaderNodeNormalMap"]
    sockets = [(link.from_socket, link.to_socket) for link in links]
    for link in links:
        group.links.remove(link)
    return sockets


def _errors(material, sun, sockets: list, angle: float, folder: Path) -> list[float]:
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
    return list(np.sqrt(squares[1:] / squares[0]))


def _picture(engine: str, folder: Path) -> np.ndarray:
    scene = bpy.context.scene
    scene.render.engine = engine
    scene.render.filepath, scene.render.image_settings.file_format = str(folder / "picture.exr"), "OPEN_EXR"
    bpy.ops.render.render(write_still=True)
    return scenes.read(folder / "picture.exr")[..., :3]


main(json.loads(sys.argv[sys.argv.index("--") + 1]))
