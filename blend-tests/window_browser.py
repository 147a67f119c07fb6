"""The library of measurements in a window: a folder of a thousand files beside a window that stays usable."""

import os
import time
from pathlib import Path
from unittest import mock

import bpy

from support import inputs, scenes, window

_MODEL = Path(__file__).parent / "scenes/data/paint.velour"
_FILES = 1000
_HELD_SECONDS = 0.05  # of the processor that a draw or a turn may take from the main thread


def start(folder):
    """Called by the harness once the window is there."""
    os.environ["XDG_CACHE_HOME"] = str(folder / "cache")
    inputs.module("core.thumbnails")._SAMPLES = 8  # per pixel: their number is tested, not their look
    window.open_panels("browser")
    tests = (thousand_files, search, use, broken, refreshed, another_folder, nothing)
    window.run(folder, (*tests, loaded_file, switched_off, waits_for_renders))


def _folder(folder, name, count):
    """Models of which no two have the same content: zeros behind a model are no part of it."""
    made = folder / name
    made.mkdir()
    data = _MODEL.read_bytes()
    for number in range(count):
        (made / f"paint {number}.velour").write_bytes(data + bytes(number))
    return made


def _show(path):
    """The panel, at the end of a large editor."""
    inputs.module("ui.browser").forget()
    inputs.module("operators.browse").addon_preferences(bpy.context).measurements = str(path)
    settings = bpy.context.window_manager.velour.browser
    settings.search, settings.page, settings.chosen = "", 1, ""
    cube = bpy.context.view_layer.objects.active = bpy.data.objects["Cube"]
    cube.active_material = scenes.diffuse_material()  # whose Surface panel is short
    with window.override():
        bpy.ops.ed.undo_push(message="a library")
    yield from window.show_properties("MATERIAL")
    window.scroll_to_end()


def _redraw():
    """As a change by hand does; the turns until it is drawn."""
    for area in window.first().screen.areas:
        area.tag_redraw()
    yield 0.5


def _rest():
    """The turns until all pictures that were asked for are there."""
    browser = inputs.module("ui.browser")
    for _ in range(1500):
        yield 0.1
        if browser.is_at_rest() and browser._pictures:
            window.scroll_to_end()
            yield 0.3
            return
    raise AssertionError("the pictures are never there")


def thousand_files(folder):
    """Listed at once; pictures only of those on this page and the next, and nothing holds the window up."""
    path = _folder(folder, "thousand", _FILES)
    browser, panel = inputs.module("ui.browser"), inputs.module("ui.browser_panel")
    turns, draws = [], []
    begun = time.monotonic()
    with (
        mock.patch.object(browser, "_turn", window.timed(browser._turn, turns)),
        mock.patch.object(panel, "_draw_files", window.timed(panel._draw_files, draws)),
    ):
        yield from _show(path)
        while browser.found(str(path), bpy.context.window_manager.velour.browser.visits) is None:
            assert time.monotonic() - begun < 30
            yield 0.05
        print(f"{_FILES} files listed after {time.monotonic() - begun:.2f} s, the editor's opening included")
        yield from _rest()
    window.screenshot(folder, "library")
    found = browser.found(str(path), bpy.context.window_manager.velour.browser.visits)
    assert [file.name for file in found.files] == [f"paint {number}" for number in range(_FILES)]
    made = [file.name for file in browser._pictures]
    assert 6 <= len(made) <= 60, len(made)
    assert set(made) == {f"paint {number}" for number in range(len(made))}
    print(
        f"{len(made)} pictures; turns took {1e3 * max(turns):.1f} ms at most, draws {1e3 * max(draws):.1f} ms"
    )
    assert max(turns) < _HELD_SECONDS
    assert max(draws) < _HELD_SECONDS


def search(folder):
    """All words, in any order; the page is the first one again."""
    yield from _show(_folder(folder, "search", 40))
    yield from _rest()
    settings = bpy.context.window_manager.velour.browser
    settings.page = 2
    settings.search = "9 PAINT"
    assert settings.page == 1
    yield from _redraw()
    yield from _rest()
    screen = window.screenshot(folder, "search")
    settings.search = "nowhere"
    yield from _redraw()
    assert abs(window.screenshot(folder, "search-nothing") - screen).max() > 0.2


