"""Denoised renders: the picture, its passes and stamps, and what is said where nothing can denoise."""

import re
from unittest import mock

import bpy
import numpy as np

from support import inputs, scenes
from support.blender import BlenderTest

denoising = inputs.module("engine.denoising")


class Denoising(BlenderTest):
    def setUp(self):
        super().setUp()
        if reason := inputs.module("export.denoiser").missing():
            self.skipTest(reason)
        self.scene = scenes.use_engine(samples=16)
        self.scene.velour.split = 1
        scenes.add_camera(ortho_scale=4)
        scenes.set_world()
        scenes.add_sphere(scenes.diffuse_material())
        scenes.add_plane(scenes.diffuse_material((0.8, 0.4, 0.2)), size=8).location.z = -1

    def _error(self, picture, truth):
        return float(np.square(picture[..., :3] - truth[..., :3]).mean())

    def test_picture_and_passes(self):
        settings = self.scene.velour
        settings.samples = 4096
        truth = scenes.render(self.folder, "truth")
        settings.samples = 16
        before = scenes.render(self.folder, "before")
        settings.use_denoising = True
        bpy.context.view_layer.update_render_passes()
        denoised = scenes.render(self.folder, "denoised")
        self.assertLess(self._error(denoised, truth), 0.4 * self._error(before, truth))
        np.testing.assert_array_equal(denoised[..., 3], before[..., 3])
        stamp = (self.folder / "denoised.exr").read_bytes()
        self.assertIn(b"velour.denoised", stamp)
        self.assertIn("at most", denoising.last_errors[self.scene.name])
        settings.use_denoising = False
        np.testing.assert_array_equal(scenes.render(self.folder, "after"), before)
        settings.use_denoising = True
        bpy.context.view_layer.update_render_passes()
        scenes.composite(self.scene)("Noisy Image")
        noisy = scenes.render(self.folder, "noisy")
        self.assertGreater(self._error(noisy, truth), 2 * self._error(denoised, truth))

    def test_noise_threshold_is_that_of_the_denoised_picture(self):
        settings = self.scene.velour
        settings.samples, settings.use_noise_target, settings.noise_target = 4096, True, 0.05
        settings.use_denoising = bpy.context.view_layer.velour.use_pass_sample_count = True
        bpy.context.view_layer.update_render_passes()
        scenes.composite(self.scene)("Sample Count")
        counts = scenes.render(self.folder, "counts")[..., 0]
        self.assertEqual(counts.min(), counts.max())
        self.assertLess(counts.max(), 4096)
        percent = float(re.search(r"at most ([0-9.]+) %", denoising.last_errors[self.scene.name])[1])
        self.assertLessEqual(percent, 5.0)

    def test_several_layers(self):
        """Each has its own."""
        self.scene.velour.use_denoising = True
        self.scene.view_layers.new("Second")
        bpy.context.view_layer.update_render_passes()
        scenes.render(self.folder)


class Missing(BlenderTest):
    def test_render_is_refused_and_the_viewport_is_not(self):
        scene = scenes.use_engine(samples=4)
        scenes.add_camera()
        scenes.set_world()
        scene.velour.use_denoising = True
        settings = inputs.module("export.unused_settings")
        missing = mock.patch.object(settings, "missing", return_value="it is not there.")
        with missing, self.assertRaisesRegex(RuntimeError, "cannot be denoised: it is not there"):
            bpy.ops.render.render()
        scene.velour.use_denoising = False
        bpy.ops.render.render()


class LastErrors(BlenderTest):
    def test_those_of_another_file_are_forgotten(self):
        denoising.last_errors[bpy.context.scene.name] = "Error of the last image: at most 1 %."
        bpy.ops.wm.read_homefile()
        self.assertEqual(denoising.last_errors, {})
