"""The chapters of the guide, as an artist performs them: generator functions that yield the seconds until
their next turn in Blender's event loop.

The scenes: a monkey, or a cloth, under an environment that comes with Blender.
"""

import math

import bpy
import numpy as np
from bench import project
from bench.inside import scene as build
from support import inputs, scenes, viewport, window

from .desk import area, inside


def install(desk, _measurement, _facts):
    """The add-on in the preferences."""
    area("VIEW_3D").type = "PREFERENCES"
    bpy.context.preferences.active_section = "ADDONS"
    bpy.context.window_manager.addon_search = "Velour"
    yield 1.5  # the first draw looks for add-ons
    yield from desk.show("RENDER")
    desk.picture_of_editor("install", "PREFERENCES", height=150)


def preset(desk, _measurement, _facts):
    """The look scene, and a preset on its ball."""
    yield from desk.arrange()
    with inside("VIEW_3D"):
        bpy.ops.velour.new_look()
    yield 1.0
    _render(desk.folder, "look", (520, 520))
    bpy.context.view_layer.objects.active.active_material = None
    yield from desk.show("MATERIAL")
    bpy.context.window_manager.velour.browser.catalog = "Metals"
    yield 1.0
    desk.picture_of_panels("preset_grid", "MATERIAL", "Measured Material")


def first_material(desk, measurement, facts):
    """A measurement on a monkey, imported, fitted and rendered."""
    size = (640, 440)
    yield from desk.arrange()
    _start(256, size)
    with inside("VIEW_3D"):
        add_monkey()
    add_world()
    _look_at((0, 0, 0.05), (0.5, -6.2, 1.0), 72)
    yield from desk.show("RENDER")
    desk.picture_of_panels("engine", "RENDER", None, "Sampling")
    yield from _open_import_menu(desk)
    with inside("VIEW_3D"):
        bpy.ops.velour.load_material(filepath=str(measurement))
    yield from desk.job()
    yield from desk.show("MATERIAL")
    desk.picture_of_panels("material_panel", "MATERIAL", "Measured Material")
    yield from desk.open_panels("Advanced", "Plots", "Model")
    yield from desk.plot("LOBES")
    for name, panel in (("model_panel", "Model"), ("plot", "Plots")):
        desk.picture_of_panels(name, "MATERIAL", panel)
    facts.update(_fit_facts(_material()), measurement_bytes=measurement.stat().st_size)
    _render(desk.folder, "first_render", size)
    view = area("VIEW_3D").spaces.active
    view.region_3d.view_perspective = "CAMERA"
    with inside("VIEW_3D"):
        bpy.ops.view3d.view_center_camera()
    view.shading.type = "RENDERED"
    while viewport.samples() < 32:
        yield 0.5
    desk.picture_of_window("viewport")


def _open_import_menu(desk):
    """Opens File > Import in the top bar; Esc closes both menus."""
    top = window.first().height - 13
    yield from desk.click(46, top)
    yield from desk.press("I", 46, top)
    yield from desk.press("UP_ARROW", 46, top)  # from the first entry to the last
    desk.picture_of_window("import_menu", height=570, width=760)
    for _ in range(2):
        yield from desk.press("ESC", 46, top)
    yield from desk.point(100, 200)  # where hovering highlights nothing


def library(desk, measurement, _facts):
    """Browsing a folder of measurements in the Material tab."""
    yield from desk.arrange()
    _start()
    with inside("VIEW_3D"):
        add_monkey().active_material = bpy.data.materials.new("Material")
    folder = desk.folder / "measurements"
    folder.symlink_to(project.data_folder() / "brdf")
    bpy.ops.wm.save_as_mainfile(filepath=str(desk.folder / "library.blend"))
    preferences = inputs.module("operators.browse").addon_preferences(bpy.context)
    preferences.measurements = "//measurements/"  # Blender's notation for paths relative to the .blend
    bpy.context.window_manager.velour.browser.chosen = str(folder / measurement.name)
    yield from desk.show("MATERIAL")
    yield from desk.fold("MATERIAL", "Measurement Library", is_open=True)
    browser = inputs.module("ui.browser")
    yield from desk.until(lambda: browser.is_at_rest() and browser._pictures, "the pictures of the library")
    desk.picture_of_panels("library", "MATERIAL", "Measurement Library")


