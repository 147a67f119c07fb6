"""The viewport in real time: beside the ray tracer under the same light, without shadows."""

from pathlib import Path

import bpy
import numpy as np

from support import realtime, scenes, viewport, window

_DATA = Path(__file__).parent / "scenes/data"
SCREEN = "1400x720"


def start(folder):
    """Called by the harness once the window is there."""
    window.run(folder, (ball_in_a_sky, btf, holdouts_and_backs, gray), viewport=True)


def ball_in_a_sky(folder):
    """Within three hundredths of the ray tracer that is lit by the same mixture."""
    realtime.sky(folder)
    realtime.ball(scenes.measured_material((_DATA / "paint.velour").read_bytes()))
    viewport.show_real_time()
    yield from viewport.real_time_finished()
    window.screenshot(folder, "ball")
    drawn = realtime.pixels()
    traced = realtime.traced(realtime.equirectangular(realtime.mixture()))
    same = realtime.error(drawn, traced)
    picture = realtime.error(drawn, realtime.traced())
    print(f"relative L2: {same:.4f} under the mixture, {picture:.4f} under the picture", flush=True)
    assert same < 0.02, same
    assert picture < 0.05, picture
    off = realtime.error(1.04 * drawn, traced)
    assert 0.03 < off < 0.06, off  # what is off by more would be seen


def btf(folder):
    """A plane of a weave by its maps, within three hundredths of the ray tracer as well."""
    realtime.sky(folder)
    for name in ("Cube", "Light"):
        bpy.data.objects.remove(bpy.data.objects[name])
    with window.override():
        scenes.add_plane(scenes.measured_material((_DATA / "weave.velour").read_bytes(), "Weave"), size=9.0)
    viewport.show_real_time()
    yield from viewport.real_time_finished()
    window.screenshot(folder, "btf")
    assert not viewport.the_one()._refusal, viewport.the_one()._refusal.sentence
    error = realtime.error(realtime.pixels(), realtime.traced(realtime.equirectangular(realtime.mixture())))
    print(f"relative L2 of a BTF: {error:.4f}", flush=True)
    assert error < 0.03, error


def holdouts_and_backs(folder):
    """A holdout hides itself and what is behind it; through a culled back one sees what is behind it."""
    scenes.set_world((0.5, 0.7, 1.0), 0.5)
    bpy.context.scene.render.film_transparent = True
    cube = bpy.data.objects["Cube"]
    cube.is_holdout, cube.location = True, (1.5, -1.5, 1.0)
    with window.override():
        scenes.add_plane(scenes.diffuse_material((0.8, 0.3, 0.1)), size=7.0)
        culled = scenes.measured_material((_DATA / "paint.velour").read_bytes())
        scenes.set_look(culled, tint=(0.1, 0.3, 1.0))
        culled.use_backface_culling = True
        for x, scale in ((-2.5, 1.0), (0.0, -1.0)):
            for turn in (0.0, np.pi):
                bpy.ops.mesh.primitive_plane_add(size=1.5, location=(x, turn / 2, 1.0), rotation=(turn, 0, 0))
                plane = bpy.context.object
                plane.scale.x = scale
                plane.data.materials.append(culled)
    viewport.show_real_time()
    yield from viewport.real_time_finished()
    window.screenshot(folder, "holdouts")
    drawn, traced = realtime.pixels(), realtime.traced(samples=256).mean
    alpha = np.abs(drawn[..., 3] - traced[..., 3])
    blue = np.abs((drawn[..., 2] > drawn[..., 0]).astype(float) - (traced[..., 2] > traced[..., 0]))
    print(f"alpha is off by {alpha.mean():.4f}, what is blue by {blue.mean():.4f}", flush=True)
    assert (drawn[..., 2] > drawn[..., 0]).sum() > 100, "no front of what is culled is seen"
    assert alpha.mean() < 0.005, alpha.mean()
    assert blue.mean() < 0.005, blue.mean()


def gray(folder):
    """Scene-linear 0.18 is 118 of 255 under Standard."""
    for name in ("Cube", "Light"):
        bpy.data.objects.remove(bpy.data.objects[name])
    scenes.set_world((0.18, 0.18, 0.18))
    viewport.show_real_time()
    yield from viewport.real_time_finished()
    values = 255 * viewport.middle(window.screenshot(folder, "gray"))
    assert np.abs(values - 118).max() <= 1, (values.min(), values.max())
