"""Blender's camera as a screen window: left, right, bottom, top."""

from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from .aperture import aperture
from .axes import unscaled
from .newer import UNKNOWN
from .notes import ExportError


class View(NamedTuple):
    """Keywords of Scene.set_camera, and the image size in pixels."""

    kind: str
    camera_to_world: np.ndarray
    window: tuple
    clip_start: float
    clip_end: float
    width: int
    height: int
    lens: dict  # aperture keywords; empty: no depth of field
    motion: dict = MappingProxyType({})  # keywords of motion and shutter (Motion.on); empty: no motion
    camera: str = ""  # name of the camera object; empty: a viewport's own view

    def add_to(self, scene):
        clips = {"clip_start": self.clip_start, "clip_end": self.clip_end}
        scene.set_camera(self.kind, self.camera_to_world, self.window, **clips, **self.lens, **self.motion)

    def along_axes(self, directions):
        """World directions [n x 3] along the camera's axes: right, up and into the scene."""
        axes = self.camera_to_world[:, :3] * np.array((1, 1, -1), np.float32)
        return directions @ np.linalg.pinv(axes).T  # a flattened camera's axes may be coplanar


def render_camera(engine):
    """The camera of a render: that of a Scene strip or of a viewport's Use Local Camera, else the scene's.

    None if there is none. An original object, which stays valid when the frame changes.
    """
    camera = engine.camera_override
    return camera and camera.original


def final_view(depsgraph, whole=False, camera=None):
    """View of a final render: its camera, the film size and, unless `whole`, the render border.

    `camera`: see render_camera(); None: the one that the scene has at its current frame.
    """
    scene = depsgraph.scene_eval
    camera = camera or scene.camera
    if camera is None:
        raise ExportError(
            f"Scene '{scene.name}' has no camera; add one, or choose one in its Scene properties."
        )
    camera = camera.evaluated_get(depsgraph)
    if camera.type != "CAMERA":
        raise ExportError(
            f"Camera '{camera.name}' is not a camera object; choose one in the Scene properties."
        )
    lens = camera.data
    if lens.type not in _WINDOWS:
        kind = f"{lens.type.lower()} cameras are" if lens.type else f"its type is {UNKNOWN} and"
        raise ExportError(
            f"Camera '{camera.name}': {kind} not supported; choose Perspective or Orthographic."
        )
    size = _full_size(scene.render)
    window = _WINDOWS[lens.type](_projection(camera, depsgraph, scene.render, size))
    if not whole:
        window, size = _inside_border(window, size, scene.render)
    if not np.isfinite(camera.matrix_world).all():
        raise ExportError(f"Camera '{camera.name}': its transform is not finite; place it again.")
    kind = "perspective" if lens.type == "PERSP" else "orthographic"
    matrix, clips = unscaled(camera.matrix_world), (lens.clip_start, lens.clip_end)
    return View(kind, matrix, window, *clips, *size, aperture(camera, depsgraph), camera=camera.name)


def _full_size(render):
    """Image size in integer arithmetic, because 100 * 0.57 is slightly less than 57."""
    percentage = render.resolution_percentage
    return tuple(max(1, side * percentage // 100) for side in (render.resolution_x, render.resolution_y))


def _projection(camera, depsgraph, render, size):
    return camera.calc_matrix_camera(
        depsgraph, x=size[0], y=size[1], scale_x=render.pixel_aspect_x, scale_y=render.pixel_aspect_y
    )


def perspective_window(projection):
    """Window at z = -1; inverts x_ndc = (P00 x + P02 z) / -z for x_ndc = -1 and 1, likewise for y."""
    x, y = projection[0], projection[1]
    return (x[2] - 1) / x[0], (x[2] + 1) / x[0], (y[2] - 1) / y[1], (y[2] + 1) / y[1]


def orthographic_window(projection):
    """Window in meters; inverts x_ndc = P00 x + P03."""
    x, y = projection[0], projection[1]
    return (-1 - x[3]) / x[0], (1 - x[3]) / x[0], (-1 - y[3]) / y[1], (1 - y[3]) / y[1]


_WINDOWS = {"PERSP": perspective_window, "ORTHO": orthographic_window}


def _inside_border(window, size, render):
    """Window and film size cropped to the render border, rounded to whole pixels like Blender."""
    if not render.use_border:
        return window, size
    # In float32, like Blender: 0.9 * 120 then gives 108, although a float 0.9 is slightly less than 0.9.
    x0, x1 = (int(np.float32(b) * np.float32(size[0])) for b in (render.border_min_x, render.border_max_x))
    y0, y1 = (int(np.float32(b) * np.float32(size[1])) for b in (render.border_min_y, render.border_max_y))
    if x1 <= x0 or y1 <= y0:
        raise ExportError("The render region has no pixels; draw a larger one, or disable Render Region.")
    return inside(window, size, x0, y0, x1, y1)


def inside(window, size, x0, y0, x1, y1):
    """Crops a window of `size` pixels to a range of pixels; returns the new window and size."""
    left, right, bottom, top = window
    dx, dy = (right - left) / size[0], (top - bottom) / size[1]
    return (left + x0 * dx, left + x1 * dx, bottom + y0 * dy, bottom + y1 * dy), (x1 - x0, y1 - y0)
