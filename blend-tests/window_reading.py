"""The window: files are read beside it, whatever becomes of them and of the .blend meanwhile."""

from unittest import mock

import bpy

from support import scenes, window
from support.reading import MODEL, Held, check_turns, large_file, module, shown


def start(folder):
    """Called by the harness once the window is there."""
    panel = (panel_reads_beside_the_window, gone, truncated, undone, deleted, loaded_file)
    imports = (import_beside_the_window, import_from_browser, import_undone, import_loaded_file, import_gone)
    window.run(folder, (*panel, *imports, import_cancelled, several, beside_operators))


def _known(image):
    """The turns until its summary is there, and the summary."""
    summaries = module("ui.summaries")
    for _ in range(200):
        summary = summaries.model_summary(image)
        if summary is not None:
            return summary
        yield 0.05
    raise AssertionError("the panel still waits for the model")


def _held_summary():
    return Held(module("export.files").StoredFile, "content")


def panel_reads_beside_the_window(folder):
    """No turn takes long, where reading the file at once does; the panel says so until it is read."""
    path = large_file(folder)
    summaries, seconds = module("ui.summaries"), []
    summaries.forget()
    held = _held_summary()
    with mock.patch.object(summaries, "_turn", window.timed(summaries._turn, seconds)):
        image = shown(path)
        yield from window.show_properties("MATERIAL")
        assert summaries.model_summary(image) is None
        window.screenshot(folder, "reading")
        held.release()
        summary = yield from _known(image)
    yield 0.3
    window.screenshot(folder, "read")
    assert summary["lobes"] > 0, summary
    assert summaries.is_at_rest()
    check_turns("reading", seconds, lambda: module("export.files").read_model(image, "Control").close())


def gone(folder):
    """The file goes while it waits to be read: a sentence, and the model once it is back."""
    path = large_file(folder, size=10_000)
    held = _held_summary()
    image = shown(path)
    assert module("ui.summaries").model_summary(image) is None
    yield 0.2
    path.unlink()
    held.release()
    summary = yield from _known(image)
    assert "cannot be read" in summary, summary
    large_file(folder, size=10_000)
    assert (yield from _known(image))["lobes"] > 0


def truncated(folder):
    path = large_file(folder, size=10_000)
    held = _held_summary()
    image = shown(path)
    image.velour.sha256 = ""  # or it would be refused for being another one
    assert module("ui.summaries").model_summary(image) is None
    yield 0.2
    path.write_bytes(MODEL.read_bytes()[:1000])
    held.release()
    summary = yield from _known(image)
    assert isinstance(summary, str), summary
    assert path.name in summary, summary


def undone(folder):
    """The image is another one after an undo and a redo, and has the summary all the same."""
    held = _held_summary()
    image = shown(large_file(folder, size=20_000))
    yield from window.show_properties("MATERIAL")
    name = image.name
    bpy.context.view_layer.objects["Cube"].location.x = 3
    with window.override():
        bpy.ops.ed.undo_push(message="moved")
        bpy.ops.ed.undo()
        bpy.ops.ed.undo()
        assert name not in bpy.data.images
        bpy.ops.ed.redo()
    held.release()
    assert (yield from _known(bpy.data.images[name]))["lobes"] > 0


def deleted(folder):
    """Before it is read, and before its turn has come."""
    summaries = module("ui.summaries")
    for wait in (0.2, 0.0):
        held = _held_summary()
        image = shown(large_file(folder, size=30_000))
        assert summaries.model_summary(image) is None
        yield wait
        bpy.data.images.remove(image)
        held.release()
        yield 0.5
        assert summaries.is_at_rest()
        summaries.forget()


def loaded_file(folder):
    """Timers that do not outlive a file would leave the panel reading for ever."""
    path = str(folder / "shown.blend")
    name = shown(large_file(folder, size=40_000)).name
    bpy.ops.wm.save_as_mainfile(filepath=path)
    module("ui.summaries").forget()
    assert module("ui.summaries").model_summary(bpy.data.images[name]) is None
    bpy.ops.wm.open_mainfile(filepath=path)
    assert (yield from _known(bpy.data.images[name]))["lobes"] > 0


def _import(path, **settings):
    settings = {"filepath": str(path), "fit": False, "pack": False, **settings}
    with window.override():
        assert bpy.ops.velour.load_material("INVOKE_DEFAULT", **settings) == {"RUNNING_MODAL"}


def _held_import():
    return Held(module("operators.load_material"), "found_file")


