"""The node group of a measured material: an artist's own nodes and inputs, and materials that share it."""

import bpy
import numpy as np

from support import inputs, scenes
from support.blender import BlenderTest

_TILES = {"texels": (4, 4)}


def _group(material):
    return scenes.velour_node(material).group


def _put_tile(material):
    """Puts an approximation with all images into the group of a material."""
    colors = np.random.default_rng(1).random((4, 4, 4), np.float32)
    colors[..., 3] = 1
    found = inputs.module("core.approximation").UNFITTED._replace(
        color_map=colors,
        normal_map=np.ones((4, 4, 3), np.float32),
        height_map=np.eye(4, dtype=np.float32),
    )
    inputs.module("operators.approximation_group").put(scenes.velour_node(material), material, found, _TILES)


def _built(tree, idname):
    """The only node of a type in the frame."""
    (node,) = inputs.module("operators.approximation_image").built_nodes(tree, idname)
    return node


def _images(material):
    return inputs.module("operators.approximation_image").images_of(_group(material).node_tree)


def _add_first_output(tree, name):
    if hasattr(tree, "interface"):  # 4.0 and newer
        socket = tree.interface.new_socket(name=name, in_out="OUTPUT", socket_type="NodeSocketColor")
        tree.interface.move(socket, 0)
    else:
        tree.outputs.new("NodeSocketColor", name)
        tree.outputs.move(len(tree.outputs) - 1, 0)


def _add_input(tree, name):
    if hasattr(tree, "interface"):  # 4.0 and newer
        tree.interface.new_socket(name=name, in_out="INPUT", socket_type="NodeSocketFloat")
    else:
        tree.inputs.new("NodeSocketFloat", name)


class OwnParts(BlenderTest):
    """What an artist has added to the group."""

    def setUp(self):
        super().setUp()
        self.material = scenes.measured_material(inputs.weave_model())
        _put_tile(self.material)
        self.tree = _group(self.material).node_tree

    def _add_picture(self, name):
        node = self.tree.nodes.new("ShaderNodeTexImage")
        node.image = bpy.data.images.new(name, 2, 2, is_data=name == "Scratches")
        return node

    def test_inputs_stay(self):
        _add_input(self.tree, "Dirt")
        _group(self.material).inputs["Dirt"].default_value = 0.25
        source = next(node for node in self.tree.nodes if node.bl_idname == "NodeGroupInput")
        own = self.tree.nodes.new("ShaderNodeMath")
        self.tree.links.new(source.outputs["Dirt"], own.inputs[0])
        module, node = inputs.module("operators.approximation_group"), scenes.velour_node(self.material)
        module.put_inputs(node, self.material, {"isotropic": True})
        self.assertNotIn("Rotation", node.group.inputs)
        module.put_inputs(node, self.material, _TILES)
        self.assertIn("Rotation", node.group.inputs)
        self.assertEqual(node.group.inputs["Dirt"].default_value, 0.25)
        self.assertEqual(own.inputs[0].links[0].from_socket.name, "Dirt")

    def test_outputs_may_come_first(self):
        _add_first_output(self.tree, "Mask")
        _put_tile(self.material)
        sink = next(node for node in self.tree.nodes if node.bl_idname == "NodeGroupOutput")
        self.assertFalse(sink.inputs["Mask"].is_linked)
        self.assertTrue(sink.inputs["BSDF"].is_linked)

    def test_images_are_not_those_of_the_tile(self):
        images = _images(self.material)
        for name in ("Dirt", "Scratches"):
            self._add_picture(name)
        self.assertEqual(_images(self.material), images)
        scenes.add_plane(self.material)
        bpy.ops.velour.displace()
        self.assertEqual(_images(self.material), images)

    def test_images_are_not_those_of_a_brdf(self):
        unfitted = inputs.module("core.approximation").UNFITTED
        node = scenes.velour_node(self.material)
        inputs.module("operators.approximation_group").put(node, self.material, unfitted)
        self._add_picture("Dirt")
        self.assertIsNone(_images(self.material).colors)

    def test_a_shader_is_not_that_of_the_tile(self):
        own = self.tree.nodes.new("ShaderNodeBsdfPrincipled")
        self.tree.links.new(self._add_picture("Dirt").outputs["Alpha"], own.inputs["Alpha"])
        self.assertFalse(inputs.module("operators.approximation_image").shows_behind(self.tree))

    def test_normal_maps_keep_their_uv_map(self):
        own = self.tree.nodes.new("ShaderNodeNormalMap")
        own.uv_map = "Mine"
        scenes.velour_node(self.material).velour.placement.uv_map = "Other"
        self.assertEqual(own.uv_map, "Mine")


