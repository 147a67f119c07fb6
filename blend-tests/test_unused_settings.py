"""Settings that change a picture of Cycles and none of Velour's are named, where the artist has set them."""

import unittest

import bpy

from support import inputs, scenes
from support.notes import NotesTest


class Settings(NotesTest):
    """A scene that is as it begins, with a lamp."""

    def setUp(self):
        super().setUp()
        self.scene, self.layer = bpy.context.scene, bpy.context.view_layer
        if not hasattr(self.scene, "cycles"):
            self.skipTest("Cycles is not enabled")
        self.lamp = bpy.data.lights.new("Key", "POINT")
        self.scene.collection.objects.link(bpy.data.objects.new("Key", self.lamp))

    def notes(self):
        for block in (self.scene, self.lamp, self.scene.world):
            block.update_tag()  # which a property of an add-on does not do by itself
        return super().notes()

    def _said(self, owner, words, block, **values):
        """Each of the values alone makes one sentence."""
        for name, value in values.items():
            before = getattr(block, name)
            self.assertEqual(self.notes(), [])
            setattr(block, name, value)
            (note,) = self.notes()
            self.assertTrue(note.startswith(owner) and words in note, (name, note))
            setattr(block, name, before)

    def test_scene(self):
        for words, values in (
            ("Open Shading Language", {"shading_system": True}),
            ("Reflective Caustics of Cycles: ignored; use Copy from Cycles", {"caustics_reflective": False}),
            ("Filter Glossy of Cycles: ignored; use Copy from Cycles", {"blur_glossy": 0.5}),
            ("Clamp Direct of Cycles: ignored; use Copy from Cycles", {"sample_clamp_direct": 3.0}),
            ("Clamp Indirect of Cycles: ignored; use Copy from Cycles", {"sample_clamp_indirect": 2.0}),
            ("Fast GI Approximation", {"use_fast_gi": True}),
            ("Pixel Filter", {"filter_width": 3.0, "pixel_filter_type": "GAUSSIAN"}),
        ):
            self._said("Scene 'Scene'", words, self.scene.cycles, **values)

    def test_what_velour_does_anyway(self):
        cycles = self.scene.cycles
        cycles.blur_glossy = cycles.sample_clamp_indirect = 0.0  # as Velour's own
        cycles.pixel_filter_type, cycles.filter_width = "BOX", 3.0  # a box is one pixel wide
        self.assertEqual(self.notes(), [])

    def test_copied_settings(self):
        cycles = self.scene.cycles
        cycles.sample_clamp_direct, cycles.blur_glossy, cycles.caustics_reflective = 3.0, 0.5, False
        (note,) = self.notes()
        self.assertIn(
            "Clamp Direct, Filter Glossy and Reflective Caustics of Cycles: ignored; use Copy from Cycles",
            note,
        )
        bpy.ops.velour.copy_cycles_settings()
        self.assertEqual(self.notes(), [])

    def test_several_settings_make_one_sentence(self):
        cycles = self.scene.cycles
        cycles.shading_system = cycles.use_fast_gi = True
        (note,) = self.notes()
        self.assertIn("Open Shading Language and Fast GI Approximation of Cycles: not supported", note)

    def test_simplify(self):
        cycles = self.scene.cycles
        cycles.use_camera_cull, cycles.texture_limit_render = True, "512"
        self.assertEqual(self.notes(), [])
        self.scene.render.use_simplify = True
        self.assert_said("Scene 'Scene'", "Culling and Texture Limit")

    def test_rolling_shutter(self):
        self.scene.render.use_motion_blur = True
        self._said("Scene 'Scene'", "Rolling Shutter", self.scene.cycles, rolling_shutter_type="TOP")

    def test_resolution_of_textures(self):
        if not hasattr(self.scene.cycles, "texture_resolution_render"):
            self.skipTest("no such setting before Blender 5.2")
        self.scene.render.use_simplify = True
        self._said("Scene 'Scene'", "Texture Limit", self.scene.cycles, texture_resolution_render=0.5)

    def test_lights_and_worlds(self):
        world = self.scene.world
        for owner, settings in (("Light 'Key'", self.lamp.cycles), ("World 'World'", world.cycles)):
            self._said(owner, "shadow caustics", settings, is_caustics_light=True)
            self._said(owner, "its own Max Bounces", settings, max_bounces=2)

    def test_view_layer_without_surfaces(self):
        self._said("View layer 'ViewLayer'", "surfaces", self.layer, use_solid=False)

    def _missing(self):
        passes = inputs.module("export.layer_passes")
        export = inputs.module("export")
        notes = export.Notes()
        self.scene.update_tag()
        passes.note_missing_passes(bpy.context.evaluated_depsgraph_get().view_layer_eval, notes)
        return list(notes)

    def test_light_groups(self):
        self.assertEqual(self._missing(), [])
        for name in ("Key", "Rim"):
            self.layer.lightgroups.add(name=name)
        (note,) = self._missing()
        self.assertIn("light groups are not supported; the passes of 'Key' and 'Rim' are left out", note)

    def test_alpha_threshold(self):
        self.layer.pass_alpha_threshold = 0.1
        (note,) = self._missing()
        self.assertIn("Alpha Threshold", note)

    def test_passes_of_cycles(self):
        self.layer.cycles.use_pass_volume_direct = True
        (note,) = self._missing()
        self.assertIn("the pass Volume Direct is not supported", note)
        self.layer.cycles.use_pass_volume_direct = False
        self.layer.cycles.denoising_store_passes = True
        (note,) = self._missing()
        self.assertIn("Denoising is enabled for Cycles only", note)
        self.layer.velour.use_pass_denoising = True
        self.assertEqual(self._missing(), [])

    @unittest.skipUnless("use_pass_grease_pencil" in bpy.types.ViewLayer.bl_rna.properties, "5.0 and newer")
    def test_the_pass_that_blender_makes(self):
        self.layer.use_pass_grease_pencil = True
        self.assertEqual(self._missing(), [])

    def test_silent_where_cycles_has_been_at_work(self):
        """A scene of Cycles as it begins has nothing that is said, whatever its samples and bounces."""
        self.scene.render.engine = "CYCLES"
        self.scene.cycles.samples = 16
        self.scene.cycles.max_bounces = 2
        scenes.use_engine(samples=4, size=8)
        self.assertEqual(self.notes() + self._missing(), [])


if __name__ == "__main__":
    unittest.main()
