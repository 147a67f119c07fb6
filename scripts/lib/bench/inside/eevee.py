"""Measured materials, and two closures of Blender, under environment maps: in EEVEE and in Cycles."""

import os

import bpy

from . import closures
from . import scene as build

_NAMES = ("BLENDER_EEVEE_NEXT", "BLENDER_EEVEE")  # the former that Blender knows


def main(task):
    """Writes WORLD-MATERIAL-ENGINE.exr of a sphere; returns Blender's version and the name of its EEVEE."""
    scene = build.empty((task["size"], task["size"]), 1, 0)
    scene.render.film_transparent = True
    cycles = scene.cycles
    cycles.samples, cycles.max_bounces, cycles.use_denoising = task["samples"], 0, False
    cycles.use_adaptive_sampling = False
    scene.eevee.taa_render_samples = task["samples"]
    build.camera((0, -7, 1.5), lens=85)
    known = {item.identifier for item in type(scene.render).bl_rna.properties["engine"].enum_items}
    eevee = next(name for name in _NAMES if name in known)
    white = {"Color": (0.8, 0.8, 0.8)}
    materials = {
        "Diffuse": build.material("Diffuse", "BsdfDiffuse", **white),
        "Glossy": build.material("Glossy", "BsdfGlossy", **white, Roughness=0.3),
    }
    materials |= {name: closures.material(own, "closures") for name, own in task["materials"].items()}
    ball = build.ball((0, 0, 0), 1, segments=256)
    for world in task["worlds"]:
        build.world(world)
        for name, own in materials.items():
            ball.data.materials.clear()
            ball.data.materials.append(own)
            for kind, engine in (("eevee", eevee), ("cycles", "CYCLES")):
                scene.render.engine = engine
                build.render(task["folder"], f"{os.path.basename(world)}-{name}-{kind}")
    return {"blender": bpy.app.version_string, "engine": eevee}
