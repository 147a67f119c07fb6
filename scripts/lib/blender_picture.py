"""Runs inside Blender: renders the scene into files and returns the engine's report."""

from __future__ import annotations

import logging
import os

import addon_utils
import bpy


def empty_scene(size: tuple[int, int], samples: int, bounces: int) -> bpy.types.Scene:
    """An empty scene for Velour, with the display transform that changes least."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    addon_utils.enable("velour", default_set=False, handle_error=_raise)
    scene = bpy.context.scene
    scene.render.engine = "VELOUR"
    scene.render.resolution_x, scene.render.resolution_y = size
    scene.view_settings.view_transform = "Standard"
    scene.velour.samples, scene.velour.bounces, scene.velour.seed = samples, bounces, 1
    return scene


def _raise(error):
    raise error


def measured_node(material: bpy.types.Material):
    """The material's MeasuredNode."""
    from velour.export.nodes import velour_node

    return velour_node(material)


def render_picture(scene: bpy.types.Scene, folder: str, name: str) -> dict:
    """Writes NAME.exr and NAME.png; returns the engine's report."""
    reports = _ReportHandler()
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