def use(folder):
    """What the button does: the material goes into the active object's slot, with the model in the file."""
    path = _folder(folder, "use", 3)
    yield from _show(path)
    yield from _rest()
    with window.override():
        bpy.ops.velour.choose_measurement(filepath=str(path / "paint 1.velour"))
    yield from _redraw()
    window.screenshot(folder, "chosen")
    with window.override():
        assert bpy.ops.velour.load_material("INVOKE_DEFAULT", filepath=str(path / "paint 1.velour")) == {
            "RUNNING_MODAL"
        }
    state = bpy.context.window_manager.velour
    for _ in range(300):
        yield 0.1
        if not state.running and not state.waiting:
            break
    material = bpy.data.objects["Cube"].active_material
    assert material.name == "paint 1", material.name
    assert scenes.velour_node(material).image.packed_file is not None
    yield 0.5
    window.screenshot(folder, "used")


def broken(folder):
    """One that is damaged is marked, says why, and keeps no other one waiting."""
    path = _folder(folder, "broken", 2)
    (path / "damaged.binary").write_bytes(b"nothing of the kind")
    yield from _show(path)
    with window.override():
        bpy.ops.velour.choose_measurement(filepath=str(path / "damaged.binary"))
    yield from _rest()
    window.screenshot(folder, "broken")
    pictures = {file.name: picture for file, picture in inputs.module("ui.browser")._pictures.items()}
    assert pictures["damaged"].icon == 0
    assert "damaged.binary" in pictures["damaged"].sentence
    assert pictures["paint 0"].icon
    assert pictures["paint 1"].icon


def refreshed(folder):
    """Another content has another picture; a new file is found."""
    path = _folder(folder, "refreshed", 1)
    yield from _show(path)
    yield from _rest()
    (path / "paint 0.velour").write_bytes(b"damaged")
    (path / "paint 7.velour").write_bytes(_MODEL.read_bytes() + bytes(77))
    with window.override():
        bpy.ops.velour.refresh_browser()
    yield from _redraw()
    yield from _rest()
    pictures = inputs.module("ui.browser")._pictures
    new = [picture for file, picture in pictures.items() if file.bytes == len(b"damaged")]
    assert new
    assert new[0].sentence
    assert any(file.name == "paint 7" for file in pictures)


def another_folder(folder):
    """Chosen while the one before is still looked through."""
    browser, go_on = inputs.module("ui.browser"), []
    first, second = _folder(folder, "first", 2), _folder(folder, "second", 3)
    find = browser.find_measurements

    def held(path, stopped):
        while path == str(first) and not go_on and not stopped():
            time.sleep(0.01)
        return find(path, stopped)

    with mock.patch.object(browser, "find_measurements", held):
        yield from _show(first)
        yield 0.5
        window.screenshot(folder, "looking")
        yield from _show(second)
        yield from _rest()
        go_on.append(1)
    yield 0.5
    assert {os.path.dirname(file.path) for file in browser._pictures} == {str(second)}


def nothing(folder):
    """No folder, one that is gone, and one without measurements: sentences."""
    for name, path in (("none", ""), ("gone", folder / "gone"), ("empty", _folder(folder, "empty", 0))):
        yield from _show(path)
        yield 1.0
        window.screenshot(folder, f"folder-{name}")
    browser = inputs.module("ui.browser")
    assert browser.is_at_rest()
    assert not browser._pictures


def loaded_file(folder):
    """Another .blend while pictures are being made: they are made all the same."""
    yield from _show(_folder(folder, "loaded", 8))
    yield 0.3
    window.fresh_file()
    yield 0.3
    bpy.context.view_layer.objects.active = bpy.data.objects["Cube"]
    yield from window.show_properties("MATERIAL")
    yield from _rest()


def switched_off(folder):
    """The add-on goes while pictures are being made, and nothing of it stays behind."""
    yield from _show(_folder(folder, "off", 8))
    yield 0.3
    for area in window.first().screen.areas:
        if area.type == "PROPERTIES":  # none shows the panel, which would ask again
            area.type = "TEXT_EDITOR"
    browser = inputs.module("ui.browser")
    browser.forget()
    assert browser.is_at_rest()
    assert not bpy.app.timers.is_registered(browser._turn)
    yield 1.0
    assert browser.is_at_rest()


def waits_for_renders(folder):
    """The processor is a render's as long as there is one."""
    browser, path = inputs.module("ui.browser"), _folder(folder, "waits", 4)
    yield from _show("")
    scenes.use_engine(samples=1 << 13, size=128)
    with window.override():
        bpy.ops.render.render("INVOKE_DEFAULT")
    inputs.module("operators.browse").addon_preferences(bpy.context).measurements = str(path)
    waited = 0
    while bpy.app.is_job_running("RENDER"):
        for area in window.first().screen.areas:
            area.tag_redraw()
        waited += bool(browser._asked)
        assert not browser._pictures, "a picture was made beside the render"
        yield 0.05
    assert waited > 5, "the render was too short to see anything"
    yield from _redraw()
    yield from _rest()
    assert len(browser._pictures) == 4
