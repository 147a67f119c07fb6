"""The window: a tile as the artist adds it, changes its type, and sees it repeated."""

import json

import bpy
import numpy as np

from support import inputs, scenes, window

_TURNS = 300  # of 0.1 s that a capture may take


def start(folder):
    """Called by the harness once the window is there."""
    for panel in (bpy.types.VELOUR_OBJECT_PT_tile_fit, bpy.types.VELOUR_COLLECTION_PT_tile_fit):
        bpy.utils.unregister_class(panel)
        panel.bl_options = set()  # open, to be looked at
        bpy.utils.register_class(panel)
    added = (add_and_repeat, another_type, applied)
    window.run(
        folder,
        (*added, capture_and_cancel, capture_again, capture, estimate, material, fitted_anew),
        viewport=True,
    )


def _clear_view():
    """A 3D viewport without the objects of the start, in a scene of millimeters."""
    for obj in list(bpy.data.objects):
        bpy.data.objects.remove(obj)
    bpy.context.scene.unit_settings.scale_length = 0.001
    area = next(area for area in window.first().screen.areas if area.type == "VIEW_3D")
    area.spaces.active.shading.type = "SOLID"
    area.spaces.active.shading.color_type = "MATERIAL"
    return area


def _in_view(area):
    region = next(region for region in area.regions if region.type == "WINDOW")
    return window.in_context(window=window.first(), area=area, region=region)


def _add(area, **arguments):
    with _in_view(area):
        assert bpy.ops.velour.add_mesostructure("INVOKE_DEFAULT", True, **arguments) == {"FINISHED"}
    return bpy.context.view_layer.objects.active


def add_and_repeat(folder):
    area = _clear_view()
    _add(area, type="WEAVE")
    with _in_view(area):
        bpy.ops.view3d.view_selected()
    yield 0.7
    alone = window.screenshot(folder, "weave")
    with _in_view(area):
        bpy.ops.velour.repeat_tile()
    yield 0.7
    assert np.abs(window.screenshot(folder, "weave-repeated") - alone).max() > 0.2, "no copies"


def another_type(folder):
    """The panel of the last operation is filled in; another type in it begins with that type's own shape."""
    area = _clear_view()
    _add(area, type="NET")
    yield 0.5
    last = bpy.context.window_manager.operators[-1].properties
    assert abs(last.size - 20) < 1e-4, last.size
    assert abs(last.gap - 0.78) < 1e-6, last.gap
    last.type = "GRAVEL"
    for name in ("size", "gap", "count"):
        assert not last.is_property_set(name), name
    window.screenshot(folder, "net")


def _repeats():
    """Those of the material, if they are set."""
    placement = scenes.velour_node(bpy.data.materials["Quarters"]).velour.placement
    return tuple(placement.repeats) if placement.is_property_set("repeats") else None


def applied(_folder):
    """The number of tiles can be changed in the panel of the last operation; an undo takes all of it back."""
    area = _clear_view()
    bpy.context.scene.unit_settings.scale_length = 1.0
    scenes.measured_material(inputs.quarters_model(), "Quarters").use_fake_user = True
    with _in_view(area):
        bpy.ops.mesh.primitive_cube_add()
        bpy.ops.ed.undo_push(message="a cube")
        asked = {"material": "Quarters", "object": "Cube"}
        assert bpy.ops.velour.apply_material("INVOKE_DEFAULT", True, **asked) == {"RUNNING_MODAL"}
    yield from window.until(lambda: bpy.data.objects["Cube"].active_material, "the cube has the material")
    yield 0.2
    assert _repeats() == (16, 16), _repeats()
    last = bpy.context.window_manager.operators[-1]
    assert last.name == "Apply Material", last.name
    assert abs(last.properties.tiles - 4) < 1e-4, last.properties.tiles
    last.properties.tiles = 10
    with _in_view(area):
        bpy.ops.ed.undo_redo("EXEC_DEFAULT", True)
    assert _repeats() == (40, 40), _repeats()
    with _in_view(area):
        bpy.ops.ed.undo()
    assert bpy.data.objects["Cube"].active_material is None
    assert _repeats() is None, _repeats()


def _tile_in_properties(tab):
    """A plane that is a tile, and its panel."""
    for obj in list(bpy.data.objects):
        bpy.data.objects.remove(obj)
    with window.override():
        obj = scenes.add_plane()
    obj.velour.is_tile = bpy.data.collections["Collection"].velour.is_tile = True
    yield from window.show_properties(tab)
    return obj


def _start_capture(folder, **settings):
    path = folder / "plane.btf"
    with window.override():
        started = bpy.ops.velour.capture_btf("INVOKE_DEFAULT", directory=str(path), **settings)
    assert started == {"RUNNING_MODAL"}, started
    return path


def capture_and_cancel(folder):
    """The panel shows the progress; cancel ends it, and it can be resumed."""
    yield from _tile_in_properties("OBJECT")
    state = bpy.context.window_manager.velour
    path = _start_capture(folder, texels=256, samples=256)
    yield 0.8
    assert state.running
    assert state.subject == "Plane"
    window.screenshot(folder, "capture-running")
    bpy.ops.velour.cancel_fit()
    for _ in range(20):
        yield 0.1
        if not state.running:
            break
    assert not state.running, "the capture goes on"
    assert (path / "btf.json").is_file(), "nothing to resume"


def _is_whole(path):
    return json.loads((path / "btf.json").read_text())["content"] is not None


