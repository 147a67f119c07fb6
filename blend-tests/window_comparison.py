"""A model beside its measurement, and an asset's picture, made while the window stays usable."""

import bpy

from support import plots, window


def start(folder):
    """Called by the harness once the window is there."""
    window.open_panels("advanced", "plots")
    window.run(folder, (compared, marked))


def _until_done():
    state = bpy.context.window_manager.velour
    for _ in range(300):
        yield 0.1
        if not state.running:
            return
    raise AssertionError("the job does not end")


def compared(folder):
    """In an Image Editor of its own, with the view transform; in the panel, its thumbnail. A script does not
    block the window."""
    plots.material()
    yield from plots.show("LOBES", scroll=10)
    with window.override():
        assert bpy.ops.velour.compare(side=128) == {"RUNNING_MODAL"}
    assert bpy.context.window_manager.velour.running
    yield from _until_done()
    yield from window.shown("Paint compared")
    windows = bpy.context.window_manager.windows
    assert len(windows) == 2, len(windows)
    with window.in_context(window=windows[1], screen=windows[1].screen):
        bpy.ops.screen.screenshot(filepath=str(folder / "comparison.png"))
    with window.in_context(window=windows[1]):
        bpy.ops.wm.window_close()
    yield 0.5
    for _ in range(12):
        window.scroll_down(40)
    yield 0.5
    window.screenshot(folder, "panel")


def marked(folder):
    """The material may be renamed meanwhile; undo takes the asset back."""
    material = plots.material()
    yield 0.2
    with window.override():
        bpy.ops.ed.undo_push(message="before")
        assert bpy.ops.velour.mark_asset("INVOKE_DEFAULT", material=material.name) == {"RUNNING_MODAL"}
    material.name = "Renamed"
    yield from _until_done()
    material = bpy.data.materials["Renamed"]
    assert material.asset_data is not None
    assert tuple(material.preview.image_size) == (256, 256)
    with window.override():
        bpy.ops.ed.undo()
    yield 0.2
    names = {each.name: each.asset_data for each in bpy.data.materials}
    assert not any(names.values()), names
