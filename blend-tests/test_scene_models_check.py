"""Check Scene and the panel say where a model for the scene does not serve, and what helps."""

import math

import bpy
import numpy as np

from support import inputs, scenes
from support.drawn import drawn
from support.scene_models import SceneModelTest


class Checked(SceneModelTest):
    """A glossy plane under a constant world, whose model for the scene is of one view."""

    def setUp(self):
        super().setUp()
        self.scene = scenes.use_engine(samples=1, size=32)
        self.scene.frame_end = 1
        self.camera = scenes.add_camera()
        self.camera.data.angle = math.radians(16)
        self._tilt(0.7)
        scenes.set_world((0.5, 0.6, 0.7))
        scenes.add_plane()
        bpy.ops.velour.load_material(filepath=str(inputs.glossy_measurement()), fit=False)
        bpy.context.object.active_material.name = "Paint"
        measured = inputs.module("operators.measured")
        data = inputs.full_model_bytes(inputs.glossy_measurement())
        self.node.image = measured.packed_model(data, "Paint")
        bpy.ops.velour.fit_for_scene(material="Paint")

    def _tilt(self, angle):
        self.camera.location = (0, -5 * math.sin(angle), 5 * math.cos(angle))
        self.camera.rotation_euler = (angle, 0, 0)

    def _found(self):
        self.assertEqual(bpy.ops.velour.check_scene(), {"FINISHED"})
        return [each.text for each in bpy.context.window_manager.velour.checked.sentences]

    def _panel(self):
        return drawn(bpy.types.VELOUR_MATERIAL_PT_scene_model, material=bpy.data.materials["Paint"])

    def _sentences(self):
        return [text for text in self._panel().texts if text.startswith("Material 'Paint'")]

    def test_it_serves(self):
        self.assertEqual(self._sentences(), [], "nothing was looked at")
        self.assertIn("velour.check_scene", self._panel().operators)
        self.assertEqual(self._found(), [])
        (said,) = self._sentences()
        self.assertRegex(said, r"frame 1: 0\.\d\d% .*rendered with the scene model\.$")

    def test_it_does_not_serve(self):
        """What the check says without a picture is what the render says."""
        self._tilt(0.05)
        (found,) = self._found()
        self.assertRegex(found, r"Material 'Paint', frame 1: .*more than 0\.1%: rendered with the full")
        self.assertIn("press Fit for This Scene again", found)
        self.assertEqual(self._sentences(), [found])
        self.assertIn(found, self.render()[1])

    def test_the_remedy_helps(self):
        self._tilt(0.05)
        self._found()
        bpy.ops.velour.fit_for_scene(material="Paint")
        self.assertEqual(self._sentences(), [], "another model, which was not looked at")
        self.assertEqual(self._found(), [])

    def test_without_a_full_model(self):
        self._tilt(0.05)
        self.node.image = None
        (found,) = self._found()
        self.assertIn("the full model is missing", found)
        self.assertIn("Restore the full model, or fit the material again.", found)

    def test_switched_off(self):
        """Negative control."""
        self._tilt(0.05)
        self.settings.use_scene_model = False
        self.assertEqual(self._found(), [])
        self.assertEqual(self._sentences(), [])

    def test_a_border_hides_nothing(self):
        """A render's choice is that of the whole frame."""
        self._tilt(0.05)
        whole = self._found()
        render = self.scene.render
        render.use_border, render.border_max_x, render.border_max_y = True, 0.1, 0.1
        self.assertEqual(self._found(), whole)

    def test_no_picture_is_made(self):
        picture = self.render()[0]
        self._tilt(0.05)
        self._found()
        bpy.data.images["Render Result"].save_render(str(self.folder / "after.exr"))
        np.testing.assert_array_equal(scenes.read(self.folder / "after.exr"), picture)
