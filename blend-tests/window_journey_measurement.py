"""From a measurement in a file to a rendered fit, as an artist does it in a window."""

import os
import shutil
from pathlib import Path
from unittest import mock

import bpy

from support import inputs, journeys

LONG = "an artist's clicks, one after the other; test_operators imports and fits without a window"
OWN_PROCESS = "it starts from factory settings and without earlier files"
ALONE = "its seconds are those of a machine that does nothing else"
SCREEN = "1400x900"
CLICKS, SECONDS = 10, 90
_DATA = Path(os.environ.get("VELOUR_DATA", Path(__file__).resolve().parents[1] / "shared/data"))
_MEASUREMENT = _DATA / "brdf/satin_rosaline_rgb.bsdf"


def start(folder):
    """Called by the harness once the window is there."""
    journeys.start(folder, fit_of_a_measurement)


def fit_of_a_measurement(folder):
    documents = folder / "documents"
    documents.mkdir()
    # Formats are recognized by content.
    shutil.copy(
        _MEASUREMENT if _MEASUREMENT.is_file() else inputs.plastic_measurement(), documents / "paint.bsdf"
    )
    at_home = {"HOME": str(documents), "XDG_DOCUMENTS_DIR": str(documents)}
    with mock.patch.dict(os.environ, at_home), journeys.artist_at(folder) as artist:
        yield from journeys.choose_engine(artist)
        artist.clock.restart()
        cube = bpy.data.objects["Cube"]
        before = cube.active_material
        yield from artist.click("File")
        yield from artist.click("Import")
        yield from artist.click("Measured Material (.velour, .binary, .bsdf, .brdf, .btf)")
        yield from artist.click("paint.bsdf")
        yield from artist.click("Import Material")
        yield from artist.until(lambda: cube.active_material != before, "the material is on the cube")
        yield from artist.until(journeys.no_job, "the fit ends", SECONDS)
        pixels = yield from journeys.rendered(artist)
        yield from artist.finish(CLICKS, SECONDS)
        journeys.assert_measured(cube, pixels)
