"""What the journeys of artists through a window share: the engine, the image at the end."""

from contextlib import contextmanager

import bpy
import numpy as np

from . import pointer, scenes, window
from .artist import Artist

SECONDS = 580  # limit of a test, on any machine
_RENDER_SECONDS = 300  # on any machine
_KNOWN = (3, 4)  # version whose menus the journeys know


def start(folder, journey):
    """Runs the one journey of a file."""
    reason = pointer.why_not()
    if bpy.app.version[:2] != _KNOWN:
        reason = f"the journeys know the menus of Blender {_KNOWN[0]}.{_KNOWN[1]}"
    left_out = [journey] if reason else []
    window.run(folder, [] if reason else [journey], left_out, reason, seconds=SECONDS, viewport=True)


@contextmanager
def artist_at(folder):
    """An Artist, whose sheet is written whatever happens."""
    artist = Artist(folder)
    try:
        yield artist
    except BaseException:
        artist.give_up()
        raise


def choose_engine(artist):
    """Three clicks."""
    yield from artist.click_tab("RENDER")
    yield from artist.click("Eevee", "PROPERTIES")
    yield from artist.click("Velour")
    yield from artist.until(lambda: bpy.context.scene.render.engine == "VELOUR", "the engine is chosen")


def no_job():
    state = bpy.context.window_manager.velour
    return not state.running and not state.waiting


def rendered(artist):
    """Presses F12 and waits for the image, [height x width x 4]."""
    ended = []
    handlers = (bpy.app.handlers.render_complete, bpy.app.handlers.render_cancel)
    notes = [lambda *_, what=what: ended.append(what) for what in ("complete", "canceled")]
    for handler, note in zip(handlers, notes, strict=True):
        handler.append(note)
    try:
        yield from artist.press("F12")
        yield from artist.until(lambda: ended, "the render ends", _RENDER_SECONDS)
    finally:
        for handler, note in zip(handlers, notes, strict=True):
            handler.remove(note)
    assert ended == ["complete"], ended
    yield from artist.until(lambda: not bpy.app.is_job_running("RENDER"), "the render is left")
    return _saved(artist.folder / "rendered.png")


def _saved(path):
    bpy.data.images["Render Result"].save_render(str(path))
    image = bpy.data.images.load(str(path))
    width, height = image.size
    pixels = np.empty(width * height * 4, np.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    return pixels.reshape(height, width, 4)


def assert_measured(obj, pixels):
    """The object wears a measured material with a model, and the image shows something."""
    material = obj.active_material
    assert material is not None, f"{obj.name} has no material"
    node = scenes.velour_node(material)
    assert node is not None, f"{material.name} is not a measured material"
    assert node.image is not None, f"{material.name} has no model"
    assert pixels[..., :3].std() > 0.02, "the image is uniform"
