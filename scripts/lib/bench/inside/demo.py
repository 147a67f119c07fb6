"""The demo's scene, rendered with a model and with its measurement or BTF itself, and the points of the plot
of error against time."""

import bpy
import numpy as np
from velour.native import images, render_job

from . import scene as build

SIZE = (640, 480)
SAMPLES, BTF_SAMPLES, BOUNCES = 384, 96, 1
CAPTURE = {"texels": 48, "views": 81, "lights": 81, "samples": 8, "bounces": 1}
TILE = 0.11  # meters on the subject: large enough to see
PLOT_REDUCTION = 4  # factor by which the sides of the picture shrink
PLOT_REFERENCE_SAMPLES = 2048
PLOT_SAMPLES = (16, 64, 256)
PLOT_STRATEGIES = ("uniform", "cosine", "srbf", "light", "mis")


def main(task):
    """With a `model` of a `measurement` in the task: pictures and curves of them; otherwise of a BTF."""
    return _material(task) if "model" in task else _btf(task)


def _material(task):
    scene = build.empty(SIZE, SAMPLES, BOUNCES)
    subject = furnish()
    bpy.context.view_layer.objects.active = subject
    bpy.ops.velour.load_material(filepath=task["measurement"], fit=False)
    raw = build.measured_node(subject.active_material)
    bpy.ops.velour.load_material(filepath=task["model"])
    node = build.measured_node(subject.active_material)
    node.velour.measurement = raw.velour.measurement
    return _render_both(task["folder"], node)["model"] | {"curves": _curves(scene)}


def _btf(task):
    """Captures and compresses a tile of weave."""
    build.empty(SIZE, BTF_SAMPLES, BOUNCES)
    bpy.ops.velour.add_mesostructure(type="WEAVE")
    tile = bpy.context.object
    report = build.capture_and_compress(task["folder"], CAPTURE, 0)
    bpy.data.objects.remove(tile)
    subject = furnish()
    # A cube projection: tiles of one size all over the subject, with seams between the six sides.
    bpy.context.view_layer.objects.active = subject
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.uv.cube_project(cube_size=TILE)
    bpy.ops.object.mode_set(mode="OBJECT")
    subject.data.materials.append(bpy.data.materials[build.NAME])
    node = build.measured_node(bpy.data.materials[build.NAME])
    for name, rendered in _render_both(task["folder"], node).items():
        report[f"{name}_seconds"] = rendered["seconds"]
    return report


def furnish():
    """Adds the subject, a ground, the camera and a world. Returns the subject."""
    subject = build.set_down(build.monkey(turned=(-25, 30)))
    bpy.ops.mesh.primitive_circle_add(vertices=128, radius=9.0, fill_type="NGON")
    ground = {"Base_Color": (0.18, 0.17, 0.16), "Roughness": 0.6}
    bpy.context.object.data.materials.append(build.material("Ground", **ground))
    bpy.context.object.select_set(False)
    build.camera((0.6, -6.4, 1.2), (0, 0, 0.8), lens=72)
    build.world("courtyard", strength=0.7, rotation=250.0)
    subject.select_set(True)
    return subject


def _render_both(folder, node):
    """Writes reference.{exr,png} and model.{exr,png}; returns the reports."""
    reports = {}
    for name, itself in (("reference", True), ("model", False)):
        node.velour.use_reference = itself
        reports[name] = build.render(folder, name)
    return reports


def _curves(scene):
    """Strategy -> (seconds, relmse), against a long render of the same model: sampling error alone."""
    from velour.export import Notes, export_scene
    from velour.export.camera import final_view

    scene.render.resolution_x, scene.render.resolution_y = (side // PLOT_REDUCTION for side in SIZE)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    view = final_view(depsgraph)
    with export_scene(depsgraph, view, Notes()).scene as exported:

        def picture(strategy, samples, seed):
            options = {"strategy": strategy, "spp": samples, "seed": seed}
            with render_job(exported, width=view.width, height=view.height, **options) as job:
                seconds = job.run()["seconds"]
                return np.ascontiguousarray(job.read_pass("Combined")[..., :3]), seconds

        reference, _ = picture("mis", PLOT_REFERENCE_SAMPLES, seed=1)

        def point(strategy, samples):
            pixels, seconds = picture(strategy, samples, seed=2)
            return seconds, images.compare(pixels, reference)[1]

        return {name: [point(name, samples) for samples in PLOT_SAMPLES] for name in PLOT_STRATEGIES}
