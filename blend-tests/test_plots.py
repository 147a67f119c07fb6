"""Plots without a window: saved, and as image datablocks."""

import csv
import os

import bpy
import numpy as np

from support import inputs, scenes
from support.blender import BlenderTest

_WEAVE = os.path.join(os.path.dirname(__file__), "scenes/data/weave.velour")


class Plots(BlenderTest):
    def setUp(self):
        super().setUp()
        obj = scenes.add_plane()
        scenes.use_engine()
        obj.active_material = scenes.measured_material(inputs.model_bytes(inputs.glossy_measurement()))
        self.node = scenes.velour_node(obj.active_material)

    def _measure(self, path):
        image = bpy.data.images.new("glossy.binary", 1, 1)
        image.source, image.filepath_raw = "FILE", str(path)
        self.node.velour.measurement = image

    def _saved(self, name, **options):
        path = self.folder / name
        self.assertEqual(bpy.ops.velour.save_plot(filepath=str(path), **options), {"FINISHED"})
        return path

    def _rows(self, name, **options):
        return list(csv.DictReader(self._saved(name, **options).read_text().splitlines()))

    def test_each_plot_in_each_form(self):
        for kind in ("LOBES", "ORDER", "VIEW_ERROR", "ALBEDO"):
            self.assertIn("<svg", self._saved(f"{kind}.svg", kind=kind).read_text())
            rows = self._rows(f"{kind}.csv", kind=kind)
            if kind == "ORDER":  # a row a number of lobes tried: processors differ in that
                self.assertEqual(sum(int(row["chosen"]) for row in rows), 1)
            self.assertGreater(len(rows), 2)
            self.assertEqual(
                scenes.read(self._saved(f"{kind}.png", kind=kind, side=200)).shape[:2], (200, 200)
            )

    def test_the_measurement_of_the_material_is_in_it(self):
        def names(file):
            return {row["series"] for row in self._rows(file, kind="LOBES", view=np.radians(50))}

        self.assertNotIn("measured", names("without.csv"))
        self._measure(inputs.glossy_measurement())
        self.assertIn("measured", names("with.csv"))

    def test_a_measurement_that_is_gone_leaves_the_model(self):
        self._measure(self.folder / "gone.binary")
        rows = self._rows("gone.csv", kind="LOBES")
        self.assertEqual({row["series"] for row in rows} & {"model", "measured"}, {"model"})

    def test_enlarge_makes_an_image_that_is_kept(self):
        for _ in range(2):
            self.assertEqual(bpy.ops.velour.enlarge_plot(kind="ALBEDO", side=256), {"FINISHED"})
        image = bpy.data.images["Paint albedo"]
        self.assertNotIn("Paint albedo.001", bpy.data.images)
        self.assertEqual(tuple(image.size), (256, 256))
        self.assertIsNotNone(image.packed_file)
        pixels = np.empty(256 * 256 * 4, np.float32)
        image.pixels.foreach_get(pixels)
        back = bpy.context.preferences.themes[0].properties.space.back
        self.assert_close(pixels[0], back[0], 0.01)
        self.assertGreater(pixels.reshape(-1, 4)[:, :3].std(), 0.02)

    def test_what_cannot_be_plotted_says_why(self):
        with open(_WEAVE, "rb") as file:
            self.node.image = scenes.velour_node(scenes.measured_material(file.read(), "Weave")).image
        with self.assertRaisesRegex(RuntimeError, "BTF models have no plot 'lobes'"):
            bpy.ops.velour.save_plot(filepath=str(self.folder / "btf.png"), kind="LOBES")
        self.assertFalse((self.folder / "btf.png").exists())
        self._saved("btf.svg", kind="ORDER")
        self.node.image = None
        with self.assertRaisesRegex(RuntimeError, "no model to plot"):
            bpy.ops.velour.enlarge_plot(kind="LOBES")