class Shared(BlenderTest):
    """Materials of one group, whose placements differ."""

    def _follow(self, *materials):
        for material in materials:
            inputs.module("operators.approximation_look").follow(material)

    def test_nodes_in_the_group_follow_the_first_alone(self):
        """If each changed them in turn, the scene would be updated without end."""
        first = scenes.measured_material(inputs.weave_model())
        _put_tile(first)
        second = first.copy()
        for material, name, density in ((first, "First", 1.0), (second, "Second", 4.0)):
            placement = scenes.velour_node(material).velour.placement
            placement.mode, placement.uv_density = "REAL_SIZE", (density,) * 2
            _group(material).inputs["Vector"].links[0].from_node.uv_map = name
        look, tree = inputs.module("operators.approximation_look"), _group(first).node_tree
        maths = (node for node in tree.nodes if node.label == look.HEIGHT)
        (height,), relief = maths, _built(tree, "ShaderNodeNormalMap")
        for order in ((first, second), (second, first)):
            self._follow(*order)
            self.assertEqual(relief.uv_map, "First")
            self.assert_close(height.inputs[1].default_value, look.fitted(tree)["height"], 1e-6)
        repeats = [_group(material).inputs["Repeats"].default_value[0] for material in (first, second)]
        self.assertNotEqual(*repeats)

    def test_two_nodes_of_one_material_do_not_change_it_in_turn(self):
        material = scenes.measured_material(inputs.weave_model())
        _put_tile(material)
        node = _group(material)
        other = material.node_tree.nodes.new("ShaderNodeGroup")
        other.node_tree = node.node_tree
        other.velour.placement.uv_map = "Other"
        node.inputs["Vector"].links[0].from_node.uv_map = "First"
        self._follow(material)
        self.assertEqual(_built(node.node_tree, "ShaderNodeNormalMap").uv_map, "First")


class InCycles(BlenderTest):
    def setUp(self):
        super().setUp()
        scenes.set_world()
        scenes.add_camera(ortho_scale=1.5)

    def _picture(self, name):
        scene = scenes.use_engine(size=16)
        scene.render.engine = "CYCLES"
        scene.cycles.samples, scene.cycles.max_bounces, scene.cycles.use_denoising = 16, 0, False
        return scenes.render(self.folder, name)[..., :3]

    def test_tiles_without_a_vector_have_the_uv_map(self):
        """As in a material that the group was added to."""
        material = scenes.measured_material(inputs.weave_model())
        _put_tile(material)
        scenes.add_plane(material)
        scenes.set_look(material, rotation=0.5, scale=0.8)
        scenes.velour_node(material).velour.placement.offset = 0.1, 0.2
        linked, tree = self._picture("linked"), material.node_tree
        self.assertGreater(np.ptp(linked), 0.1)
        tree.links.remove(_group(material).inputs["Vector"].links[0])
        np.testing.assert_allclose(self._picture("unlinked"), linked, atol=1e-3)

    def test_another_material_does_not_show_hidden_inputs(self):
        material = scenes.measured_material(inputs.weave_model())
        _put_tile(material)
        other = scenes.diffuse_material(name="Other")
        node = other.node_tree.nodes.new("ShaderNodeGroup")
        node.node_tree = _group(material).node_tree
        scenes.add_plane(other)
        bpy.context.view_layer.update()
        self.assertTrue(node.inputs["Repeats"].hide and node.inputs["Offset"].hide)
        self.assertFalse(node.inputs["Scale"].hide)

    def test_meshes_without_the_uv_map_show_anisotropy(self):
        material = scenes.measured_material(inputs.brushed_model())
        bpy.ops.velour.approximate(material=material.name)
        scenes.add_plane(material)
        shown = self._picture("map").mean()
        scenes.velour_node(material).velour.placement.uv_map = "Missing"
        self.assert_close(self._picture("no map").mean(), shown, 0.1 * shown)
