"""Numbers of samples: camera rays in the panels, light directions in what is stored, and the presets."""

import warnings
from unittest import mock

import bpy

from support import inputs
from support.blender import BlenderTest


class SamplingSettings(BlenderTest):
    @property
    def settings(self):
        return bpy.context.scene.velour

    def test_defaults(self):
        settings = self.settings
        self.assertEqual((settings.camera_samples, settings.light_samples), (32, 8))
        self.assertEqual((settings.viewport_camera_samples, settings.preview_camera_samples), (128, 4))

    def test_camera_rays_are_stored_as_light_directions(self):
        self.settings.camera_samples = 100
        self.assertEqual(self.settings.samples, 800)
        self.settings.viewport_camera_samples = 0
        self.assertEqual(self.settings.viewport_samples, 0)

    def test_light_directions_keep_the_camera_rays_and_split_does_not(self):
        settings = self.settings
        settings.camera_samples = 100
        settings.light_samples = 2
        self.assertEqual((settings.camera_samples, settings.samples, settings.split), (100, 200, 2))
        settings.split = 4
        self.assertEqual((settings.camera_samples, settings.samples), (50, 200))

    def test_scripts_that_set_light_directions_are_told_and_keep_their_meaning(self):
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            self.settings.camera_samples = 64
        with self.assertWarnsRegex(DeprecationWarning, "camera_samples"):
            self.settings.samples = 512
        self.assertEqual(self.settings.camera_samples, 64)

    def test_the_largest_number_is_kept(self):
        self.settings.camera_samples = 1 << 20
        self.assertEqual(self.settings.samples, 1 << 20)

    def test_presets(self):
        settings = self.settings
        settings.clamp_indirect = 10.0
        found = {}
        for preset in ("PREVIEW", "FINAL", "REFERENCE"):
            self._choose(preset)
            found[preset] = settings.camera_samples, settings.noise_target, settings.use_denoising
        self.assertLess(found["PREVIEW"][0], found["FINAL"][0])
        self.assertLess(found["FINAL"][0], found["REFERENCE"][0])
        self.assertGreater(found["PREVIEW"][1], found["FINAL"][1])
        self.assertEqual([found[preset][2] for preset in found], [True, True, False])
        self.assertEqual(settings.clamp_indirect, 0.0)

    def test_a_preset_leaves_denoising_off_where_there_is_no_denoiser(self):
        self._choose("FINAL", "There is none.")
        self.assertFalse(self.settings.use_denoising)
        self._choose("FINAL")
        self.assertTrue(self.settings.use_denoising)

    def _choose(self, preset, no_denoiser=""):
        with mock.patch.object(inputs.module("export.denoiser"), "missing", return_value=no_denoiser):
            bpy.ops.velour.sampling_preset(preset=preset)

    def test_progress_counts_what_the_panels_count(self):
        settings = bpy.context.scene.velour
        settings.camera_samples, settings.light_samples = 32, 8
        text = inputs.module("engine.options").samples_text
        self.assertEqual(text(settings.samples, settings.samples, settings.split), "Sample 32/32")
        self.assertEqual(text(100, settings.samples, settings.split), "Sample 13/32")
        settings.viewport_camera_samples = 0  # no limit
        depsgraph = bpy.context.evaluated_depsgraph_get()
        options = inputs.module("engine.options").viewport_options(depsgraph, self._view())
        self.assertEqual(text(100, options["spp"], options["split"]), "Sample 13")

    def _view(self):
        return mock.Mock(width=8, height=8)
