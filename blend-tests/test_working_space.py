"""Colors between linear Rec. 709 and a working space that is another one."""

from unittest import mock

import numpy as np
from velour.export import color
from velour.export.plugs import Plug
from velour.export.shaders.values import own_value

from support import scenes
from support.blender import BlenderTest

_REC2020 = np.array(((0.6274, 0.3293, 0.0433), (0.0691, 0.9195, 0.0114), (0.0164, 0.0880, 0.8956)))


class WorkingSpace(BlenderTest):
    def setUp(self):
        super().setUp()
        patch = mock.patch.object(color, "_to_scene_linear", lambda rgb: tuple(_REC2020 @ np.array(rgb)))
        patch.start()
        self.addCleanup(patch.stop)

    def test_matrix(self):
        np.testing.assert_allclose(color.rec709_to_working(), _REC2020, atol=1e-7)

    def test_there_and_back(self):
        orange = (0.9, 0.4, 0.1)
        pixels = color.rec709_pixels_to_working(np.array([[*orange, 0.5]], np.float32))[0]
        np.testing.assert_allclose(pixels, [*(_REC2020 @ orange), 0.5], atol=1e-6)
        np.testing.assert_allclose(color.working_to_rec709(pixels), orange, atol=1e-6)

    def test_luminance(self):
        white = color.luminance_weights() @ (_REC2020 @ np.ones(3))
        self.assert_close(white, 1, 1e-6)

    def test_a_color_at_a_number(self):
        """A link from a color to a number gives its luminance, the same in every working space."""
        orange = np.array((0.9, 0.4, 0.1))
        tree = scenes.diffuse_material().node_tree
        rgb, value = tree.nodes.new("ShaderNodeRGB"), tree.nodes.new("ShaderNodeMath")
        rgb.outputs[0].default_value = (*(_REC2020 @ orange), 1.0)
        tree.links.new(rgb.outputs[0], value.inputs[0])
        number = own_value(Plug(value.inputs[0]))
        self.assert_close(number, np.dot((0.2126, 0.7152, 0.0722), orange), 1e-4)
