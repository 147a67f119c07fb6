"""Measures the microfiber sheen of Cycles in Blender 4.0 and newer (scripts/sheen_table).

Cycles interpolates a, b and the albedo of a linearly transformed cosine [ZBC22] over the cosine of the view
and the roughness. A grid of tilted faces shows every entry of its tables under suns from several directions:
f at any three of them determines an entry. Writes units of 1e-5 at [roughness][cosine][a, b, albedo], both
from 0 to 1 in 31 steps.
"""

import math
import sys
import tempfile
import textwrap
from pathlib import Path

import bpy
import numpy as np
from mathutils import Vector

SIDE = 32  # entries along the cosine and along the roughness
CELL = 3  # pixels of an entry; the middle one is read
# In the plane of a face's tilt (about x) and beside it: polar angle and azimuth of the suns, degrees
SUNS = [(0, 0), (35, 0), (65, 0), (35, 180), (65, 180), (45, 90), (70, 60), (70, 120), (50, 45), (80, 30)]
HALF = 0.5 / (SIDE - 1)  # an edge-on face is not seen: the first row follows from one half a step above it


def main(output: Path) -> None:
    cosines = np.linspace(0, 1, SIDE)
    cosines[0] = HALF
    table = measured(cosines)
    table[0] = np.where(table[1] == 0, 0, 2 * table[0] - table[1])
    table[-1, :, 1] = 0  # the view is the normal, about which f is symmetric
    numbers = [str(n) for n in np.rint(table * 1e5).astype(int).transpose(1, 0, 2).ravel()]
    version = ".".join(str(n) for n in bpy.app.version)
    text = textwrap.fill(", ".join(numbers) + ",", 120)
    output.write_text(f"// Written by scripts/sheen_table in Blender {version}.\n{text}\n")


def measured(cosines: np.ndarray) -> np.ndarray:
    """a, b and albedo at [cosine, roughness]; zeros where Cycles leaves sheen out."""
    scene = bpy.context.scene
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    scene.render.engine = "CYCLES"
    scene.world = None
    _grid(cosines)
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.data.type, camera.data.ortho_scale = "ORTHO", SIDE
    camera.location = (SIDE / 2, SIDE / 2, 500)
    camera.data.clip_end = 1000
    scene.collection.objects.link(camera)
    scene.camera = camera
    scene.render.resolution_x = scene.render.resolution_y = SIDE * CELL
    scene.cycles.max_bounces, scene.cycles.light_sampling_threshold = 0, 0
    scene.cycles.samples, scene.cycles.pixel_filter_type = 1, "BOX"
    scene.cycles.use_adaptive_sampling = scene.cycles.use_denoising = False
    scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
    sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    sun.data.angle, sun.data.energy, sun.data.use_shadow = 0, 1, False
    scene.collection.objects.link(sun)
    tilt = np.arccos(cosines)
    normals = np.stack([np.zeros(SIDE), np.sin(tilt), np.cos(tilt)], -1)
    along = np.stack([np.zeros(SIDE), -np.cos(tilt), np.sin(tilt)], -1)  # of the view on the face
    across = np.cross(normals, along)
    rows, radiance = [], []
    for polar, azimuth in SUNS:
        polar, azimuth = math.radians(polar), math.radians(azimuth)
        across_tilt, in_tilt = math.sin(azimuth), math.cos(azimuth)
        light = np.array([math.sin(polar) * across_tilt, math.sin(polar) * in_tilt, math.cos(polar)])
        sun.rotation_mode = "QUATERNION"
        sun.rotation_quaternion = Vector(light).to_track_quat("Z", "Y")
        radiance.append(_render(scene) * math.pi)
        rows.append(np.stack([along @ light, across @ light, normals @ light], -1))
    x, y, z = np.moveaxis(np.array(rows), -1, 0)  # [sun, cosine]
    terms = np.stack([x * x + y * y, 2 * x * z, z * z], -1)
    result = np.zeros((SIDE, SIDE, 3))
    for i in range(SIDE):
        for j in range(SIDE):
            # f pi = albedo (a / |M wl|^2)^2: its inverse square root is linear in three unknowns.
            seen = np.array([radiance[s][i, j] for s in range(len(SUNS))])
            lit = (z[:, i] > 0.02) & (seen > 0)
            if lit.sum() < 4:
                continue
            right = np.sqrt(z[lit, i] / seen[lit])
            (p, q, r), *_ = np.linalg.lstsq(terms[lit, i] / right[:, None], np.ones(lit.sum()), rcond=None)
            slope = q / p  # b / a
            a = math.sqrt(p / (r - p * slope * slope))
            result[i, j] = a, slope * a, a * a / (p * p)
    return result


def _grid(cosines: np.ndarray) -> None:
    """Faces whose normals have these cosines with the view along x, with roughness rising along y."""
    corners, faces, roughness = [], [], []
    for i, cosine in enumerate(cosines):
        for j in range(SIDE):
            rise = math.sqrt(1 - cosine * cosine) / cosine
            ends = [(j + 0.02, rise * 0.48), (j + 0.98, -rise * 0.48)]
            (low, front), (high, back) = ends
            base = len(corners)
            corners += [(i, low, front), (i + 1, low, front), (i + 1, high, back), (i, high, back)]
            faces.append((base, base + 1, base + 2, base + 3))
            roughness.append(j / (SIDE - 1))
    mesh = bpy.data.meshes.new("faces")
    mesh.from_pydata(corners, [], faces)
    mesh.attributes.new("roughness", "FLOAT", "FACE").data.foreach_set("value", roughness)
    material = bpy.data.materials.new("sheen")
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    node = tree.nodes.new("ShaderNodeBsdfSheen")
    node.distribution = "MICROFIBER"
    node.inputs["Color"].default_value = (1, 1, 1, 1)
    attribute = tree.nodes.new("ShaderNodeAttribute")
    attribute.attribute_name = "roughness"
    tree.links.new(attribute.outputs["Fac"], node.inputs["Roughness"])
    tree.links.new(node.outputs[0], tree.nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    mesh.materials.append(material)
    bpy.context.scene.collection.objects.link(bpy.data.objects.new("faces", mesh))


def _render(scene) -> np.ndarray:
    """Radiance at [cosine, roughness]."""
    with tempfile.TemporaryDirectory() as folder:
        scene.render.filepath = str(Path(folder) / "sheen.exr")
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(scene.render.filepath)
        image.colorspace_settings.is_data = True
        pixels = np.empty(len(image.pixels), np.float32)
        image.pixels.foreach_get(pixels)
        bpy.data.images.remove(image)
    middle = slice(CELL // 2, None, CELL)
    return pixels.reshape(SIDE * CELL, SIDE * CELL, 4)[middle, middle, 0].T.astype(float)


main(Path(sys.argv[sys.argv.index("--") + 1]))
