"""The window as the guide shows it: a 3D viewport beside a tall Properties editor; pictures of its parts."""

from __future__ import annotations

from pathlib import Path

import bpy
import numpy as np
from support import framebuffer, inputs, scenes, window

from . import headers, panels

PROPERTIES_WIDTH = 440
WINDOW_HEIGHT = 660  # pictures of the whole window, including its top bar
_HEADER = 13  # half the height of a panel's header
_MARGIN = 6  # around panels in pictures
_PATIENCE = 1200  # maximum seconds of a job
_CLICKS = 5


def area(kind: str) -> bpy.types.Area:
    return next(area for area in window.first().screen.areas if area.type == kind)


def inside(kind: str):
    """A context override for the artist's actions in an editor."""
    editor = area(kind)
    return window.in_context(window=window.first(), area=editor, region=main_region(editor))


def main_region(editor: bpy.types.Area) -> bpy.types.Region:
    return next(region for region in editor.regions if region.type == "WINDOW")


class Desk:
    """Generator methods yield the seconds until their next turn in Blender's event loop."""

    def __init__(self, folder: Path):
        self.folder = folder

    def arrange(self):
        """Closes the Outliner, widens the Properties, and makes the viewport as high as window pictures."""
        with inside("OUTLINER"):
            bpy.ops.screen.area_close()
        yield 0.3
        properties = area("PROPERTIES")
        middle = properties.y + properties.height // 2
        yield from self._move_border(properties.x - 1, middle, properties.width - PROPERTIES_WIDTH)
        view = area("VIEW_3D")
        lower = window.first().height - WINDOW_HEIGHT
        yield from self._move_border(view.x + view.width // 2, view.y - 1, lower - view.y)

    def show(self, tab: str):
        """Shows a tab of the Properties editor."""
        area("PROPERTIES").spaces.active.context = tab
        yield 0.8
        yield from self._read()

    def fold(self, tab: str, label: str, is_open: bool):
        """Opens or closes a panel by clicking its header, repeatedly, since it may move during a redraw."""
        for _ in range(_CLICKS):
            header = next(place.header for place in self._places(tab, self._screen()) if place.label == label)
            if header.is_open == is_open:
                return
            x = main_region(area("PROPERTIES")).x + 90
            yield from self.click(x, window.first().height - 1 - header.row)
        raise TimeoutError(f"panel {label!r} of tab {tab} does not fold")

    def open_panels(self, *labels: str):
        """Opens panels of the Material tab, outer ones first."""
        for label in labels:
            yield from self.fold("MATERIAL", label, is_open=True)

    def click(self, x: int, y: int):
        """Clicks the left button at window coordinates."""
        for kind, value in (("MOUSEMOVE", "NOTHING"), ("LEFTMOUSE", "PRESS"), ("LEFTMOUSE", "RELEASE")):
            window.first().event_simulate(type=kind, value=value, x=x, y=y)
            yield 0.15
        yield 0.4

    def point(self, x: int, y: int):
        """Moves the mouse without a button."""
        window.first().event_simulate(type="MOUSEMOVE", value="NOTHING", x=x, y=y)
        yield 0.3

    def press(self, key: str, x: int, y: int):
        for value in ("PRESS", "RELEASE"):
            window.first().event_simulate(type=key, value=value, x=x, y=y)
            yield 0.15
        yield 0.4

    def plot(self, kind: str):
        """Selects a plot in the Plots panel and waits until it is drawn."""
        bpy.context.window_manager.velour.plot.kind = kind
        yield from self.drawn(kind)

    def drawn(self, kind: str):
        """Waits until the plot that a panel shows is drawn."""
        preview = inputs.module("ui.plot_preview")
        is_there = lambda: preview.is_at_rest() and any(p.kind == kind for p in preview._pictures)  # noqa: E731
        yield from self.until(is_there, f"the plot {kind}")
        yield from self._read()
        yield 0.8

    def _read(self):
        """Waits until panels have read the summaries of files."""
        summaries = inputs.module("ui.summaries")
        yield from self.until(summaries.is_at_rest, "what the panels read")

    def until(self, holds, what: str):
        """Redraws the Properties editor until something holds."""
        for _ in range(2 * _PATIENCE):
            area("PROPERTIES").tag_redraw()
            yield 0.4
            if holds():
                return
        raise TimeoutError(f"{what} is never there")

    def start(self, operator, **arguments):
        """Starts a long operator as its button does, in the context of the 3D viewport."""
        with inside("VIEW_3D"):
            state = operator("INVOKE_DEFAULT", **arguments)
        if state != {"RUNNING_MODAL"}:
            raise RuntimeError(f"{operator.idname()} did not start: {state}")

    def job(self, until: float = 2.0):
        """Waits until the job is done, or has reached the fraction `until`."""
        state = bpy.context.window_manager.velour
        for _ in range(10 * _PATIENCE):
            yield 0.1
            if not (state.running or state.waiting) or state.fraction >= until:
                return
        raise TimeoutError(f"{state.subject}: {state.stage} takes too long")

    def picture_of_panels(self, name: str, tab: str, first: str | None, last: str | None = None):
        """From the header of panel `first` (None: top of the tab) to the end of `last` (None: `first`)."""
        pixels = self._screen()
        found = self._places(tab, pixels)
        labels = [place.label for place in found]
        end = found[labels.index(last or first)].end
        region = main_region(area("PROPERTIES"))
        top = _top(pixels, region) if first is None else found[labels.index(first)].header.row - _HEADER - 1
        bottom = _last_row(pixels, region) + _MARGIN if end is None else end - _HEADER - 1
        self._write(name, pixels[top:bottom, region.x : region.x + region.width])

    def picture_of_editor(self, name: str, kind: str, height: int | None = None):
        """A picture of an area of the window, or of its upper `height` rows."""
        pixels, editor = self._screen(), area(kind)
        top = _top(pixels, editor)
        rows = slice(top, top + (height or editor.height))
        self._write(name, pixels[rows, editor.x : editor.x + editor.width])

    def picture_of_window(self, name: str, height: int | None = WINDOW_HEIGHT, width: int | None = None):
        self._write(name, self._screen()[:height, :width])

    def side_by_side(self, name: str, parts: list[str]):
        """Joins renders of equal size into one picture, side by side, and removes them."""
        paths = [self.folder / f"{part}.png" for part in parts]
        pixels = [(255 * scenes.read(path)[..., :3]).round().astype(np.uint8) for path in paths]
        for path in paths:
            path.unlink()
        framebuffer.write_png(self.folder / f"{name}.png", np.concatenate(pixels, axis=1))

    def _move_border(self, x: int, y: int, delta: int):
        yield from self.point(x, y)
        with window.override():
            bpy.ops.screen.area_move(x=x, y=y, delta=delta)
        yield 0.3

    def _places(self, tab: str, pixels) -> list[panels.Place]:
        region = main_region(area("PROPERTIES"))
        top = _top(pixels, region)
        strip = pixels[top : top + region.height, region.x : region.x + headers.STRIP]
        found = [header._replace(row=header.row + top) for header in headers.find(strip)]
        with inside("PROPERTIES"):
            return panels.places(tab, found)

    def _screen(self):
        """[height x width x 3] bytes, the top row first."""
        with window.override():
            bpy.ops.wm.redraw_timer(type="DRAW_WIN_SWAP", iterations=1)
        return framebuffer.at_rest(self.folder / framebuffer.FILE)[::-1]

    def _write(self, name: str, pixels):
        framebuffer.write_png(self.folder / f"{name}.png", pixels[::-1])


def _top(pixels, part: bpy.types.Area | bpy.types.Region) -> int:
    """The top row of an area or region in a picture of the screen."""
    return len(pixels) - part.y - part.height


def _last_row(pixels, region: bpy.types.Region) -> int:
    """The last row of the region's contents: the background below is empty."""
    top = _top(pixels, region)
    rows = pixels[top : top + region.height, region.x : region.x + region.width - 20].astype(int)
    filled = rows.max(axis=(1, 2)) - rows.min(axis=(1, 2)) > 20
    return top + int(filled.nonzero()[0].max())