def tolerance(desk, measurement, facts):
    """The same measurement fitted with several tolerances, side by side."""
    yield from desk.arrange()
    _start(256, (250, 250))
    with inside("VIEW_3D"):
        add_monkey()
        bpy.ops.velour.load_material(filepath=str(measurement), fit=False)
    add_world()
    _look_at((0, 0, 0.05), (0.5, -6.2, 1.0), 85)
    yield from desk.show("MATERIAL")
    material, facts["fits"], parts = _material(), [], []
    for error, most in ((0.5, 2), (0.1, 16), (0.02, 16)):
        desk.start(bpy.ops.velour.fit, material=material.name, tolerance=error, max_lobes=most)
        yield from desk.job()
        facts["fits"].append({"tolerance": error, "max_lobes": most, **_fit_facts(material)})
        parts.append(_render(desk.folder, f"part-{len(parts)}"))
    scenes.velour_node(material).velour.use_reference = True
    parts.append(_render(desk.folder, "part-measured"))
    scenes.velour_node(material).velour.use_reference = False
    desk.side_by_side("tolerances", parts)
    yield from desk.open_panels("Advanced", "Plots")
    yield from desk.plot("ORDER")
    desk.picture_of_panels("size_plot", "MATERIAL", "Plots")


def scene_model(desk, measurement, facts):
    """A table top in car paint, seen from few angles under a soft environment."""
    sky = (0.6, 0.75, 1.0)
    yield from desk.arrange()
    _start(256, (380, 260)).frame_end = 1
    background = bpy.context.scene.world.node_tree.nodes["Background"]
    bpy.context.scene.world.color = sky
    background.inputs["Color"].default_value, background.inputs["Strength"].default_value = (*sky, 1), 1
    with inside("VIEW_3D"):
        bpy.ops.mesh.primitive_circle_add(vertices=128, fill_type="NGON")
        bpy.ops.velour.load_material(filepath=str(measurement))
    yield from desk.job()
    _look_at((0, -0.05, 0), (0.6, -4.2, 3.4), 72)
    material, parts = _material(), [_render(desk.folder, "part-full")]
    yield from desk.show("MATERIAL")
    desk.start(bpy.ops.velour.fit_for_scene, material=material.name)
    yield from desk.job()
    parts.append(_render(desk.folder, "part-scene"))
    node = scenes.velour_node(material)
    for name, image in (("full", node.image), ("scene", node.velour.scene_model)):
        facts[name] = _model_info(image)["parameter_bytes"]
    yield from desk.open_panels("Advanced", "Scene Model")
    desk.picture_of_panels("scene_model", "MATERIAL", "Scene Model")
    desk.side_by_side("scene_model_pictures", parts)


_WEAVE = "weave"


def tile(desk, _measurement, facts):
    """A weave, modeled, captured, and made into a material with a silhouette (VOTF)."""
    yield from desk.arrange()
    yield from _model_tile(desk)
    yield from _capture(desk, facts)
    yield from _compress(desk, facts)
    node = scenes.velour_node(bpy.data.materials[_WEAVE])
    node.velour.structure = bpy.data.objects["Plain Weave"]
    desk.start(bpy.ops.velour.add_votf)
    yield from desk.job()
    facts["outlined_bytes"] = _model_info(node.image)["bytes"]
    yield from desk.show("MATERIAL")
    yield from desk.fold("MATERIAL", "Silhouette (VOTF)", is_open=True)
    yield from desk.drawn("OUTLINE")
    desk.picture_of_panels("outline", "MATERIAL", "Silhouette (VOTF)")
    bpy.ops.velour.save_model(filepath=str(desk.folder / f"{_WEAVE}.velour"), material=_WEAVE)


def _model_tile(desk):
    _start()
    bpy.context.scene.unit_settings.scale_length = 0.001
    shading = area("VIEW_3D").spaces.active.shading
    shading.type, shading.color_type = "SOLID", "MATERIAL"
    with inside("VIEW_3D"):
        bpy.ops.velour.add_mesostructure(type="WEAVE")
        bpy.ops.view3d.view_selected()
        bpy.ops.velour.repeat_tile()
    yield from desk.show("OBJECT")
    yield from desk.fold("OBJECT", "Transform", is_open=False)
    yield from desk.fold("OBJECT", "Mesostructure", is_open=True)
    desk.picture_of_window("tile")


def _capture(desk, facts):
    settings = bpy.context.view_layer.objects.active.velour
    bpy.ops.wm.save_as_mainfile(filepath=str(desk.folder / "tile.blend"))
    settings.directory, settings.sides = f"//{_WEAVE}.btf", "ONE"
    settings.texels, settings.views, settings.lights, settings.samples = 48, 81, 81, 4
    yield 0.5
    desk.start(bpy.ops.velour.capture_btf)
    yield from desk.job(until=0.3)
    desk.picture_of_panels("capture", "OBJECT", "Mesostructure")
    yield from desk.job()
    facts["capture_bytes"] = sum(file.stat().st_size for file in (desk.folder / f"{_WEAVE}.btf").iterdir())


