"""The chapter tolerance: the same measurement fitted with several tolerances, side by side."""

import bpy
from support import scenes

from . import scene
from .desk import inside
from .facts import fit_facts

SIZE = (250, 250)
SAMPLES = 256
FITS = ((0.5, 2), (0.1, 16), (0.02, 16))  # tolerance, maximum number of lobes


def steps(desk, measurement, facts):
    yield from desk.arrange()
    scene.start(SAMPLES, SIZE)
    with inside("VIEW_3D"):
        monkey = scene.add_monkey()
        bpy.ops.velour.load_material(filepath=str(measurement), fit=False)
    scene.add_world()
    scene.look_at((0, 0, 0.05), (0.5, -6.2, 1.0), 85)
    yield from desk.show("MATERIAL")
    material = monkey.active_material
    facts["fits"] = []
    for number, (tolerance, most) in enumerate(FITS):
        desk.start(bpy.ops.velour.fit, material=material.name, tolerance=tolerance, max_lobes=most)
        yield from desk.job()
        facts["fits"].append({"tolerance": tolerance, "max_lobes": most, **fit_facts(material)})
        scene.render(desk.folder, f"part-{number}")
    scenes.velour_node(material).velour.use_reference = True
    scene.render(desk.folder, "part-measured")
    scenes.velour_node(material).velour.use_reference = False
    parts = [*(f"part-{number}" for number in range(len(FITS))), "part-measured"]
    desk.side_by_side("tolerances", parts)
    for label in ("Advanced", "Plots"):
        yield from desk.fold("MATERIAL", label, is_open=True)
    yield from desk.plot("ORDER")
    desk.picture_of_panels("size_plot", "MATERIAL", "Plots")
