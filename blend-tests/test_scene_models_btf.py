"""Fit for this scene of materials made from BTFs: fewer texels, and frames from closer."""

import shutil

import bpy
import numpy as np

from support import blender, inputs, scenes
from support.scene_models import SceneModelTest

_SMALL = {"texels": 16, "views": 24, "lights": 24, "samples": 4, "bounces": 0, "sides": "ONE"}
_SIZE = 32  # pixels


class SceneModelsOfBtfs(SceneModelTest):
    """A plane of 8 x 8 tiles of 16 texels over 32 pixels: four texels a pixel."""

    material = "ribs"

    def setUp(self):
        super().setUp()
        folder, captured = self.folder / "ribs.btf", blender.folder() / "ribs.btf"
        if not captured.is_dir():
            bpy.ops.velour.add_mesostructure(type="CORDUROY", count=2, resolution=8)
            bpy.ops.velour.capture_btf(directory=str(captured), **_SMALL)
            bpy.data.objects.remove(bpy.context.object)
        shutil.copytree(captured, folder)
        self.scene = scenes.use_engine(size=_SIZE)
        self.scene.frame_end = 1
        self.obj = scenes.add_plane(size=4)
        self._make_material(folder)
        self.settings.placement.repeats = (8, 8)
        scenes.set_world()
        self.camera = scenes.add_camera(ortho_scale=4)

    def _make_material(self, folder):
        """As *Make Material from BTF* does, by the method that takes no time."""
        native = inputs.native()
        measured = inputs.module("operators.measured")
        path = measured.btf_file(str(folder))
        with native.Btf.load(path) as btf, native.compress_job(btf, method="svd", bytes=100000) as job:
            digest = btf.info()["sha256"]
            job.run()
            with job.result_model() as model:
                data = model.bytes()
        material = measured.new_material("ribs")
        node = measured.ensure_node(material)
        node.image = measured.packed_model(data, "ribs")
        node.velour.measurement = measured.measurement_image(path, digest)
        bpy.context.object.active_material = material

    def test_fewer_texels_beside_the_full_model(self):
        full = self.node.image
        self.assertEqual(bpy.ops.velour.fit_for_scene(), {"FINISHED"})
        self.assertEqual(self.node.image, full)
        self.assertTrue(self.settings.use_scene_model)
        info = self.info(self.settings.scene_model)
        self.assertEqual((info["texels"], info["scene"]["full_texels"]), ([8, 8], [16, 16]))
        self.assertEqual(info["scene"]["full_parameter_bytes"], self.info(full)["parameter_bytes"])
        self.assertLess(1.3 * info["parameter_bytes"], self.info(full)["parameter_bytes"])

    def test_the_picture_stays(self):
        bpy.ops.velour.fit_for_scene()
        pixels, said = self.render()
        self.assertIn("rendered with the scene model", said)
        full = self.full_picture()
        self.assertGreater(np.abs(pixels - full).max(), 0, "the full model was rendered")
        np.testing.assert_allclose(pixels.mean(), full.mean(), rtol=0.02)

    def test_a_closer_camera_takes_the_full_model(self):
        bpy.ops.velour.fit_for_scene()
        self.camera.data.ortho_scale = 1
        pixels, said = self.render()
        self.assertRegex(
            said, r"Material 'ribs', frame 1: 100.*more than 0\.1%: rendered with the full model"
        )
        np.testing.assert_array_equal(pixels, self.full_picture())

    def test_a_missing_full_model_is_said(self):
        bpy.ops.velour.fit_for_scene()
        self.camera.data.ortho_scale = 1
        self.node.image = None
        self.assertIn("the full model is missing", self.render()[1])

    def test_a_scene_that_needs_all_texels_keeps_nothing(self):
        self.camera.data.ortho_scale = 0.25
        self.assertEqual(bpy.ops.velour.fit_for_scene(), {"CANCELLED"})
        self.assertIsNone(self.settings.scene_model)

    def test_undo(self):
        bpy.context.preferences.edit.use_global_undo = True
        bpy.ops.ed.undo_push(message="before")
        bpy.ops.velour.fit_for_scene()
        bpy.ops.ed.undo_push(message="fit")
        bpy.ops.ed.undo()
        self.assertFalse(self.settings.use_scene_model)
        self.assertIsNone(self.settings.scene_model)

    def test_shared_with_another_scene(self):
        bpy.data.scenes.new("Other").collection.objects.link(self.obj)
        with self.assertRaisesRegex(RuntimeError, "'Other'"):
            bpy.ops.velour.fit_for_scene(material="ribs")
        self.assertEqual(bpy.ops.velour.fit_for_scene(material="ribs", shared=True), {"FINISHED"})

    def test_a_btf_that_is_gone(self):
        (self.folder / "ribs.btf" / "btf.json").rename(self.folder / "away.json")
        with self.assertRaisesRegex(RuntimeError, "btf.json.* is missing"):
            bpy.ops.velour.fit_for_scene()
