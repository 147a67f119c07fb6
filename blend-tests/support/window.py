"""Tests in a window: they run in turns of Blender's event loop, and look at what it shows.

A test is a generator that yields the seconds until its next turn.
"""

import importlib
import io
import os
import sys
import time
import traceback
from pathlib import Path

import bpy
import numpy as np

from . import framebuffer, report, scenes
from .blender import ADDON

_TEST_SECONDS = 400  # limit of one test on a busy machine; its process has 600


def run(folder, tests, left_out=(), reason="", seconds=_TEST_SECONDS, viewport=False):
    """Starts the tests one after the other, each of so many seconds at most, and writes the report. Those
    `left_out` for a `reason` count as skipped. `viewport`: they see Blender's 3D viewport."""
    sys.stderr = _Watched(sys.stderr)
    runner = _Runner(folder, tests, seconds, viewport)
    runner.found = [report.Test(test.__name__, report.SKIPPED, reason=reason) for test in left_out]
    bpy.app.timers.register(runner.turn, first_interval=0.2, persistent=True)  # over file loads


class _Watched(io.TextIOBase):
    """Where Blender prints the exceptions of panels and handlers that it goes on after: counts them."""

    def __init__(self, stream):
        self._stream, self.exceptions = stream, 0

    def write(self, text):
        self.exceptions += text.count("Traceback (most recent call last)")
        return self._stream.write(text)

    def flush(self):
        self._stream.flush()


class _Runner:
    def __init__(self, folder, tests, seconds, viewport):
        self.folder, self.tests, self.seconds, self.viewport = folder, list(tests), seconds, viewport
        self.found = []
        self.current = None

    def turn(self):
        """Blender calls this again after the seconds that it returns."""
        try:
            if self.current is None:
                if not self.tests:
                    report.write(self.folder, self.found)
                    return None
                self._begin(self.tests.pop(0))
            if time.monotonic() > self.end:
                self.current.throw(TimeoutError(f"it has not ended within {self.seconds} s"))
            return next(self.current)
        except StopIteration:
            self._end(report.FAILED if sys.stderr.exceptions > self.exceptions else report.PASSED)
        except Exception:
            traceback.print_exc(file=sys.stdout)
            self._end(report.FAILED)
        return 0.1

    def _begin(self, test):
        self.name, self.clock, self.exceptions = test.__name__, report.Clock(), sys.stderr.exceptions
        self.end = time.monotonic() + self.seconds
        fresh_file(self.viewport)
        self.current = test(self.folder)

    def _end(self, outcome):
        self.found.append(report.Test(self.name, outcome, *self.clock.read()))
        print(f"{self.name} ... {outcome}, {self.found[-1].seconds:.1f} s", flush=True)
        self.current = None


def fresh_file(viewport=False):
    """Blender's own start, with a 3D viewport for those who look at it: without a graphics card that takes
    0.2 of the 0.3 s of a redraw."""
    bpy.ops.wm.read_homefile(use_factory_startup=True)
    bpy.context.preferences.system.viewport_aa = "OFF"
    if not viewport:
        next(area for area in first().screen.areas if area.type == "VIEW_3D").type = "TEXT_EDITOR"


def first():
    return bpy.context.window_manager.windows[0]


def in_context(**members):
    """temp_override() as the add-on itself may use it beside its threads."""
    return importlib.import_module(f"{ADDON}.export.other_context").other_context(**members)


def override():
    window = first()
    return in_context(window=window, screen=window.screen)


def until(holds, what, seconds=120):
    """The turns until `holds()`: how long that takes depends on what else the machine does."""
    end = time.monotonic() + seconds
    while not holds():
        assert time.monotonic() < end, f"after {seconds} s still not: {what}"
        yield 0.05


def at_rest():
    """The turns until nothing is read, runs or is queued."""
    state = bpy.context.window_manager.velour
    yield 0.1
    yield from until(lambda: not (state.reading or state.running or state.waiting), "all jobs have ended")


def show_properties(tab):
    """A large Properties editor in place of the 3D viewport."""
    scenes.use_engine()
    area = max(first().screen.areas, key=lambda a: a.width * a.height)
    area.type = "PROPERTIES"
    yield 0.3  # the tabs exist once the editor has been drawn
    area.spaces.active.context = tab
    yield 0.7


def open_panels(*names):
    """Opens panels of the Material tab, before it is first drawn: no script can change the state that Blender
    remembers after that. All panels are registered again, because a panel finds its parent then."""
    ui = importlib.import_module(f"{ADDON}.ui")
    panels = [panel for panel in ui.CLASSES if getattr(panel, "bl_context", "") == "material"]
    for panel in reversed(panels):
        bpy.utils.unregister_class(panel)
    for panel in panels:
        if panel.__name__.removeprefix("VELOUR_MATERIAL_PT_") in names:
            panel.bl_options = set()
        bpy.utils.register_class(panel)


def choose_file(path):
    """In the file browser that is open, as by its button."""
    yield from _in_browser(lambda params: _fill(params, path), bpy.ops.file.execute)


def leave_browser():
    """Without a file."""
    yield from _in_browser(lambda params: None, bpy.ops.file.cancel)


def _fill(params, path):
    params.directory, params.filename = str(path.parent).encode(), path.name


def _in_browser(prepare, press):
    window, area = _browser()
    prepare(area.spaces.active.params)
    yield 1.5  # it reads the folder, and makes previews, which an end in their midst may crash
    region = next(region for region in area.regions if region.type == "WINDOW")
    with in_context(window=window, area=area, region=region):
        press()
    yield 0.5


def _browser():
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "FILE_BROWSER":
                return window, area
    raise AssertionError("no file browser is open")


def scroll_down(pixels):
    """The largest editor."""
    area = max(first().screen.areas, key=lambda a: a.width * a.height)
    region = next(region for region in area.regions if region.type == "WINDOW")
    with in_context(window=first(), area=area, region=region):
        bpy.ops.view2d.scroll_down(deltay=pixels)


def scroll_to_end():
    """In steps: Blender does not scroll beyond what is drawn."""
    for _ in range(5):
        scroll_down(600)


def screenshot(folder, name):
    """[height x width x 3] in [0, 1], of what the window shows; a picture of nothing fails.

    From the screen, which the window fills: since Blender 4 its own screenshots are black under Mesa.
    """
    shown = pixels(folder)
    framebuffer.write_png(folder / f"{name}.png", shown)
    shown = shown / np.float32(255)
    assert shown.std() > 0.02, "the screenshot is uniform"
    return shown


def pixels(folder):
    """[height x width x 3] bytes of what the window shows, the lowest row first."""
    with override():
        bpy.ops.wm.redraw_timer(type="DRAW_WIN_SWAP", iterations=1)
    # Where Xvfb keeps it: in the folder of the test unless somebody else started the server.
    return framebuffer.at_rest(Path(os.environ.get("VELOUR_SCREEN", folder)) / framebuffer.FILE)


def shown(name):
    """The turns until the second window has an Image Editor that shows the image of that name."""
    windows = bpy.context.window_manager.windows
    for _ in range(100):
        yield 0.1
        area = windows[1].screen.areas[0] if len(windows) > 1 else None
        if area and area.type == "IMAGE_EDITOR" and getattr(area.spaces.active.image, "name", "") == name:
            yield 1.0  # until it is drawn, all of it in view
            return
    raise AssertionError(f"no Image Editor shows {name}")


def timed(function, seconds):
    """`function`, which appends the main thread's own seconds of each call."""

    def measured(*arguments):
        start = time.thread_time()
        try:
            return function(*arguments)
        finally:
            seconds.append(time.thread_time() - start)

    return measured
