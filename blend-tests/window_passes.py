"""The switches of passes in the window."""

import contextlib

import bpy
import numpy as np

from support import scenes, window

_RIGHT_OF_ICONS = 200  # pixels; Blender draws that of a changed material anew, at the left
SCREEN = "1400x720"


def start(folder):
    window.run(folder, (switches, override, mist, pass_index))


def switches(folder):
    """Data and Cryptomatte, below each other; what is switched on is seen."""
    layer = bpy.context.view_layer
    yield from window.show_properties("VIEW_LAYER")
    before = window.screenshot(folder, "passes-before")
    layer.use_pass_mist = layer.use_pass_cryptomatte_object = True
    layer.velour.use_pass_denoising = layer.velour.use_pass_error = True
    yield 0.5
    assert np.abs(window.screenshot(folder, "passes-after") - before).max() > 0.2


def override(folder):
    """What a layer overrides can be set with Velour, too."""
    layer = bpy.context.view_layer
    with _open(bpy.types.VELOUR_VIEWLAYER_PT_override):
        yield from window.show_properties("VIEW_LAYER")
        window.scroll_to_end()
        before = window.screenshot(folder, "samples-0")
        layer.samples = 1234
        yield 0.5
        changed = np.abs(window.screenshot(folder, "samples-1234") - before).max(axis=2) > 0.2
    assert changed.sum() > 20, "the panel does not show the samples"


def mist(folder):
    """The world's Mist Pass panel is there once a layer has that pass."""
    bpy.context.view_layer.objects.active = bpy.context.view_layer.objects["Cube"]
    yield from window.show_properties("WORLD")
    before = window.screenshot(folder, "mist-before")
    bpy.context.view_layer.use_pass_mist = True
    yield 0.5
    assert np.abs(window.screenshot(folder, "mist-after") - before).max() > 0.2


def pass_index(folder):
    """Blender's own settings of materials are other engines' panels; ours shows the number of the pass."""
    panels = [
        panel for panel in bpy.types.Panel.__subclasses__() if panel.__name__.endswith("MATERIAL_PT_settings")
    ]
    ours = bpy.types.VELOUR_MATERIAL_PT_settings
    assert len(panels) > 1, panels
    assert [panel for panel in panels if "VELOUR" in panel.COMPAT_ENGINES] == [ours]
    cube = bpy.context.view_layer.objects["Cube"]
    bpy.context.view_layer.objects.active = cube
    cube.active_material = scenes.diffuse_material()  # whose Surface panel is short
    bpy.context.preferences.view.show_tooltips = False
    with _open(ours):
        yield from window.show_properties("MATERIAL")
        before = window.screenshot(folder, "pass-index-0")
        cube.active_material.pass_index = 1234
        yield 0.5
        changes = np.abs(window.screenshot(folder, "pass-index-1234") - before).max(axis=2) > 0.2
    changed = np.argwhere(changes[:, _RIGHT_OF_ICONS:])
    assert len(changed) > 20, "the panel does not show the pass index"
    height, width = np.ptp(changed, axis=0)
    assert height < 30, f"{height} x {width} pixels changed: more than a number"


@contextlib.contextmanager
def _open(panel):
    """It is folded at first."""
    options = panel.bl_options
    for wanted in (set(), options):
        bpy.utils.unregister_class(panel)
        panel.bl_options = wanted
        bpy.utils.register_class(panel)
        if not wanted:
            yield
