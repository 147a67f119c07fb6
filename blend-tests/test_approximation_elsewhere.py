"""Approximations in Blenders and color spaces other than those that they were made in."""

from unittest import mock

import bpy
import numpy as np

from support import inputs, scenes
from support.blender import BlenderTest
from support.drawn import drawn


class Elsewhere(BlenderTest):
    def setUp(self):
        super().setUp()
        self.obj = scenes.add_sphere(
            scenes.measured_material(inputs.model_bytes(inputs.glossy_measurement()))
        )
        self.group = inputs.module("operators.approximation_group")
        self.panel = inputs.module("ui.approximation_panel")

    def _texts(self):
        with mock.patch.object(self.panel, "model_summary", return_value={"file_sha256": ""}):
            return drawn(self.panel.VELOUR_MATERIAL_PT_approximation, material=self.material).texts

    @property
    def material(self):
        return self.obj.active_material

    @property
    def tree(self):
        return scenes.velour_node(self.material).group.node_tree

    def _approximate(self):
        bpy.ops.velour.approximate(material=self.material.name)


class Versions(Elsewhere):
    """Blender 3.5 has changed the lobes of Glossy BSDFs."""

    def test_the_panel_says_if_nodes_were_fitted_for_other_lobes(self):
        wrong = "The nodes were fitted for other versions of Blender. Press Refresh."
        self._approximate()
        self.assertNotIn(wrong, self._texts())
        (other,) = {"separable", "correlated"} - {self.group.MASKING}
        with mock.patch.object(self.group, "MASKING", other):
            self.assertIn(wrong, self._texts())
            self._approximate()
            self.assertNotIn(wrong, self._texts())
        self.assertIn(wrong, self._texts())


_REC2020 = np.array(((0.6274, 0.3293, 0.0433), (0.0691, 0.9195, 0.0114), (0.0164, 0.0880, 0.8956)))


class WorkingSpaces(Elsewhere):
    """Blender 5.0 can change the working space of a file; it converts neither curves nor vectors."""

    def _in_rec2020(self):
        color = inputs.module("export.color")
        return mock.patch.object(color, "_to_scene_linear", lambda rgb: tuple(_REC2020 @ np.array(rgb)))

    def _shown(self):
        values = inputs.module("operators.approximation_look").shown(self.material)
        return np.array([values.principled["base_color"], values.diffuse, values.color])

    def test_the_panel_says_if_nodes_are_in_another(self):
        wrong = "The nodes are in another working color space. Press Refresh."
        self._approximate()
        self.assertNotIn(wrong, self._texts())
        with self._in_rec2020():
            self.assertIn(wrong, self._texts())
            self._approximate()
            self.assertNotIn(wrong, self._texts())
        self.assertIn(wrong, self._texts())

    def test_exporters_and_solid_mode_have_colors_in_the_present_one(self):
        self._approximate()
        before = self._shown()
        self.assertGreater(np.ptp(before[0]), 0.1)
        with self._in_rec2020():
            converted = before @ _REC2020.T
            np.testing.assert_allclose(self._shown(), converted, atol=1e-5)
            self._approximate()
            np.testing.assert_allclose(self._shown(), converted, atol=1e-5)
        np.testing.assert_allclose(self._shown(), before, atol=1e-5)