def capture_again(folder):
    """The same button goes on with a capture that was canceled, and does nothing again."""
    tile = yield from _tile_in_properties("OBJECT")
    path = _start_capture(folder / "again", texels=32, views=24, lights=24, samples=16)
    for _ in range(_TURNS):
        yield 0.02
        done = {file: file.stat().st_mtime_ns for file in path.glob("view_*.exr")}
        if len(done) >= 2:
            break
    bpy.ops.velour.cancel_fit()
    yield from window.at_rest()
    assert not _is_whole(path), "it was not cancelled"
    with window.override():
        assert bpy.ops.velour.capture_btf("INVOKE_DEFAULT") == {"RUNNING_MODAL"}
    yield from window.at_rest()
    assert _is_whole(path), "it was not resumed"
    assert all(file.stat().st_mtime_ns == time for file, time in done.items())
    assert tile.velour.directory == str(path)


def capture(folder):
    yield from _tile_in_properties("OBJECT")
    window.screenshot(folder, "tile-panel")
    path = _start_capture(folder / "done", texels=4, views=6, lights=6)
    for _ in range(_TURNS):
        yield 0.1
        if not bpy.context.window_manager.velour.running:
            break
    assert (path / "btf.json").is_file()
    yield from window.show_properties("COLLECTION")
    window.screenshot(folder, "collection-panel")


def estimate(folder):
    """What a fit will take stands in the panel until something else is asked for."""
    yield from _tile_in_properties("OBJECT")
    small = {"texels": 8, "views": 12, "lights": 12, "samples": 4}
    with window.override():
        bpy.ops.velour.capture_btf(directory=str(folder / "estimated.btf"), **small)
    yield 0.5
    for _ in range(12):
        window.scroll_down(40)
    yield 0.3
    before = window.screenshot(folder, "fit-before")
    with window.override():
        assert bpy.ops.velour.estimate_fit("INVOKE_DEFAULT") == {"RUNNING_MODAL"}
    for _ in range(_TURNS):
        yield 0.1
        if not bpy.context.window_manager.velour.reading:
            break
    assert "MB of additional memory" in bpy.context.window_manager.velour.fit_estimate
    yield 0.5
    told = window.screenshot(folder, "fit-estimate")
    assert np.abs(told - before).max() > 0.2, "the panel shows nothing new"
    bpy.context.object.velour.method = "SVD"
    yield 0.5
    assert np.abs(window.screenshot(folder, "fit-other") - told).max() > 0.2, "it is of another method"


def _orange(picture):
    """How many pixels have the color of a curve's chosen point."""
    return int((np.abs(picture - (1.0, 0.6, 0.2)).max(axis=2) < 0.1).sum())


def material(folder):
    """The panel shows what a material was asked for, and its curve."""
    yield from _tile_in_properties("COLLECTION")
    before = window.screenshot(folder, "collection-before")
    small = {"texels": 8, "views": 12, "lights": 12, "samples": 4}
    with window.override():
        bpy.ops.velour.capture_btf(collection="Collection", directory=str(folder / "material.btf"), **small)
        bpy.ops.velour.compress_btf(collection="Collection", tolerance=0.2)
    assert bpy.data.collections["Collection"].velour.material is not None
    for _ in range(_TURNS // 10):
        yield 1.0  # the model is read, and its curve drawn, between two redraws
        for _ in range(12):  # turns of a wheel: the curve stands below the settings
            window.scroll_down(40)
        yield 0.3
        if _orange(window.screenshot(folder, "collection-curve")) > _orange(before) + 20:
            return
    raise AssertionError("no chosen point")


def fitted_anew(folder):
    """The BTF of a material, in its own panel: other settings, an estimate, a fit, and undo."""
    yield from _tile_in_properties("OBJECT")
    small = {"texels": 8, "views": 12, "lights": 12, "samples": 4}
    with window.override():
        bpy.ops.velour.capture_btf(directory=str(folder / "anew.btf"), **small)
        bpy.ops.velour.compress_btf(assign=True, megabytes=0.03)
        bpy.ops.ed.undo_push(message="a material of a BTF")
    yield from window.show_properties("MATERIAL")
    node = scenes.velour_node(bpy.data.materials["anew"])
    before = node.image.name
    node.velour.btf.method = "KCTA"
    with window.override():
        bpy.ops.ed.undo_push(message="another method")
        assert bpy.ops.velour.estimate_fit("INVOKE_DEFAULT", material="anew") == {"RUNNING_MODAL"}
    for _ in range(_TURNS):
        yield 0.1
        if not bpy.context.window_manager.velour.reading:
            break
    yield 0.5
    window.screenshot(folder, "anew-estimate")
    with window.override():
        assert bpy.ops.velour.compress_btf("INVOKE_DEFAULT", material="anew") == {"RUNNING_MODAL"}
    yield 0.3
    window.screenshot(folder, "anew-running")
    yield from window.at_rest()
    yield 0.5
    window.screenshot(folder, "anew-fitted")
    node = scenes.velour_node(bpy.data.materials["anew"])
    assert node.image.name != before
    assert len([m for m in bpy.data.materials if m.name.startswith("anew")]) == 1
    with window.override():
        bpy.ops.ed.undo()
    yield 0.3
    node = scenes.velour_node(bpy.data.materials["anew"])
    assert node.image.name == before, node.image.name
    assert node.velour.btf.method == "KCTA"
