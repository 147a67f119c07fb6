"""Colors in the working spaces that Blender 5 offers."""

import bpy
import numpy as np

from parity import stage
from parity.case import record
from parity.shaders import ShaderTest
from support import inputs, scenes
from support.judge import judge_renders

_SPACES = ("Linear Rec.709", "Linear Rec.2020", "ACEScg")


class WorkingSpaces(ShaderTest):
    """A picture of bytes on the roof, a warm lamp, colors by numbers: each comes there its own way."""

    def setUp(self):
        super().setUp()
        if not hasattr(bpy.data, "colorspace"):
            self.skipTest("the working space is a choice since Blender 5.0")

    def _work_in(self, space):
        bpy.ops.wm.set_working_color_space(working_space=space, convert_colors=False)
        self.assertEqual(bpy.data.colorspace.working_space, space)

    def _paint(self):
        picture = bpy.data.images.new("bytes", 8, 8)
        pixels = np.random.default_rng(4).uniform(0.1, 0.9, (8, 8, 4)).astype(np.float32)
        pixels[..., 3] = 1
        picture.pixels.foreach_set(pixels.ravel())
        picture.pack()
        self.tree.end(self.tree.diffuse(self.tree.picture(picture)))

    def test_scene(self):
        self._paint()
        lamp = stage.lamp("POINT", 300, (-1, -2, 3), shadow_soft_size=0.0, color=(1, 0.7, 0.9)).data
        lamp.use_temperature, lamp.temperature = True, 3200
        stage.world((0.9, 0.3, 0.2), 0.3)
        shown = {}
        for space in _SPACES:
            with self.subTest(space):
                self._work_in(space)
                shown[space] = self.pictures("VELOUR")
                verdict = judge_renders(shown[space], self.pictures("CYCLES"))
                record(f"Working space: {space}", verdict, "honored")
                self.assertTrue(verdict.agrees, verdict)
        for space in _SPACES[1:]:  # the control
            self.assertFalse(judge_renders(shown[space], shown[_SPACES[0]]).agrees)

    def test_measured_material(self):
        """Its colors are Rec. 709's: in each space the picture under white light is that, converted."""
        roof = bpy.data.objects["Roof"]
        for obj in [obj for obj in self.scene.objects if obj != roof and obj.type != "CAMERA"]:
            bpy.data.objects.remove(obj)
        stage.world((1, 1, 1))
        model = inputs.model_bytes(inputs.glossy_measurement())
        roof.data.materials[0] = scenes.measured_material(model)
        first = None
        for space in _SPACES:
            self._work_in(space)
            shown = self.pictures("VELOUR")[..., :3].mean(axis=0)
            first = shown if first is None else first
            np.testing.assert_allclose(shown, first @ _from_rec709().T, atol=2e-3, rtol=2e-3)
            if space != _SPACES[0]:
                self.assertGreater(np.abs(shown - first).max(), 0.01)


def _from_rec709():
    """Matrix from linear Rec. 709 colors to the working space."""
    from mathutils import Color

    columns = [Color(primary).from_rec709_linear_to_scene_linear() for primary in np.eye(3).tolist()]
    return np.array([tuple(column) for column in columns]).T
