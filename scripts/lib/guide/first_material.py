"""The chapter first_material: a measurement on a monkey, imported, fitted and rendered."""

import bpy
from support import viewport, window

from . import scene
from .desk import area, inside
from .facts import fit_facts

SIZE = (640, 440)
SAMPLES = 256
SEEN = 32  # samples that the viewport shows on its picture


def steps(desk, measurement, facts):
    yield from desk.arrange()
    _make_scene()
    yield from desk.show("RENDER")
    desk.picture_of_panels("engine", "RENDER", None, "Sampling")
    yield from _open_import_menu(desk)
    with inside("VIEW_3D"):
        bpy.ops.velour.load_material(filepath=str(measurement))
    yield from desk.job()
    yield from desk.show("MATERIAL")
    desk.picture_of_panels("material_panel", "MATERIAL", "Measured Material")
    for label in ("Advanced", "Plots", "Model"):
        yield from desk.fold("MATERIAL", label, is_open=True)
    yield from desk.plot("LOBES")
    desk.picture_of_panels("model_panel", "MATERIAL", "Model")
    desk.picture_of_panels("plot", "MATERIAL", "Plots")
    material = bpy.context.view_layer.objects.active.active_material
    facts.update(fit_facts(material), measurement_bytes=measurement.stat().st_size)
    scene.render(desk.folder, "first_render", SIZE)
    yield from _rendered_viewport(desk)


def _make_scene():
    scene.start(SAMPLES, SIZE)
    with inside("VIEW_3D"):
        scene.add_monkey()
    scene.add_world()
    scene.look_at((0, 0, 0.05), (0.5, -6.2, 1.0), 72)


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


def _rendered_viewport(desk):
    view = area("VIEW_3D").spaces.active
    view.region_3d.view_perspective = "CAMERA"
    with inside("VIEW_3D"):
        bpy.ops.view3d.view_center_camera()
    view.shading.type = "RENDERED"
    while viewport.samples() < SEEN:
        yield 0.5
    desk.picture_of_window("viewport")
