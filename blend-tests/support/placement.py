"""Tests place a tile of four grays: its picture, what is measured of it and what is said."""

import bpy
import numpy as np

from . import inputs, scenes
from .blender import BlenderTest
from .notes import export_notes

SIZE = 64  # pixels of a picture two units wide


def export_module(name):
    return inputs.module(f"export.{name}")


def _expected(uv_map, uvs):
    """Albedo at texture coordinates [n x 2], and whether that is far from the borders of the quarters."""
    tiles = uvs @ uv_map[:, :2].T + uv_map[:, 2]
    part = tiles - np.floor(tiles)
    halves = (2 * part).astype(int)
    far = (np.abs(2 * part - halves - 0.5) < 0.3).all(axis=1)
    return np.array(inputs.QUARTERS)[halves[:, 1], halves[:, 0]], far


class Placed(BlenderTest):
    def setUp(self):
        super().setUp()
        self.scene = scenes.use_engine(samples=64, size=SIZE)
        scenes.set_world()
        scenes.add_camera(ortho_scale=2.0)

    def _material(self, metres=0.5, **settings):
        material = scenes.measured_material(inputs.quarters_model(metres), "Quarters")
        scenes.set_look(material, rotation=settings.pop("rotation", 0.0))
        for name, value in settings.items():
            setattr(scenes.velour_node(material).velour.placement, name, value)
        return material

    def _placement(self):
        return scenes.velour_node(bpy.data.materials["Quarters"]).velour.placement

    def _check_picture(self, uv_map, width=1.0, height=1.0):
        """The plane's picture, where the plane takes `width` and `height` of the picture."""
        pixels = scenes.render(self.folder)[..., 0]
        rows, columns = np.mgrid[0:SIZE, 0:SIZE]
        at = (np.stack([columns, rows], axis=-1).reshape(-1, 2) + 0.5) / SIZE
        uvs = (at - 0.5) / (width, height) + 0.5
        albedo, far = _expected(np.asarray(uv_map, float), uvs)
        far &= (np.abs(uvs - 0.5) < 0.48).all(axis=1)
        self.assertGreater(far.mean(), 0.05)
        error = np.abs(pixels.reshape(-1)[far] / albedo[far] - 1).max()
        self.assertLess(error, 0.06)

    def _report(self, obj=None, material=None):
        obj = obj or bpy.context.object
        material = material or obj.active_material
        node = scenes.velour_node(material)
        with inputs.native().Model.from_bytes(node.image.packed_file.data, "model") as model:
            look = export_module("measured_look").constant_look(node)
            tile = export_module("placement").Tile.of(material, node, look, model.info())
        depsgraph = bpy.context.evaluated_depsgraph_get()
        return export_module("placement_report").report_on(depsgraph, obj, material, tile)

    def _rows(self, **arguments):
        return dict(self._report(**arguments).rows)

    def _notes(self):
        return export_notes()
