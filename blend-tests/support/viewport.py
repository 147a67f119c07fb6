"""The rendered viewport under test."""

import time
from unittest import mock

import bpy
import numpy as np

from . import inputs, scenes, window

TURN = 0.05
_PATIENCE = 60  # seconds; the machine may be busy


addon = inputs.module


def area():
    return next(area for area in window.first().screen.areas if area.type == "VIEW_3D")


def region():
    return next(region for region in area().regions if region.type == "WINDOW")


def space():
    return area().spaces.active


def override():
    view = area()
    return window.in_context(window=window.first(), area=view, region=region())


def colored_scene():
    """An orange cube, which it returns, below a blue sky."""
    scenes.set_world((0.5, 0.7, 1.0), 0.5)
    cube = bpy.data.objects["Cube"]
    cube.active_material = scenes.diffuse_material((0.8, 0.3, 0.1))
    return cube


def show(samples=64):
    """Switches the viewport on; overlays and widgets off, so that pixels are the picture's."""
    scene = scenes.use_engine(samples)
    scene.velour.viewport_samples, scene.velour.use_viewport_denoising = samples, False
    view = space()
    view.overlay.show_overlays = view.show_gizmo = False
    view.shading.type = "RENDERED"
    return view


def show_real_time():
    """The same by the graphics processor; pixels are large, for here that is the processor."""
    scene = bpy.context.scene
    scene.velour.viewport_mode, scene.render.preview_pixel_size = "REAL_TIME", "4"
    show()


def few_images():
    """Within it, real time averages four images, which suffices where edges may be rough: here the processor
    draws each for tenths of a second."""
    return mock.patch.object(addon("realtime.drawing"), "PICTURES", 4)


def _shown():
    """The Viewports of engines that Blender has."""
    return [viewport for viewport in addon("engine.viewport")._all if viewport._engine()]


def the_one():
    """The Viewport of the only 3D viewport."""
    (found,) = _shown()
    return found


def real_time():
    """The RealtimeViewport of the only 3D viewport; None: it is not in real time."""
    found = _shown()
    return found[0]._real_time if found else None


def _is_drawn():
    shown = real_time()
    if shown is None or shown._live is None:
        return False
    return shown._drawing._targets is not None and not shown._drawing.is_waiting()


def real_time_finished(patience=_PATIENCE):
    """Turns until all of a picture in real time is on the screen."""
    yield from until(_is_drawn, "nothing is drawn in real time", patience)
    yield 0.3


def choose_real_time_again():
    """What was refused is there now."""
    bpy.context.scene.velour.viewport_mode = "RAY_TRACED"
    yield from finished()
    bpy.context.scene.velour.viewport_mode = "REAL_TIME"
    with few_images():
        yield from real_time_finished()
    assert not the_one()._refusal


def job():
    """The library's ProgressiveJob of the only 3D viewport."""
    return the_one()._job._job


def shown_picture():
    """Its ViewportPicture."""
    return the_one()._job.picture


def samples():
    """Number of samples of the picture on the screen. 0: there is none."""
    found = _shown()
    return found[0]._job.picture.samples if found else 0


def is_seen():
    """Whether there was any picture, coarse as it may be."""
    return shown_picture().shown_at > 0


def is_idle():
    return not addon("engine.viewport_clock").viewports()


def until(is_true, what, patience=_PATIENCE):
    """Turns until `is_true()`."""
    end = time.monotonic() + patience
    while not is_true():
        assert time.monotonic() < end, what
        yield TURN


def finished():
    """Turns until the viewport has all of its samples on the screen."""
    yield 0.15
    yield from until(is_idle, "the viewport does not come to its end")
    yield 0.15


def seen(last, what):
    """Turns until the viewport shows something else than the pixels `last`, all of its samples."""
    yield from until(lambda: samples() and not np.array_equal(pixels(), last), f"{what} is not seen")
    yield from finished()


def pixels():
    """[height x width x 4] scene-linear, of what the viewport shows."""
    picture = shown_picture()
    width, height = picture._size
    return picture._pixels[: 4 * width * height].reshape(height, width, 4).copy()


def middle(screenshot, half=20):
    """The middle of the 3D viewport on a screenshot."""
    view = region()
    x, y = view.x + view.width // 2, view.y + view.height // 2
    return screenshot[y - half : y + half, x - half : x + half]


def shape(screenshot):
    """Where the middle of the viewport differs from its upper left: the cube."""
    view = region()
    part = screenshot[view.y + 60 : view.y + view.height - 120, view.x + 100 : view.x + view.width - 100]
    return np.abs(part - part[-1, 0]).max(-1) > 0.08


def text_width(folder, name):
    """Pixels of the longest line at the top of the viewport, which shows nothing else there."""
    overlay, view = space().overlay, region()
    overlay.show_overlays = overlay.show_text = True
    overlay.show_floor = overlay.show_axis_x = overlay.show_axis_y = overlay.show_cursor = False
    shown = window.screenshot(folder, name)
    overlay.show_overlays = False
    top = shown[view.y + view.height - 200 : view.y + view.height - 60, view.x :][:, : view.width]
    is_text = (top.min(axis=2) > 0.7).any(axis=0)
    columns = np.flatnonzero(is_text[100 : view.width - 100])  # without tools and buttons
    return int(columns.max() - columns.min()) if len(columns) else 0
