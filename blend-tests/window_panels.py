"""The window: panels drawn without an error, a fit in the background with cancel, a render as it grows."""

from unittest import mock

import addon_utils
import bpy
import numpy as np

from support import framebuffer, inputs, pointer, scenes, window
from support import panels as stock

_TURNS_SECONDS = 60


def start(folder):
    """Called by the harness once the window is there."""
    fits = (fit_and_cancel, two_fits, fit_and_undo, scene_fit_and_cancel, scene_fit_and_undo, shared_material)
    chosen = pinned, opened, no_file, preset_cloth
    window.run(folder, (panels, stock_panels, preferences, viewport, *chosen, *fits, render), viewport=True)


def _measured_cube():
    data = inputs.model_bytes(inputs.glossy_measurement())
    material = scenes.measured_material(data)
    image = inputs_image()
    scenes.velour_node(material).velour.measurement = image
    bpy.context.view_layer.objects["Cube"].active_material = material
    bpy.context.view_layer.objects.active = bpy.context.view_layer.objects["Cube"]
    return material


def inputs_image():
    image = bpy.data.images.new("glossy.binary", 1, 1)
    image.source, image.filepath_raw = "FILE", str(inputs.glossy_measurement())
    return image


def panels(folder):
    """The material, render and view layer tabs; another tab must give another picture."""
    _measured_cube()
    pictures = []
    for tab in ("RENDER", "VIEW_LAYER", "MATERIAL"):
        yield from window.show_properties(tab)
        pictures.append(window.screenshot(folder, f"tab-{tab.lower()}"))
    assert np.abs(pictures[0] - pictures[2]).max() > 0.2
    assert np.abs(pictures[0] - pictures[1]).max() > 0.2


def stock_panels(folder):
    """Blender's own panels with our engine, as they are shown: those of what is read, and no others."""
    for tab, name, kind in (
        ("DATA", "Light", "light"),
        ("DATA", "Camera", "camera"),
        ("DATA", "Cube", "mesh"),
        ("OBJECT", "Cube", "object"),
        ("MATERIAL", "Cube", "material"),
        ("WORLD", "Cube", "world"),
        ("RENDER", "Cube", "render"),
        ("OUTPUT", "Cube", "output"),
        ("VIEW_LAYER", "Cube", "view_layer"),
    ):
        bpy.context.view_layer.objects.active = bpy.context.view_layer.objects[name]
        yield from window.show_properties(tab)
        window.screenshot(folder, f"stock-{name.lower()}-{tab.lower()}")
        area = max(window.first().screen.areas, key=lambda a: a.width * a.height)
        region = next(region for region in area.regions if region.type == "WINDOW")
        with window.in_context(window=window.first(), area=area, region=region):
            names = stock.shown(kind, bpy.context)
        assert stock.wrong(kind, names) == ([], []), (kind, stock.wrong(kind, names))


def _over_properties():
    """As a button of the large Properties editor."""
    area = max(window.first().screen.areas, key=lambda a: a.width * a.height)
    region = next(region for region in area.regions if region.type == "WINDOW")
    return window.in_context(window=window.first(), area=area, region=region)


def pinned(folder):
    """A material that is pinned has its panels, and their buttons are for it."""
    material = _measured_cube()
    before = scenes.velour_node(material).image.name
    yield from window.show_properties("MATERIAL")
    with _over_properties():
        space = bpy.context.space_data
        space.use_pin_id, space.pin_id = True, material
        bpy.context.view_layer.objects["Cube"].active_material = bpy.data.materials.new("Plain")
    yield 0.5
    window.screenshot(folder, "pinned")
    with _over_properties():
        assert bpy.context.object is None
        assert "VELOUR_MATERIAL_PT_measured" in stock.shown("material", bpy.context)
        assert bpy.ops.velour.fit("INVOKE_DEFAULT", tolerance=0.2, max_lobes=2) == {"RUNNING_MODAL"}
    for _ in range(10 * _TURNS_SECONDS):
        yield 0.1
        if not bpy.context.window_manager.velour.running:
            break
    assert scenes.velour_node(material).image.name != before, "it was not fitted"


def opened(folder):
    """A measurement that is chosen in the file browser of the panel; a second one in another browser."""
    settings = scenes.velour_node(_measured_cube()).velour
    yield from window.show_properties("MATERIAL")
    for name in ("one.binary", "two.binary"):
        (folder / name).write_bytes(inputs.glossy_measurement().read_bytes())
        with _over_properties():
            assert bpy.ops.velour.open_measurement("INVOKE_DEFAULT") == {"RUNNING_MODAL"}
        yield 0.5
        yield from window.choose_file(folder / name)
        for _ in range(10 * _TURNS_SECONDS):
            yield 0.1
            if settings.measurement.name == name:
                break
        assert settings.measurement.name == name, settings.measurement.name
        assert settings.measurement.velour.sha256