def _names():
    return {material.name for material in bpy.data.materials}


def import_beside_the_window(folder):
    """Neither its beginning nor a turn takes long, the one that makes the material included."""
    path, seconds = large_file(folder), []
    operator = module("operators.load_material").VELOUR_OT_load_material
    with (
        mock.patch.object(operator, "_begin", window.timed(operator._begin, seconds)),
        mock.patch.object(operator, "_step", window.timed(operator._step, seconds)),
    ):
        held = _held_import()
        _import(path)
        state = bpy.context.window_manager.velour
        assert (state.running, state.subject) == (True, "large.velour")
        yield from window.show_properties("MATERIAL")
        window.screenshot(folder, "importing")
        assert "large" not in _names()
        held.release()
        yield from window.at_rest()
    material = bpy.data.materials["large"]
    assert scenes.velour_node(material).image.velour.sha256
    assert bpy.context.view_layer.objects.active.active_material == material
    check_turns("the import", seconds, lambda: module("export.files").sha256(path.read_bytes()))


def import_from_browser(folder):
    """The files that the browser gives. Two undos take the material back: the approximation is the second."""
    path = large_file(folder, "chosen.velour", 50_000)
    with window.override():
        bpy.ops.ed.undo_push(message="before")
        assert bpy.ops.velour.load_material("INVOKE_DEFAULT", fit=False) == {"RUNNING_MODAL"}
    yield 0.5
    yield from window.choose_file(path)
    yield from window.at_rest()
    assert "chosen" in _names(), _names()
    assert bpy.data.objects["Cube"].active_material.name == "chosen"
    with window.override():
        bpy.ops.ed.undo()
        assert "chosen" in _names()
        bpy.ops.ed.undo()
    yield 0.2
    assert "chosen" not in _names()


def import_undone(folder):
    """The object is another one after an undo, and gets the material."""
    held = _held_import()
    with window.override():
        bpy.ops.ed.undo_push(message="before")
    _import(large_file(folder, "undone.velour", 50_000), object="Cube")
    bpy.data.objects["Cube"].location.x = 3
    with window.override():
        bpy.ops.ed.undo_push(message="moved")
        bpy.ops.ed.undo()
    held.release()
    yield from window.at_rest()
    assert bpy.data.objects["Cube"].active_material.name == "undone"


def import_loaded_file(folder):
    """Another file ends it, and the next one is not kept waiting."""
    held = _held_import()
    _import(large_file(folder, "lost.velour", 50_000))
    yield 0.3
    window.fresh_file()
    held.release()
    yield 0.5
    assert not bpy.context.window_manager.velour.running
    assert "lost" not in _names()
    _import(large_file(folder, "next.velour", 50_000))
    yield from window.at_rest()
    assert "next" in _names()


def import_gone(folder):
    """The file goes while it is read: nothing is made, and nothing runs."""
    path = large_file(folder, "gone.velour", 50_000)
    before, held = _names(), _held_import()
    _import(path)
    path.unlink()
    held.release()
    yield from window.at_rest()
    assert _names() == before


def import_cancelled(folder):
    before, held = _names(), _held_import()
    _import(large_file(folder, "cancelled.velour", 50_000))
    yield 0.2
    bpy.ops.velour.cancel_fit()
    yield from window.at_rest()
    held.release()
    yield 0.2
    assert _names() == before


def several(folder):
    """What follows, of each file, stands in line beside the window."""
    names = [large_file(folder, f"{name}.velour", 50_000).name for name in ("one", "two")]
    settings = {"directory": str(folder), "files": [{"name": name} for name in names]}
    with window.override():
        started = bpy.ops.velour.load_material("INVOKE_DEFAULT", **settings)
    assert started == {"RUNNING_MODAL"}, started
    yield from window.at_rest()
    group = module("export.nodes").approximation_node
    states = [group(bpy.data.materials[name]).node_tree.velour for name in ("one", "two")]
    assert all(state.fitted for state in states)


def beside_operators(folder):
    """Operators in another context while a file is read: Blender 3.4 crashes unless reading pauses."""
    check, steps = module("core.read_job").check, []

    def read():
        while True:
            check()
            steps.append(len(steps))

    job = module("core.read_job").ReadJob(read).start()
    for _ in range(10):
        yield 0.02
        with window.override():
            begun = len(steps)
            bpy.ops.wm.redraw_timer(type="DRAW_WIN_SWAP", iterations=1)
            assert len(steps) == begun
    assert begun > 10, begun
    job.cancel()
