"""Materials made from BTFs, by every method."""

import bpy

from support import inputs, scenes
from support.blender import BlenderTest


class CompressMethods(BlenderTest):
    def setUp(self):
        super().setUp()
        bpy.ops.velour.add_mesostructure(type="CORDUROY", count=2, resolution=8)
        bpy.ops.velour.capture_btf(
            directory=str(self.folder / "ribs.btf"),
            texels=8, views=12, lights=12, samples=4, bounces=0, sides="ONE",
        )  # fmt: skip

    def _info_of(self, tile):
        image = scenes.velour_node(tile.velour.material).image
        with inputs.native().Model.from_bytes(image.packed_file.data, image.name) as model:
            return model.info()

    def test_each_method_makes_its_own_model(self):
        tile = bpy.context.object
        for method, kind in (("SVD", "factored-btf"), ("SVD_VIEW", "factored-btf"), ("SRBF", "srbf-btf")):
            with self.subTest(method=method):
                bpy.ops.velour.compress_btf(method=method, megabytes=0.03)
                self.assertEqual(tile.velour.method, method)  # the tile keeps what was given
                info = self._info_of(tile)
                self.assertEqual((info["model"], info["method"]), (kind, method.lower().replace("_", "-")))
        bpy.ops.velour.compress_btf()
        self.assertEqual(self._info_of(tile)["model"], "srbf-btf")

    def test_clustered_tensors_have_the_clusters_that_were_asked_for(self):
        tile = bpy.context.object
        tile.velour.members = 2
        panel = inputs.module("ui.model_panel")
        for method, members in (("TUCKER", 1), ("CTA", 1), ("KCTA", 2)):
            with self.subTest(method=method):
                bpy.ops.velour.compress_btf(method=method, clusters=3, megabytes=0.03)
                info = self._info_of(tile)
                self.assertEqual((info["model"], info["method"]), ("tensor-btf", method.lower()))
                (side,) = info["sides"]
                self.assertEqual(side["clusters"], 1 if method == "TUCKER" else 3)
                self.assertEqual(side["members"], members)
                self.assertEqual(sum(side["bytes"].values()), side["parameter_bytes"])
                rows = dict(panel._btf_rows(info))
                self.assertIn(f"{members} per texel", rows["Clusters"])
