"""Approximations in Blenders and color spaces other than those that they were made in."""

from unittest import mock

import bpy

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