def _compress(desk, facts):
    desk.start(bpy.ops.velour.compress_btf)
    yield from desk.job()
    info = _model_info(scenes.velour_node(bpy.data.materials[_WEAVE]).image)
    facts["model_bytes"], facts["ratio"] = info["bytes"], info["raw_bytes"] / info["bytes"]
    with inside("VIEW_3D"):
        bpy.ops.mesh.primitive_plane_add(size=4, location=(6, 1, 0))
        bpy.context.object.active_material = bpy.data.materials[_WEAVE]
    yield from desk.show("MATERIAL")
    yield from desk.open_panels("Advanced", "Plots", "Model")
    yield from desk.plot("ORDER")
    desk.picture_of_panels("btf_model", "MATERIAL", "Model")


def cloth(desk, _measurement, _facts):
    """The model of the weave on a cloth, in a separate file."""
    yield from desk.arrange()
    _start(64, (560, 440))
    with inside("VIEW_3D"):
        _add_curtain()
        bpy.ops.velour.load_material(filepath=str(desk.folder.parent / f"tile/{_WEAVE}.velour"))
    yield from desk.job()
    placement = scenes.velour_node(_material()).velour.placement
    placement.mode, placement.repeats = "REPEATS", (14, 14)
    scenes.set_look(_material(), rotation=math.radians(30))
    add_world()
    _look_at((0, 0, 0), (0.5, -3.9, 0.4), 90)
    yield from desk.show("MATERIAL")
    desk.picture_of_panels("placement", "MATERIAL", "Placement")
    _render(desk.folder, "cloth")


def _add_curtain():
    """A hanging curtain, a meter wide, with a UV map as uniform as the flat grid."""
    turned = (math.pi / 2, 0, 0)
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=120, y_subdivisions=120, size=1, rotation=turned)
    for vertex in bpy.context.object.data.vertices:
        x, y, _ = vertex.co
        vertex.co.z = 0.07 * np.sin(17 * x + 1.5 * y) * (0.8 - 0.5 * y) + 0.03 * np.sin(31 * x + 2)
    bpy.ops.object.shade_smooth()


def _material():
    return bpy.context.view_layer.objects.active.active_material


def _model_info(image) -> dict:
    """info() of the model that an image datablock holds."""
    with inputs.module("export.files").read_model(image, image.name) as model:
        return model.info()


def _fit_facts(material) -> dict:
    info = _model_info(scenes.velour_node(material).image)
    return {"lobes": info["lobes"], "bytes": info["bytes"], "error": info["relative_l2"]}


def _start(samples: int = 128, size: tuple[int, int] = (640, 420)) -> bpy.types.Scene:
    """Removes the cube and the light of a new file, and selects Velour as the engine."""
    for name in ("Cube", "Light"):
        bpy.data.objects.remove(bpy.data.objects[name])
    scene = bpy.context.scene
    scene.render.engine = "VELOUR"
    scene.velour.samples = samples
    scene.render.resolution_x, scene.render.resolution_y = size
    return scene


def add_monkey() -> bpy.types.Object:
    bpy.ops.mesh.primitive_monkey_add(rotation=(math.radians(-25), 0, math.radians(30)))
    monkey = bpy.context.object
    bpy.ops.object.subdivision_set(level=3)
    bpy.ops.object.shade_smooth()
    return monkey


def add_world() -> None:
    """A courtyard whose sun comes from the left."""
    build.world("courtyard", rotation=250.0)


def _look_at(target: tuple[float, float, float], origin: tuple[float, float, float], lens: float) -> None:
    camera = bpy.context.scene.camera
    camera.location, camera.data.lens = origin, lens
    build.turn(camera, target)


def _render(folder, name: str, size: tuple[int, int] | None = None) -> str:
    """Renders like F12, and saves the picture as displayed. Returns its name."""
    scene = bpy.context.scene
    if size:
        scene.render.resolution_x, scene.render.resolution_y = size
    bpy.ops.render.render()
    scene.render.image_settings.file_format = "PNG"
    scene.render.image_settings.color_mode = "RGB"
    bpy.data.images["Render Result"].save_render(str(folder / f"{name}.png"))
    return name
