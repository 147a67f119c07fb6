"""Outlines in real time beside those of the ray tracer."""

from pathlib import Path

import bpy
import numpy as np

from support import outlines, realtime, scenes, viewport, window

_DATA = Path(__file__).parent / "scenes/data"

LONG = "many pictures in real time, drawn without a graphics card"
SCREEN = "1400x720"


def start(folder):
    """Called by the harness once the window is there."""
    window.run(folder, (net_of_paint, net_of_its_btf, outline_comes_and_goes), viewport=True)


def _plane_of_its_btf(folder, structure):
    """A plane of a mesostructure's own BTF, with its outline; the hem, which has no sides, is far off."""
    scenes.remove_all_but_camera()
    with window.override():
        bpy.ops.velour.add_mesostructure(type=structure, count=2, resolution=8)
        tile = bpy.context.object
        settings = {"texels": 32, "views": 64, "lights": 64, "samples": 64, "bounces": 0, "sides": "ONE"}
        path = folder / f"{structure.capitalize()}.btf"
        assert bpy.ops.velour.capture_btf(directory=str(path), **settings) == {"FINISHED"}
        assert bpy.ops.velour.compress_btf(filepath=str(path)) == {"FINISHED"}
        material = bpy.data.materials[path.stem]
        scenes.add_plane(material, size=54.0)
    bpy.ops.velour.add_votf(material=material.name, structure=tile.name, texels=32)
    bpy.data.objects.remove(tile)
    scenes.velour_node(material).velour.placement.repeats = (12, 12)
    viewport.space().region_3d.view_distance = 6


def net_of_paint(folder):
    """Its holes show the world, its outline is the net's."""
    realtime.sky(folder)
    outlines.ball_in("NET", scenes.measured_material((_DATA / "paint.velour").read_bytes()))
    drawn, _, overlap = yield from outlines.compared(folder, "net")
    assert overlap > 0.97, overlap
    height, width = drawn.shape[:2]
    middle = drawn[height // 2 - 20 : height // 2 + 20, width // 2 - 20 : width // 2 + 20, 3]
    assert middle.min() < 0.5 < middle.max()


def net_of_its_btf(folder):
    """What its texels hold beyond outlines is folded back: else a tenth of the light is missing.

    A plane, for the far side of a ball is in its own shadow.
    """
    realtime.sky(folder)
    _plane_of_its_btf(folder, "NET")
    drawn, traced, _ = yield from outlines.compared(folder, "net-btf", samples=2048)
    share, error = _share(drawn, traced.mean), realtime.error(drawn, traced)
    _close_structure()
    yield 0.3
    yield from viewport.real_time_finished()
    closed = _share(realtime.pixels(), traced.mean)
    print(
        f"light {share:.4f} of the ray tracer's, {closed:.4f} not folded; relative L2: {error:.4f}",
        flush=True,
    )
    assert abs(share - 1) < 0.02, share
    assert closed < 0.95, closed
    assert error < 0.03, error


def _share(drawn, traced):
    """Drawn light as a share of the ray tracer's, where both show structure alone."""
    inside = (drawn[..., 3] > 0.999) & (traced[..., 3] > 0.999)
    return drawn[inside][:, :3].sum() / traced[inside][:, :3].sum()


def _close_structure():
    """Tells the shader that rays cannot go through: nothing is folded."""
    import gpu

    shown, textures = viewport.real_time(), viewport.addon("realtime.textures")
    (shell,) = (table for table in shown._drawing.tables.values() if type(table).__name__ == "ShellTables")
    terms = np.array(shell._terms.read().to_list(), np.float32).reshape(1, 2, 4)
    terms[0, 1, 1] = 0
    shell._terms = textures.texture(gpu, terms)
    shown._drawing.restart()
    viewport.addon("engine.viewport_clock").watch(shown)
    shown._engine().tag_redraw()


def outline_comes_and_goes(folder):
    """A ball that is shown already gets an outline."""
    scenes.set_world()
    material = scenes.measured_material((_DATA / "paint.velour").read_bytes())
    ball = outlines.ball_in("NET", material)
    plain = scenes.measured_material((_DATA / "paint.velour").read_bytes(), "Plain")
    ball.material_slots[0].material = plain
    viewport.show_real_time()
    yield from viewport.real_time_finished()
    assert not any(group.in_shell for group in viewport.real_time()._live.scene.groups)
    ball.material_slots[0].material = material
    yield from viewport.real_time_finished()
    assert any(group.in_shell for group in viewport.real_time()._live.scene.groups)
