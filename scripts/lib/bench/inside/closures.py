"""A measured material under environment maps: by its measurement in Velour, by its nodes in Cycles."""

import os

import bpy
from velour.export.files import read_model
from velour.operators import approximation_group
from velour.operators.measured import file_image

from . import scene as build


def main(task):
    """Writes WORLD-SHAPE-ENGINE.exr for every world and shape; returns the nodes' error."""
    scene = build.empty((task["size"], task["size"]), 8 * task["samples"], 0)
    scene.render.film_transparent = True
    cycles = scene.cycles
    cycles.samples, cycles.max_bounces, cycles.use_denoising = task["samples"], 0, False
    cycles.use_adaptive_sampling = False
    build.camera((0, -7, 1.5), lens=85)
    materials = [material(task, masking) for masking in ("closures", None)]
    for make in (_sphere, build.monkey):
        shape = make()
        for world in task["worlds"]:
            build.world(world)
            name = f"{os.path.basename(world)}-{shape.name}"
            for engine, own in (("VELOUR", 0), ("CYCLES", 0), ("CYCLES", 1)):
                shape.data.materials.clear()
                shape.data.materials.append(materials[own])
                scene.render.engine = engine
                kind = "measurement" if engine == "VELOUR" else ("network", "principled")[own]
                build.render(task["folder"], f"{name}-{kind}")
        bpy.data.objects.remove(shape)
    tree = build.measured_node(materials[0]).group.node_tree
    return {"relative_l2": tree.velour.relative_l2, "fitted": tree.velour.fitted}


def material(task, masking):
    """The measured material of a model and its measurement, with the network ("closures") or with one
    Principled BSDF (None)."""
    before = set(bpy.data.materials)
    bpy.ops.velour.load_material(filepath=task["model"])
    (found,) = set(bpy.data.materials) - before
    node = build.measured_node(found)
    node.velour.measurement, node.velour.use_reference = file_image(task["measurement"]), True
    with read_model(node.image, "The material") as model:
        steps = approximation_group.Steps(
            model,
            approximation_group.has_layers(),
            masking and approximation_group.MASKING,
        )
        while job := steps.next_job():
            job.start().wait()
        approximation_group.put(node, found, steps.result, model.info())
    return found


def _sphere():
    found = build.ball((0, 0, 0), 1, segments=256)
    found.name = "sphere"
    return found
