"""Plots without a measurement, of a BTF, in an Image Editor, and saved by the file browser."""

import os

import bpy
import numpy as np

from support import plots, scenes, window

_WEAVE = os.path.join(os.path.dirname(__file__), "scenes/data/weave.velour")


def start(folder):
    """Called by the harness once the window is there."""
    window.open_panels("advanced", "plots")
    if bpy.app.version >= (4, 0):
        window.run(folder, (gone_measurement, btf, enlarged, saved, not_saved))
    else:  # at times it crashes in taking a panel's handler from the window that closes; it hung once
        reason = "Blender 3.4 does not bear file browsers that a timer closes"
        window.run(folder, (gone_measurement, btf, enlarged), left_out=(saved, not_saved), reason=reason)


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
        yield from window.shown(f"Paint {kind.lower()}")
        assert len(windows) == 2
        path = str(folder / f"enlarged-{kind.lower()}.png")
        with window.in_context(window=windows[1], screen=windows[1].screen):
            bpy.ops.screen.screenshot(filepath=path)
    with window.in_context(window=windows[1]):
        bpy.ops.wm.window_close()
    yield 0.2


def _ask_for_file(**settings):
    """As the panel's button does."""
    with window.override():
        started = bpy.ops.velour.save_plot("INVOKE_DEFAULT", material="Paint", kind="ALBEDO", **settings)
    assert started == {"RUNNING_MODAL"}, started
    yield 0.5
    assert not bpy.context.window_manager.velour.running, "the plot is made before its file is known"


def _at_rest():
    for _ in range(200):
        yield 0.1
        if not bpy.context.window_manager.velour.running:
            return
    raise AssertionError("the plot goes on")


def saved(folder):
    """A plot of the panel's settings, of the size that the browser asks for, as the file's name says."""
    plots.material()
    for name in ("albedo.png", "albedo.csv", "without-an-extension"):
        yield from _ask_for_file(side=200)
        yield from window.choose_file(folder / name)
        yield from _at_rest()
    image = bpy.data.images.load(str(folder / "albedo.png"))
    assert tuple(image.size) == (200, 200), tuple(image.size)
    pixels = np.array(image.pixels[:]).reshape(200, 200, 4)
    assert pixels[..., :3].std() > 0.05, "the plot is empty"
    assert (folder / "albedo.csv").read_text().count("\n") > 10
    bpy.data.images.load(str(folder / "without-an-extension.png"))
    assert len(bpy.context.window_manager.windows) == 1, "the browser is still there"


def not_saved(folder):
    """The browser is left without a file: nothing is made, nothing waits, and the next one is."""
    plots.material()
    yield from _ask_for_file()
    yield from window.leave_browser()
    yield from _at_rest()
    state = bpy.context.window_manager.velour
    assert (state.running, state.waiting) == (False, 0), (state.running, state.waiting)
    assert not list(folder.glob("*.svg"))
    assert len(bpy.context.window_manager.windows) == 1, "the browser is still there"
    yield from _ask_for_file()
    yield from window.choose_file(folder / "later.svg")
    yield from _at_rest()
    assert "<svg" in (folder / "later.svg").read_text()
