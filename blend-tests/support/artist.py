"""An artist at a window of Blender: reads the screen, clicks what is written there, and types.

Methods that take time are turns of a test in a window: they wait until what they look for is shown.
"""

import json
import os
import re
import time
from pathlib import Path

import blf
import bpy
import gpu
import numpy as np
from mathutils import Matrix

from . import contact_sheet, framebuffer, on_screen, pointer, window
from .on_screen import Box
from .stopwatch import Stopwatch

_TURN = 0.1  # seconds between two looks
_PATIENCE = 30  # seconds, on a machine that does nothing else
_LOOKS_PER_SCROLL = 8
_NOTCHES = 3  # of the wheel
_SHEET = "journey"


class Artist:
    """Counts clicks, with a key or a typed text as one each, and keeps a picture of each."""

    def __init__(self, folder):
        self.folder, self.clicks, self.clock = folder, 0, Stopwatch()
        self._hand, self._steps = pointer.Pointer(), []
        self._screen = Path(os.environ["VELOUR_SCREEN"]) / framebuffer.FILE

    def click(self, text, area=None):
        """What has this text. area: type of the editor that shows it; None: anywhere."""
        x, y = yield from self.look_for(text, area)
        yield from self._click_at(x, y, text)

    def click_tab(self, name):
        """A tab of the Properties editor, by the name of its context."""

        def place():
            editor = _editor("PROPERTIES")
            names, found = _tabs(editor.spaces.active), on_screen.icons(self._gray(), _bar(editor))
            return found[names.index(name)] if name in names and len(found) == len(names) else None

        x, y = yield from self._at_rest(place, f"the tab {name} of the Properties editor")
        yield from self._click_at(x, y, f"tab {name.title()}")

    def press(self, key, area="VIEW_3D"):
        """A key, with the pointer over an editor."""
        x, y = yield from self._point_at(area)
        self._note(f"key {key}", x, y)
        self._hand.key(key)
        self.clicks += 1
        yield _TURN

    def sees(self, text, area=None):
        """The on_screen.Place of a text, or None."""
        found = on_screen.find(self._gray(), *letters_of(text), _box(area))
        return found[0] if found else None

    def until(self, holds, what, seconds=_PATIENCE):
        yield from window.until(holds, what, seconds)

    def finish(self, clicks, seconds):
        """Writes the sheet of all steps; fails beyond these limits."""
        took = self.clock.seconds()
        yield 2 * _TURN
        self._note(f"end: {self.clicks} clicks, {took:.0f} s")
        self._write()
        print(f"{self.folder.name}: {self.clicks} clicks of {clicks}, {took:.1f} s of {seconds}", flush=True)
        assert self.clicks <= clicks, f"{self.clicks} clicks, {clicks} are allowed"
        assert took <= seconds, f"{took:.1f} s, {seconds} are allowed"

    def give_up(self):
        """Writes the sheet up to here."""
        self._note("where it failed")
        self._write()

    def _write(self):
        pictures = [pixels for pixels, _ in self._steps]
        captions = [_drawn(caption) for _, caption in self._steps]
        contact_sheet.write(self.folder, _SHEET, contact_sheet.sheet(pictures, captions))
        told = [caption for _, caption in self._steps]
        (self.folder / f"{_SHEET}.json").write_text(json.dumps(told, indent=1))
        self._hand.close()

    def look_for(self, text, area):
        """The place of a text; scrolls the editor until it is there."""
        letters, margin = letters_of(text)
        looks = 0

        def place():
            nonlocal looks
            looks += 1
            found = on_screen.find(self._gray(), letters, margin, _box(area))
            if not found and area and looks % _LOOKS_PER_SCROLL == 0:
                self._scroll(area)
            return found[0][:2] if len(found) == 1 else None

        where = f" in {area}" if area else ""
        return (yield from self._at_rest(place, f"the text {text!r}{where}, once"))

    def _at_rest(self, place, what):
        """Turns until `place()` is the same twice."""
        end, last = time.monotonic() + _PATIENCE, None
        while True:
            found = place()
            if found is not None and found == last:
                return found
            last = found
            assert time.monotonic() < end, f"after {_PATIENCE} s the screen still does not show {what}"
            yield _TURN

    def _click_at(self, x, y, caption):
        self._note(caption, x, y)
        self._move(x, y)
        yield _TURN
        self._hand.press()
        self.clicks += 1
        yield _TURN

    def _point_at(self, area):
        box = _box(area)
        x, y = box.left + box.width // 2, box.bottom + box.height // 2
        self._move(x, y)
        yield _TURN
        return x, y

    def _scroll(self, area):
        box = _box(area)
        self._move(box.left + box.width // 2, box.bottom + box.height // 2)
        for _ in range(_NOTCHES):
            self._hand.press(pointer.WHEEL_DOWN)

    def _move(self, x, y):
        self._hand.move(x, self._look().shape[0] - 1 - y)

    def _note(self, caption, x=None, y=None):
        pixels = self._look()
        if x is not None:
            pixels = contact_sheet.marked(pixels, x, y)
        self._steps.append((pixels, f"{len(self._steps) + 1}. {caption}   {self.clock.seconds():.0f} s"))

    def _look(self):
        """[height x width x 3] bytes of the whole screen, the lowest row first."""
        return framebuffer.read(self._screen)

    def _gray(self):
        return on_screen.gray(self._look())


def _editor(kind):
    """The largest editor of a type in the first window, which fills the screen."""
    areas = [area for area in window.first().screen.areas if area.type == kind]
    return max(areas, key=lambda area: area.width * area.height)


def _box(area):
    if area is None:
        return None
    editor = _editor(area)
    return Box(editor.x, editor.y, editor.width, editor.height)


def _bar(editor):
    """The column of tabs."""
    region = next(region for region in editor.regions if region.type == "NAVIGATION_BAR")
    return Box(region.x, region.y, region.width, region.height)


def _tabs(space):
    """Contexts of the tabs that a Properties editor has now: its error names them."""
    try:
        space.context = "none of them"
    except TypeError as error:
        return re.findall(r"'([A-Z_]+)'", str(error).partition("not found in")[2])
    raise AssertionError("a tab is called so")


def letters_of(text):
    """What on_screen.find() needs of a text: its letters as buttons show them, and the margin beside them."""
    drawn = _drawn(text)
    rows, columns = np.flatnonzero(drawn.any(axis=1)), np.flatnonzero(drawn.any(axis=0))
    space = blf.dimensions(0, "a a")[0] - blf.dimensions(0, "aa")[0]
    return drawn[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1], 2 * round(space)


def _drawn(text):
    """[height x width] in [0, 1] of a text in the font and the size of Blender's buttons."""
    preferences = bpy.context.preferences
    points = preferences.ui_styles[0].widget.points * preferences.system.ui_scale
    blf.size(0, points)
    width, height = int(blf.dimensions(0, text)[0]) + 8, int(2 * points)
    target = gpu.types.GPUOffScreen(width, height)
    try:
        with target.bind():
            frame = gpu.state.active_framebuffer_get()
            frame.clear(color=(0.0, 0.0, 0.0, 1.0))
            with gpu.matrix.push_pop(), gpu.matrix.push_pop_projection():
                gpu.matrix.load_matrix(Matrix.Identity(4))
                gpu.matrix.load_projection_matrix(_pixels_of(width, height))
                gpu.state.blend_set("ALPHA")
                blf.color(0, 1.0, 1.0, 1.0, 1.0)
                blf.position(0, 4, round(0.6 * points), 0)
                blf.draw(0, text)
                gpu.state.blend_set("NONE")
            read = frame.read_color(0, 0, width, height, 4, 0, "UBYTE")
    finally:
        target.free()
    read.dimensions = width * height * 4
    return np.array(read, np.uint8).reshape(height, width, 4)[..., 0] / np.float32(255)


def _pixels_of(width, height):
    """Projection with a unit a pixel, offset as in Blender's interface."""
    offset = 0.01
    x, y = 2 / width, 2 / height
    return Matrix(
        (
            (x, 0, 0, -1 + offset * x),
            (0, y, 0, -1 + offset * y),
            (0, 0, -0.01, 0),
            (0, 0, 0, 1),
        )
    )