def no_file(folder):
    """A file browser that is left without a file in a folder of pictures says so, and reads none of them."""
    (folder / "holiday").mkdir()
    (folder / "holiday" / "beach.png").write_bytes(b"")
    _measured_cube()
    for operator in (bpy.ops.velour.load_material, bpy.ops.velour.open_measurement):
        with window.override():
            assert operator("INVOKE_DEFAULT") == {"RUNNING_MODAL"}
        yield 0.5
        measured = inputs.module("operators.measured")
        with mock.patch.object(measured, "refuse_folder", wraps=measured.refuse_folder) as refuse:
            yield from window.choose_file(folder / "holiday" / "")
        state = bpy.context.window_manager.velour
        assert not state.running, "the pictures are read"
        assert not state.reading, "the pictures are read"
        refuse.assert_called_once()


def preset_cloth(folder):
    """The approximation of a preset cloth, which takes many seconds, does not hold the window up."""
    presets = inputs.module("core.presets")
    home = folder / "cloths"
    home.mkdir()
    made = presets.Preset(
        "Weave", home / "weave.velour", home / "weave.png", "Cloths", "A weave", ("cloth",), 3
    )
    made.model.write_bytes(inputs.weave_model())
    framebuffer.write_png(made.picture, np.full((64, 64, 3), 128, np.uint8))
    (home / presets.INDEX_FILE).write_text(presets.index_text([made]))
    state = bpy.context.window_manager.velour
    bpy.context.view_layer.objects.active = cube = bpy.data.objects["Cube"]
    with window.override():
        assert bpy.ops.velour.add_preset(preset="Weave", directory=str(home)) == {"FINISHED"}
    assert cube.active_material.name == "Weave"
    assert (state.running, state.subject) == (True, "Weave"), "it was approximated before the operator ended"
    yield 0.3
    bpy.ops.velour.cancel_fit()
    yield from window.at_rest()
    assert scenes.velour_node(cube.active_material).image, "the model is gone with its approximation"


def preferences(folder):
    area = max(window.first().screen.areas, key=lambda a: a.width * a.height)
    area.type = "PREFERENCES"
    bpy.context.preferences.active_section = "ADDONS"
    bpy.context.window_manager.addon_search = "Velour"
    yield 0.5  # the first draw looks for add-ons
    folded = window.screenshot(folder, "preferences-folded")
    addon = next(module for module in addon_utils.modules() if module.__name__ == inputs.ADDON)
    addon_utils.module_bl_info(addon)["show_expanded"] = True
    area.tag_redraw()
    yield 0.5
    assert np.abs(window.screenshot(folder, "preferences") - folded).max() > 0.2


def viewport(folder):
    """Every shading mode that Blender offers for the engine draws, and leaves the interface working."""
    _measured_cube()
    scenes.use_engine()
    area = next(area for area in window.first().screen.areas if area.type == "VIEW_3D")
    shading = area.spaces.active.shading
    for mode in ("MATERIAL", "SOLID", "WIREFRAME"):
        shading.type = mode
        yield 1.0
        window.screenshot(folder, f"viewport-{mode.lower()}")


def _start_fit(**settings):
    with window.override():
        assert bpy.ops.velour.fit("INVOKE_DEFAULT", material="Paint", **settings) == {"RUNNING_MODAL"}


def fit_and_cancel(folder):
    """Progress is shown, cancel ends it, and the model stays."""
    material = _measured_cube()
    before = scenes.velour_node(material).image.name
    yield from window.show_properties("MATERIAL")
    _start_fit(model="SCATTERED", tolerance=0.0005, max_lobes=64, users="SINGLE")
    yield 0.8
    assert bpy.context.window_manager.velour.running
    window.screenshot(folder, "fit-running")
    bpy.ops.velour.cancel_fit()
    for _ in range(20):
        yield 0.1
        if not bpy.context.window_manager.velour.running:
            break
    assert not bpy.context.window_manager.velour.running, "the fit goes on"
    assert scenes.velour_node(material).image.name == before


def two_fits(folder):
    """The second waits for the first, the status bar tells of both, and a cancel ends the first alone."""
    material = _measured_cube()
    other = material.copy()
    other.name = "Other"
    scenes.velour_node(other).velour.model = "PARAMETRIC"
    before = scenes.velour_node(other).image.name
    yield from window.show_properties("MATERIAL")
    idle = window.screenshot(folder, "two-fits-before")
    _start_fit(model="SCATTERED", tolerance=0.0005, max_lobes=64, users="SINGLE")
    with window.override():
        started = bpy.ops.velour.fit(
            "INVOKE_DEFAULT", material="Other", tolerance=0.2, max_lobes=2, users="SINGLE"
        )
    assert started == {"RUNNING_MODAL"}, started
    yield 0.8
    state = bpy.context.window_manager.velour
    assert (state.running, state.subject, state.waiting) == (True, "Paint", 1), (state.subject, state.waiting)
    bar = slice(0, 22)  # rows of the status bar, the lowest first
    for _ in range(50):  # the machine may be busy
        change = np.abs(window.screenshot(folder, "two-fits") - idle)
        if change[bar].max() > 0.2:
            break
        yield 0.1
    assert change[bar].max() > 0.2, "the status bar shows nothing"
    bpy.ops.velour.cancel_fit()
    for _ in range(10 * _TURNS_SECONDS):
        yield 0.1
        if not state.running and not state.waiting:
            break
    assert scenes.velour_node(other).image.name != before, "the second fit did not run"
    assert scenes.velour_node(material).image.name == before, "the first one was not cancelled"


