"""The switches of passes in the window."""

import bpy
import numpy as np

from support import window


def start(folder):
    window.run(folder, (switches, mist))


def switches(folder):
    """Data and Cryptomatte, below each other; what is switched on is seen."""
    layer = bpy.context.view_layer
    yield from window.show_properties("VIEW_LAYER")
    before = window.screenshot(folder, "passes-before")
    layer.use_pass_mist = layer.use_pass_cryptomatte_object = True
    layer.velour.use_pass_denoising = layer.velour.use_pass_error = True
    yield 0.5
    assert np.abs(window.screenshot(folder, "passes-after") - before).max() > 0.2


def mist(folder):
    """The world's Mist Pass panel is there once a layer has that pass."""
    bpy.context.view_layer.objects.active = bpy.context.view_layer.objects["Cube"]
    yield from window.show_properties("WORLD")
    before = window.screenshot(folder, "mist-before")
    bpy.context.view_layer.use_pass_mist = True
    yield 0.5
    assert np.abs(window.screenshot(folder, "mist-after") - before).max() > 0.2
