"""The same measurement with several tolerances, side by side; and a model for the scene."""

import bpy
import numpy as np
from support import framebuffer, scenes

from . import scene
from .desk import inside
from .facts import fit_facts, model_info

SIZE = (250, 250)
SAMPLES = 256
FITS = ((0.5, 2), (0.1, 16), (0.02, 16))  # tolerance, most lobes


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
    _side_by_side(desk.folder, [*(f"part-{number}" for number in range(len(FITS))), "part-measured"])
    yield from desk.plot("ORDER")
    desk.picture_of_panels("size_plot", "MATERIAL", "Plots")
    yield from _fit_for_scene(desk, material, facts)


def _side_by_side(folder, names):
    pictures = [
        (255 * scenes.read(folder / f"{name}.png")[..., :3]).round().astype(np.uint8) for name in names
    ]
    for name in names:
        (folder / f"{name}.png").unlink()
    framebuffer.write_png(folder / "tolerances.png", np.concatenate(pictures, axis=1))


def _fit_for_scene(desk, material, facts):
    bpy.context.scene.frame_end = 1
    desk.start(bpy.ops.velour.fit_for_scene, material=material.name)
    yield from desk.job()
    yield 1.0
    desk.picture_of_panels("scene_model", "MATERIAL", "Model for the Scene")
    info = model_info(scenes.velour_node(material).velour.scene_model)
    facts["scene"] = {
        "bytes": info["parameter_bytes"],
        "full_bytes": info["scene"]["full_parameter_bytes"],
        "picture_error": info["scene"]["picture_error"],
        "full_picture_error": info["scene"]["full_picture_error"],
    }