def fit_and_undo(folder):
    material = _measured_cube()
    before = scenes.velour_node(material).image.name
    with window.override():
        bpy.ops.ed.undo_push(message="before")
    _start_fit(tolerance=0.2, max_lobes=2)
    for _ in range(10 * _TURNS_SECONDS):
        yield 0.1
        if not bpy.context.window_manager.velour.running:
            break
    node = scenes.velour_node(bpy.data.materials["Paint"])
    assert node.image.name != before, "no new model"
    yield from window.show_properties("MATERIAL")
    window.screenshot(folder, "fit-done")
    with window.override():
        bpy.ops.ed.undo()
    yield 0.2
    assert scenes.velour_node(bpy.data.materials["Paint"]).image.name == before


def _start_scene_fit(last_frame):
    scene = scenes.use_engine()
    scene.frame_end = last_frame
    with window.override():
        started = bpy.ops.velour.fit_for_scene("INVOKE_DEFAULT", material="Paint")
    assert started == {"RUNNING_MODAL"}, started


def scene_fit_and_cancel(folder):
    """Frames go by while the window lives; cancel leaves everything as it was."""
    material = _measured_cube()
    bpy.context.scene.frame_set(3)
    yield from window.show_properties("MATERIAL")
    images = len(bpy.data.images)
    _start_scene_fit(last_frame=200)
    state = bpy.context.window_manager.velour
    for _ in range(10 * _TURNS_SECONDS):  # the machine may be busy
        yield 0.1
        if state.stage.startswith("frame "):
            break
    assert state.running
    assert state.stage.startswith("frame "), state.stage
    window.screenshot(folder, "scene-fit-running")
    bpy.ops.velour.cancel_fit()
    yield 1.0
    assert not state.running, "the fit goes on"
    assert len(bpy.data.images) == images
    assert len(bpy.data.scenes) == 1
    assert bpy.context.scene.frame_current == 3
    assert scenes.velour_node(material).velour.scene_model is None


def scene_fit_and_undo(folder):
    material = _measured_cube()
    yield from window.show_properties("MATERIAL")
    before = window.screenshot(folder, "scene-fit-before")
    with window.override():
        bpy.ops.ed.undo_push(message="before")
    _start_scene_fit(last_frame=2)
    for _ in range(10 * _TURNS_SECONDS):
        yield 0.1
        if not bpy.context.window_manager.velour.running:
            break
    settings = scenes.velour_node(material).velour
    assert settings.scene_model is not None
    assert settings.use_scene_model
    yield 0.7
    assert np.abs(window.screenshot(folder, "scene-fit-done") - before).max() > 0.2, (
        "the panel shows nothing new"
    )
    with window.override():
        bpy.ops.ed.undo()
    yield 0.2
    settings = scenes.velour_node(bpy.data.materials["Paint"]).velour
    assert settings.scene_model is None
    assert not settings.use_scene_model


def shared_material(folder):
    """A menu says who shares it, and nothing starts."""
    _measured_cube()
    yield from window.show_properties("MATERIAL")
    before = window.screenshot(folder, "shared-before")
    bpy.data.scenes.new("Other").collection.objects.link(bpy.data.objects["Cube"])
    with window.override():
        assert bpy.ops.velour.fit_for_scene("INVOKE_DEFAULT", material="Paint") == {"CANCELLED"}
    yield 0.7
    assert not bpy.context.window_manager.velour.running
    assert np.abs(window.screenshot(folder, "shared-menu") - before).max() > 0.2, "no menu"
    if not pointer.why_not():  # Blender can crash if the next test opens a file under a menu
        hand = pointer.Pointer()
        hand.key("Escape")
        hand.close()
        yield 0.3


def render(folder):
    """F12 in the window: pictures in between, and the last one is whole."""
    _measured_cube()
    scene = scenes.use_engine(samples=1 << 12, size=64)
    with window.override():
        bpy.ops.render.render("INVOKE_DEFAULT")
    for _ in range(10 * _TURNS_SECONDS):
        yield 0.1
        if not bpy.app.is_job_running("RENDER"):
            break
    yield 0.5
    result = bpy.data.images["Render Result"]
    path = folder / "result.exr"
    scene.render.image_settings.file_format = "OPEN_EXR"
    result.save_render(str(path))
    pixels = scenes.read(path)
    assert pixels.shape[:2] == (64, 64)
    assert pixels[..., :3].std() > 0.01, "the picture is uniform"
