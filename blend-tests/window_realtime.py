"""The viewport in real time: beside the ray tracer under the same light, without shadows."""

from pathlib import Path

import bpy
import numpy as np

from support import scenes, viewport, window
from support.inputs import native

_DATA = Path(__file__).parent / "scenes/data"


def start(folder):
    """Called by the harness once the window is there."""
    window.run(folder, (ball_in_a_sky, btf, lamps, grey, edits))


def _pixels():
    """[height x width x 4] of what was drawn."""
    targets = viewport.real_time()._drawing._targets
    width, height = targets.size
    buffer = targets.mean().read()
    buffer.dimensions = width * height * 4
    return np.array(buffer, np.float32).reshape(height, width, 4)


def _equirectangular(mixture, height=512):
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


def _mixture():
    """[lobes x 7] Centre, bandwidth and colour of what the viewport is lit by."""
    return np.array(viewport.real_time()._drawing.light_report["mixture"]).reshape(-1, 7)


def _traced(light=None, samples=1024):
    """The same view by the ray tracer, direct light alone; `light`: pixels in the world's place."""
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
        job = lib.render_job(live.scene, spp=samples, bounces=0, strategy="mis", **size)
        job.run()
        pixels = job.read_pass("Combined")
        job.close()
        return pixels
    finally:
        live.close()


def _error(drawn, traced):
    """Relative L2 of colours where both show objects alone, off their outlines."""
    inside = np.ones(drawn.shape[:2], bool)
    for picture in (drawn, traced):
        whole = picture[..., 3] > 0.999
        for axis in (0, 1):
            for step in (-1, 1):
                inside &= np.roll(whole, step, axis)
    assert inside.sum() > 500, inside.sum()
    difference = (drawn - traced)[inside][:, :3]
    return np.linalg.norm(difference) / np.linalg.norm(traced[inside][:, :3])


def _ball(material):
    for name in ("Cube", "Light"):
        bpy.data.objects.remove(bpy.data.objects[name])
    with window.override():
        bpy.ops.mesh.primitive_uv_sphere_add(segments=96, ring_count=48, radius=2.0)
        ball = scenes._finish(material, smooth=True)
    return ball


def _sky(folder):
    """A world with a soft sun, saved as a picture."""
    sun = (0.6, -0.5, 0.62)
    mixture = np.array(
        (
            (0, 0, 1, 0.8, 0.5, 0.6, 0.9),
            (*np.array(sun) / np.linalg.norm(sun), 300, 60, 50, 40),
            (-1, 0, 0, 20, 0.8, 0.5, 0.2),
        )
    )
    path = folder / "sky.exr"
    native().images.write(path, np.ascontiguousarray(_equirectangular(mixture)[::-1]))
    world = scenes.set_world()
    node = world.node_tree.nodes.new("ShaderNodeTexEnvironment")
    node.image = bpy.data.images.load(str(path))
    world.node_tree.links.new(node.outputs[0], world.node_tree.nodes["Background"].inputs["Color"])
    bpy.context.scene.render.film_transparent = True


def ball_in_a_sky(folder):
    """Within three hundredths of the ray tracer that is lit by the same mixture."""
    _sky(folder)
    _ball(scenes.measured_material((_DATA / "paint.velour").read_bytes()))
    viewport.show_real_time()
    yield from viewport.real_time_finished()
    window.screenshot(folder, "ball")
    drawn = _pixels()
    same = _error(drawn, _traced(_equirectangular(_mixture())))
    picture = _error(drawn, _traced())
    print(f"relative L2: {same:.4f} under the mixture, {picture:.4f} under the picture", flush=True)
    assert same < 0.03, same
    assert picture < 0.05, picture


def btf(folder):
    """A plane of a weave by its maps, within three hundredths of the ray tracer as well."""
    _sky(folder)
    for name in ("Cube", "Light"):
        bpy.data.objects.remove(bpy.data.objects[name])
    with window.override():
        scenes.add_plane(scenes.measured_material((_DATA / "weave.velour").read_bytes(), "Weave"), size=9.0)
    viewport.show_real_time()
    yield from viewport.real_time_finished()
    window.screenshot(folder, "btf")
    assert not viewport.the_one()._not_real_time, viewport.the_one()._not_real_time
    error = _error(_pixels(), _traced(_equirectangular(_mixture())))
    print(f"relative L2 of a BTF: {error:.4f}", flush=True)
    assert error < 0.03, error


def lamps(folder):
    """Sun, point, spot and area as the ray tracer's, on a ball that casts no shadow on itself."""
    _ball(scenes.measured_material((_DATA / "paint.velour").read_bytes()))
    scenes.set_world((0, 0, 0))
    bpy.context.scene.render.film_transparent = True
    for kind, energy in (("SUN", 2.0), ("POINT", 800.0), ("SPOT", 800.0), ("AREA", 800.0)):
        lamp = bpy.data.lights.new(kind, kind)
        lamp.energy = energy
        if kind == "SPOT":
            lamp.spot_size, lamp.spot_blend = 1.2, 0.3
        obj = bpy.data.objects.new(kind, lamp)
        obj.location = (5, -4, 4)
        obj.rotation_euler = (0.98, 0, 0.9)  # towards the middle
        bpy.context.scene.collection.objects.link(obj)
        viewport.show_real_time()
        yield from viewport.real_time_finished()
        yield 0.3
        window.screenshot(folder, f"lamp-{kind.lower()}")
        error = _error(_pixels(), _traced())
        print(f"relative L2 under {kind}: {error:.4f}", flush=True)
        assert error < 0.06, (kind, error)
        bpy.data.objects.remove(obj)


def grey(folder):
    """Scene-linear 0.18 is 118 of 255 under Standard."""
    for name in ("Cube", "Light"):
        bpy.data.objects.remove(bpy.data.objects[name])
    scenes.set_world((0.18, 0.18, 0.18))
    viewport.show_real_time()
    yield from viewport.real_time_finished()
    values = 255 * viewport.middle(window.screenshot(folder, "grey"))
    assert np.abs(values - 118).max() <= 1, (values.min(), values.max())


def edits(folder):
    """What is moved, coloured or lit anew is drawn anew."""
    scenes.set_world((0.5, 0.7, 1.0), 0.5)
    cube = bpy.data.objects["Cube"]
    cube.active_material = bpy.data.materials["Material"]
    viewport.show_real_time()
    yield from viewport.real_time_finished()
    last = _pixels()

    def turn():
        cube.rotation_euler.z = 0.5

    def paint():
        node = cube.active_material.node_tree.nodes["Principled BSDF"]
        node.inputs["Base Color"].default_value = (0.8, 0.1, 0.1, 1)

    def brighten():
        bpy.data.objects["Light"].data.energy *= 3

    def darken():
        scenes.set_world((0.1, 0.1, 0.1))

    for edit in (turn, paint, brighten, darken):
        edit()
        yield 0.3
        yield from viewport.real_time_finished()
        seen = _pixels()
        assert np.abs(seen - last).max() > 0.02, edit.__name__
        window.screenshot(folder, f"edit-{edit.__name__}")
        last = seen
