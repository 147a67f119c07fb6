"""From the start of Blender to a rendered preset on Suzanne, as an artist does it in a window."""

import shutil
from contextlib import contextmanager
from pathlib import Path
from unittest import mock

import bpy
import numpy as np
from velour.core import presets

from support import framebuffer, journeys

LONG = "an artist's clicks, one after the other; test_presets adds presets without a window"
OWN_PROCESS = "its seconds count from the start of Blender"
ALONE = "its seconds are those of a machine that does nothing else"
SCREEN = "1400x900"
CLICKS, SECONDS = 12, 60
_MODEL = Path(__file__).parent / "scenes/data/paint.velour"


def start(folder):
    """Called by the harness once the window is there."""
    journeys.start(folder, preset_on_suzanne)


def preset_on_suzanne(folder):
    with _presets(folder) as name, journeys.artist_at(folder) as artist:
        yield from artist.press("Delete")  # the cube
        yield from artist.until(lambda: "Cube" not in bpy.context.view_layer.objects, "the cube is gone")
        for text in ("Add", "Mesh", "Monkey"):
            yield from artist.click(text, "VIEW_3D")
        yield from artist.until(lambda: "Suzanne" in bpy.data.objects, "Suzanne is there")
        yield from journeys.choose_engine(artist)
        yield from artist.click("Preview", "PROPERTIES")
        yield from artist.click_tab("MATERIAL")
        yield from artist.click(name, "PROPERTIES")
        suzanne = bpy.data.objects["Suzanne"]
        yield from artist.until(lambda: suzanne.active_material is not None, "the preset is on Suzanne")
        pixels = yield from journeys.rendered(artist)
        yield from artist.finish(CLICKS, SECONDS)
        journeys.assert_measured(suzanne, pixels)
        assert suzanne.active_material.name.startswith(name)


@contextmanager
def _presets(folder):
    """The presets of the add-on, or one if it has none; the name of the first that the grid shows."""
    if listed := presets.listed():
        yield listed[0].name
        return
    home, name = folder / "presets", "Orange Paint"
    home.mkdir()
    made = presets.Preset(
        name, home / "paint.velour", home / "paint.png", "Samples", "A paint", ("paint",), 0
    )
    shutil.copy(_MODEL, made.model)
    framebuffer.write_png(made.picture, np.full((64, 64, 3), (200, 110, 60), np.uint8))
    (home / presets.INDEX_FILE).write_text(presets.index_text([made]))
    with mock.patch.object(presets, "folder", return_value=home):
        yield name
