"""Plots without a measurement, of a BTF, and in an Image Editor."""

import os

import bpy

from support import plots, scenes, window

_WEAVE = os.path.join(os.path.dirname(__file__), "scenes/data/weave.velour")


def start(folder):
    """Called by the harness once the window is there."""
    window.run(folder, (gone_measurement, btf, enlarged))


def gone_measurement(folder):
    """The model alone, and a sentence."""
    node = scenes.velour_node(plots.material())
    node.velour.measurement.filepath_raw = "//gone.binary"
    yield from plots.show("LOBES")
    window.screenshot(folder, "gone-measurement")
    made = list(plots.preview()._pictures.values())[-1]
    assert made.name
    assert "gone.binary" in made.sentence, made.sentence


def btf(folder):
    with open(_WEAVE, "rb") as file:
        plots.material(file.read())
    yield from plots.show("LOBES", scroll=10)
    window.screenshot(folder, "btf")
    (wanted, made) = list(plots.preview()._pictures.items())[-1]
    assert wanted.kind == "ORDER", wanted.kind
    assert made.sentence is None, made.sentence


def enlarged(folder):
    """In a window of its own; a second one takes the same editor."""
    plots.material()
    yield from plots.show("LOBES")
    windows = bpy.context.window_manager.windows
    for kind in ("LOBES", "ALBEDO"):
        with window.override():
            assert bpy.ops.velour.enlarge_plot(material="Paint", kind=kind) == {"FINISHED"}
        yield 1.0
        assert len(windows) == 2
        area = windows[1].screen.areas[0]
        assert area.type == "IMAGE_EDITOR"
        assert area.spaces.active.image.name == f"Paint {kind.lower()}"
        path = str(folder / f"enlarged-{kind.lower()}.png")
        with bpy.context.temp_override(window=windows[1], screen=windows[1].screen):
            bpy.ops.screen.screenshot(filepath=path)
    with bpy.context.temp_override(window=windows[1]):
        bpy.ops.wm.window_close()
    yield 0.2
