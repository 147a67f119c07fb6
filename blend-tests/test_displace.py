"""The relief of a BTF as displacement in Cycles."""

import bpy
import numpy as np

from support import inputs, scenes
from support.blender import BlenderTest
from support.drawn import drawn


class _Weave(BlenderTest):
    def setUp(self):
        super().setUp()
        self.material = scenes.measured_material(inputs.weave_model(), "Weave")
        scenes.add_plane(self.material)
        self._fit(np.eye(4, dtype=np.float32))

    def _fit(self, height):
        found = inputs.module("core.approximation").UNFITTED._replace(
            color_map=np.ones((4, 4, 4), np.float32),
            normal_map=np.ones((4, 4, 3), np.float32),
            height_map=height,
        )
        node = scenes.velour_node(self.material)
        inputs.module("operators.approximation_group").put(node, self.material, found, {"texels": (4, 4)})


class Displace(_Weave):
    def _look(self, material):
        """Whether a material has the normal map, and whether it is displaced."""
        tree = scenes.velour_node(material).group.node_tree
        (relief,) = (node for node in tree.nodes if node.bl_idname == "ShaderNodeNormalMap")
        output = next(n for n in material.node_tree.nodes if n.bl_idname == "ShaderNodeOutputMaterial")
        displaced = output.inputs["Displacement"].is_linked
        self.assertEqual(tree.velour.displaces, displaced)  # what the panel shows
        return relief.outputs[0].is_linked, displaced

    def test_materials_that_share_the_group_keep_their_look(self):
        copy = self.material.copy()
        bpy.ops.velour.displace()
        self.assertEqual(self._look(self.material), (False, True))
        self.assertEqual(self._look(copy), (True, False))
        displaced = self.material.copy()
        bpy.ops.velour.displace(enable=False)
        self.assertEqual(self._look(self.material), (True, False))
        self.assertEqual(self._look(displaced), (False, True))

    def test_a_fit_without_a_relief_shows_the_normal_map_until_the_next_with_one(self):
        bpy.ops.velour.displace()
        self._fit(None)
        self.assertEqual(self._look(self.material), (True, True))
        self._fit(np.eye(4, dtype=np.float32))
        self.assertEqual(self._look(self.material), (False, True))

    def test_it_can_be_disabled_after_a_fit_without_a_relief(self):
        bpy.ops.velour.displace()
        self._fit(None)
        panel = inputs.module("ui.approximation_panel").VELOUR_MATERIAL_PT_approximation
        self.assertIn("velour.displace", drawn(panel, material=self.material).operators)
        bpy.ops.velour.displace(enable=False)
        self.assertEqual(self._look(self.material), (True, False))
        self.assertNotIn("velour.displace", drawn(panel, material=self.material).operators)
        for enable in (True, False):
            with self.assertRaisesRegex(RuntimeError, "has no relief"):
                bpy.ops.velour.displace(enable=enable)

    def test_without_an_output_nothing_changes(self):
        tree = self.material.node_tree
        tree.nodes.remove(tree.nodes["Material Output"])
        with self.assertRaisesRegex(RuntimeError, "'Weave' has no Material Output node"):
            bpy.ops.velour.displace()
        self.assertFalse(scenes.velour_node(self.material).group.node_tree.velour.displaces)

    def test_a_node_inside_another_group_is_refused(self):
        outer = scenes.new_group("Outer", "BSDF")
        inner = outer.nodes.new("ShaderNodeGroup")
        inner.node_tree = scenes.velour_node(self.material).group.node_tree
        tree = self.material.node_tree
        tree.nodes.remove(scenes.velour_node(self.material).group)
        tree.nodes.new("ShaderNodeGroup").node_tree = outer
        with self.assertRaisesRegex(RuntimeError, "is inside a node group"):
            bpy.ops.velour.displace()
        self.assertFalse(inner.node_tree.velour.displaces)


class Size(_Weave):
    """The relief is as high as its tile is wide."""

    def _values(self, unit, density):
        """Height of one repeat and the middle, in a scene with this Unit Scale."""
        bpy.context.scene.unit_settings.scale_length = unit
        node = scenes.velour_node(self.material)
        node.velour.placement.uv_density = density
        inputs.module("operators.approximation_look").follow(self.material)
        nodes = node.group.node_tree.nodes
        height = next(each for each in nodes if each.label == "Height of Relief").inputs[1]
        relief = next(each for each in nodes if each.bl_idname == "ShaderNodeDisplacement")
        return height.default_value, relief.inputs["Midlevel"].default_value

    def test_its_height_is_in_proportion_to_a_tile_under_any_unit_scale(self):
        """On a mesh that is 2 units wide, with u from 0 to 1: one repeat is 2 units wide."""
        for unit in (1.0, 0.001, 1000.0):
            height, _middle = self._values(unit, (0.5 / unit,) * 2)
            self.assert_close(height, 2, 1e-4)

    def test_without_a_density_a_unit_of_coordinates_is_one_of_blender(self):
        for unit in (1.0, 0.001):
            height, _middle = self._values(unit, (0, 0))
            self.assert_close(height, 1, 1e-4)

    def test_the_mean_of_the_surface_stays(self):
        _height, middle = self._values(1.0, (0, 0))
        self.assert_close(middle, 0.25, 1e-6)
