"""The plots of the material panel in a window."""

import bpy
import numpy as np

from . import inputs, scenes, window

_SECONDS = 20
_TURNS = 20  # of a wheel
_CLOSE = 8  # of 255: rounding of the theme's colors, which are mixed again on the way to the screen


def preview():
    return inputs.module("ui.plot_preview")


def material(data=None):
    """The cube's, with a measurement and a model: `data`, or a coarse fit."""
    material = scenes.measured_material(data or inputs.model_bytes(inputs.glossy_measurement()))
    image = bpy.data.images.new("glossy.binary", 1, 1)
    image.source, image.filepath_raw = "FILE", str(inputs.glossy_measurement())
    scenes.velour_node(material).velour.measurement = image
    cube = bpy.context.view_layer.objects["Cube"]
    cube.active_material = material
    bpy.context.view_layer.objects.active = cube
    return material


def show(kind, scroll=15):
    """The large editor, scrolled down by so many turns of a wheel, and the small one, once both are drawn."""
    bpy.context.window_manager.velour.plot.kind = kind
    small = next(area for area in window.first().screen.areas if area.type == "PROPERTIES")
    small.spaces.active.context = "MATERIAL"
    yield from window.show_properties("MATERIAL")
    for _ in range(scroll):
        window.scroll_down(40)
    yield from drawn()


def drawn():
    """The turns until nothing is left to draw."""
    yield 0.5
    for _ in range(10 * _SECONDS):
        if preview().is_at_rest() and preview()._pictures:
            break
        yield 0.1
    yield 0.5


def screenshot(folder, name, picture):
    """Screenshot of the window, its large editor scrolled down to show the whole picture, or to the end."""
    for _ in range(_TURNS):
        screen = window.screenshot(folder, name)
        if is_on_screen(screen, picture):
            break
        window.scroll_down(40)
        yield 0.1
    return screen


def pictures():
    """The pixels [side x side x 3] of all plots that are there, as bytes."""
    made = [made for made in preview()._pictures.values() if made.name]
    return [_pixels(preview()._previews[m.name]) for m in made]


def _pixels(preview):
    side = preview.image_size[0]
    pixels = np.empty(side * side * 4, np.float32)
    preview.image_pixels_float.foreach_get(pixels)
    return np.rint(255 * pixels.reshape(side, side, 4)[..., :3]).astype(np.int16)


def is_on_screen(screen, picture):
    """Whether the picture is on the screen [height x width x 3], every pixel where it belongs."""
    screen = np.rint(255 * screen).astype(np.int16)
    side = len(picture)
    room = screen.shape[0] - side + 1, screen.shape[1] - side + 1
    marks = np.argwhere(np.abs(picture - picture[0, 0]).max(axis=2) > 60)
    places = np.ones(room, bool)
    for y, x in marks[:: max(1, len(marks) // 40)]:
        at = screen[y : y + room[0], x : x + room[1]]
        places &= np.abs(at - picture[y, x]).max(axis=2) <= _CLOSE
    return any(
        (np.abs(screen[y : y + side, x : x + side] - picture).max(axis=2) <= _CLOSE).mean() > 0.999
        for y, x in np.argwhere(places)[:10]
    )
