"""What real time drew, and the ray tracer's picture of the same view under the same light."""

from typing import NamedTuple

import bpy
import numpy as np

from . import scenes, viewport, window
from .inputs import native


def ball(material):
    """In the place of Blender's cube, and no lamp."""
    for name in ("Cube", "Light"):
        bpy.data.objects.remove(bpy.data.objects[name])
    with window.override():
        bpy.ops.mesh.primitive_uv_sphere_add(segments=96, ring_count=48, radius=2.0)
        return scenes._finish(material, smooth=True)


def pixels():
    """[height x width x 4] of what was drawn."""
    targets = viewport.real_time()._drawing._targets
    width, height = targets.size
    buffer = targets.mean().read()
    buffer.dimensions = width * height * 4
    return np.array(buffer, np.float32).reshape(height, width, 4)


def equirectangular(mixture, height=512):
    """[height x 2 height x 3], row 0 at the top: what a mixture of Gaussians is from all around."""
    rows, columns = (np.arange(height) + 0.5) / height, (np.arange(2 * height) + 0.5) / (2 * height)
    latitude, azimuth = np.pi * (0.5 - rows)[:, None], 2 * np.pi * (0.5 - columns)[None]
    w = np.stack(
        (
            np.cos(latitude) * np.cos(azimuth),
            np.cos(latitude) * np.sin(azimuth),
            np.broadcast_to(np.sin(latitude), (height, 2 * height)),
        ),
        axis=-1,
    )
    pixels = np.zeros((height, 2 * height, 3))
    for lobe in mixture:
        pixels += np.exp(lobe[3] * (w @ lobe[:3] - 1))[..., None] * lobe[4:]
    return pixels.astype(np.float32)


def mixture():
    """[lobes x 7] Center, bandwidth and color of what the viewport is lit by."""
    return np.array(viewport.real_time()._drawing.light_report["mixture"]).reshape(-1, 7)


class Traced(NamedTuple):
    """Two pictures of the ray tracer, whose noise is independent."""

    first: np.ndarray  # [height x width x 4]
    second: np.ndarray

    @property
    def mean(self):
        return (self.first + self.second) / 2


def traced(light=None, samples=1024):
    """The same view by the ray tracer, direct light alone, as Traced of half the samples each.

    `light`: pixels in the world's place.
    """
    lib = native()
    export = viewport.addon("export.live"), viewport.addon("export.look"), viewport.addon("export.viewport")
    with viewport.override():
        context = bpy.context
        depsgraph = context.evaluated_depsgraph_get()
        live = export[0].LiveExport(depsgraph, export[1].Look(context, depsgraph))
        frame = export[2].viewport_frame(context, depsgraph)
    try:
        if light is not None:
            live.scene.set_world_pixels(light)
        frame.view.add_to(live.scene)
        live.scene.commit()
        size = {"width": frame.view.width, "height": frame.view.height}
        return Traced(*(_rendered(lib, live.scene, spp=samples // 2, seed=seed, **size) for seed in (1, 2)))
    finally:
        live.close()


def _rendered(lib, scene, **options):
    job = lib.render_job(scene, bounces=0, strategy="mis", transparent=1, **options)
    try:
        job.run()
        return job.read_pass("Combined")
    finally:
        job.close()


def error(drawn, traced):
    """Relative L2 of colors where both show objects alone, off outlines, without the ray tracer's noise.

    That is of another sign in each of the two pictures as often as not, so it leaves nothing in the mean of
    products of both differences, nor in that of both pictures.
    """
    inside = np.ones(drawn.shape[:2], bool)
    for picture in (drawn, *traced):
        whole = picture[..., 3] > 0.999
        for axis in (0, 1):
            for step in (-1, 1):
                inside &= np.roll(whole, step, axis)
    assert inside.sum() > 500, inside.sum()
    first, second = (picture[inside][:, :3].astype(float) for picture in traced)
    pixels = drawn[inside][:, :3]
    square = ((pixels - first) * (pixels - second)).sum() / (first * second).sum()
    return np.sqrt(max(square, 0.0))


def difference(before, now):
    """Relative L2 of two drawn pictures, as above."""
    return error(now, Traced(before, before))


def sky(folder):
    """A world with a soft sun, saved as a picture."""
    sun = (0.6, -0.5, 0.62)
    mixture = np.array(
        (
            (0, 0, 1, 0.8, 0.5, 0.6, 0.9),
            (*np.array(sun) / np.linalg.norm(sun), 300, 60, 50, 40),
            (-1, 0, 0, 20, 0.8, 0.5, 0.2),
        )
    )
    shine(folder, equirectangular(mixture))
    bpy.context.scene.render.film_transparent = True


def shine(folder, pixels):
    """A world of pixels, row 0 at the top, saved as a picture."""
    path = folder / "sky.exr"
    native().images.write(path, np.ascontiguousarray(pixels[::-1]))
    world = scenes.set_world()
    node = world.node_tree.nodes.new("ShaderNodeTexEnvironment")
    node.image = bpy.data.images.load(str(path))
    world.node_tree.links.new(node.outputs[0], world.node_tree.nodes["Background"].inputs["Color"])
