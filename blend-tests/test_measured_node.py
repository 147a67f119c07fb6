"""The node of a measured material: its inputs, materials that share its group, and where it is in a tree."""

import warnings
from pathlib import Path
from unittest import mock

import bpy
import numpy as np

from support import inputs, scenes
from support.blender import BlenderTest


class NodeTest(BlenderTest):
    def _stage(self, material, samples=8):
        scenes.use_engine(samples=samples, size=16)
        scenes.set_world((0.5, 0.7, 1.0))
        scenes.add_camera(ortho_scale=1.5)
        return scenes.add_plane(material)

    def _plastic(self):
        material = scenes.measured_material(inputs.model_bytes(inputs.plastic_measurement()))
        self._stage(material)
        return material

    def _tiles(self):
        material = scenes.measured_material(inputs.quarters_model(), "Quarters")
        self._stage(material)
        return material

    def _picture(self, name):
        return scenes.render(self.folder, name)[..., :3]

    def _is_same(self, material, change, asked, name):
        """A change of nodes and another setting make the same picture, which is not the one before."""
        plain = self._picture(f"{name}-plain")
        undo = change()
        changed = self._picture(f"{name}-changed")
        undo()
        np.testing.assert_array_equal(self._picture(f"{name}-undone"), plain)
        asked()
        np.testing.assert_allclose(changed, self._picture(f"{name}-asked"), rtol=1e-5, atol=1e-6)
        self.assertGreater(np.abs(changed - plain).max(), 0.01)

    def _notes(self, material):
        notes = inputs.module("export.notes").Notes()
        inputs.module("export.shaders").surface_layers(material, notes)
        return " ".join(notes)


class Inputs(NodeTest):
    def test_they_are_those_of_the_model(self):
        look = ["Tint", "Exposure", "Roughness Offset", "Normal"]
        of_btfs = ["Tint", "Exposure", "Normal"]  # Velour renders them as measured
        for data, names in (
            (inputs.model_bytes(inputs.lambert_measurement()), look),
            (inputs.brushed_model(), [*look, "Rotation"]),
            (inputs.quarters_model(), [*of_btfs, "Rotation", "Scale", "Vector"]),
        ):
            group = scenes.velour_node(scenes.measured_material(data)).group
            self.assertEqual([socket.name for socket in group.inputs if not socket.hide], names)

    def test_constants_may_be_linked(self):
        material = self._plastic()
        tree, group = material.node_tree, scenes.velour_node(material).group
        color, value = tree.nodes.new("ShaderNodeRGB"), tree.nodes.new("ShaderNodeValue")
        color.outputs[0].default_value, value.outputs[0].default_value = (0.9, 0.5, 0.2, 1), 0.5

        def link():
            for source, name in ((color, "Tint"), (value, "Exposure"), (value, "Roughness Offset")):
                tree.links.new(source.outputs[0], group.inputs[name])
            return lambda: [tree.links.remove(link) for link in list(tree.links) if link.to_node == group]

        def ask():
            scenes.set_look(material, tint=(0.9, 0.5, 0.2), exposure=0.5, roughness=0.5)

        self._is_same(material, link, ask, "constants")

    def test_scale_is_a_factor_on_the_size_of_tiles(self):
        material = self._tiles()
        placement = scenes.velour_node(material).velour.placement

        def scale():
            scenes.set_look(material, scale=0.5)
            return lambda: scenes.set_look(material, scale=1.0)

        self._is_same(material, scale, lambda: setattr(placement, "repeats", (2, 2)), "scale")

    def test_vector_is_a_mapping_of_another_uv_map(self):
        material = self._tiles()
        tree, node = material.node_tree, scenes.velour_node(material)
        mesh = bpy.context.object.data
        other = mesh.uv_layers.new(name="Other")
        for loop in other.data:
            loop.uv = 0.5 - loop.uv[1], loop.uv[0]
        mesh.uv_layers.active_index = 0
        mesh.uv_layers[0].active_render = True
        before = node.group.inputs["Vector"].links[0].from_node
        mapping, uvs = tree.nodes.new("ShaderNodeMapping"), tree.nodes.new("ShaderNodeUVMap")
        mapping.inputs["Scale"].default_value, uvs.uv_map = (2, 3, 1), "Other"
        tree.links.new(uvs.outputs[0], mapping.inputs["Vector"])

        def link():
            tree.links.new(mapping.outputs[0], node.group.inputs["Vector"])
            return lambda: tree.links.new(before.outputs["UV"], node.group.inputs["Vector"])

        def ask():
            before.uv_map, node.velour.placement.repeats = "Other", (2, 3)

        self._is_same(material, link, ask, "vector")

    def test_unsupported_links_are_told(self):
        material = self._tiles()
        tree, group = material.node_tree, scenes.velour_node(material).group
        noise = tree.nodes.new("ShaderNodeTexNoise")
        tree.links.new(noise.outputs[0], group.inputs["Vector"])
        notes = self._notes(material)
        self.assertIn("the link to 'Vector' is not supported", notes)
        self.assertIn("the placement is used", notes)

    def test_what_is_linked_to_nothing_is_no_note(self):
        self.assertEqual(self._notes(self._tiles()), "")


class FormerNames(NodeTest):
    """Scripts set the look by the names that it had before it became inputs."""

    NAMES = {"tint": "Tint", "exposure": "Exposure", "roughness": "Roughness Offset", "rotation": "Rotation"}

    def setUp(self):
        super().setUp()
        self.material = scenes.measured_material(inputs.brushed_model())
        self.node = scenes.velour_node(self.material)

    def _set(self, settings, name, value):
        """Sets it, and asserts that the warning names the input."""
        with self.assertWarnsRegex(DeprecationWarning, rf"\.{name} is .*'{self.NAMES[name]}'") as caught:
            setattr(settings.placement if name == "rotation" else settings, name, value)
        self.assertEqual(Path(caught.filename).name, Path(__file__).name)

    def _values(self, node):
        return [self._value(node.inputs[name]) for name in self.NAMES.values()]

    @staticmethod
    def _value(socket):
        return tuple(socket.default_value) if socket.type == "RGBA" else socket.default_value

    def test_they_set_the_inputs(self):
        for name, value in (("tint", (0.5, 0.25, 2)), ("exposure", -1), ("roughness", 0.5), ("rotation", 2)):
            self._set(self.node.velour, name, value)
        self.assertEqual(self._values(self.node.group), [(0.5, 0.25, 2, 1), -1, 0.5, 2])

    def test_they_keep_their_ranges(self):
        for name, value, kept in (
            ("tint", (-1, 1, 1), (0, 1, 1, 1)),
            ("exposure", 99, 32),
            ("roughness", 7, 1),
        ):
            self._set(self.node.velour, name, value)
            self.assertEqual(self._value(self.node.group.inputs[self.NAMES[name]]), kept)

    def test_they_read_the_inputs(self):
        scenes.set_look(self.material, tint=(0.5, 0.25, 2), exposure=-1, roughness=0.5, rotation=2)
        settings = self.node.velour
        self.assertEqual(tuple(settings.tint), (0.5, 0.25, 2))
        found = settings.exposure, settings.roughness, settings.placement.rotation
        self.assertEqual(found, (-1, 0.5, 2))

    def test_a_node_sets_its_own_inputs_and_the_model_those_of_all(self):
        copy = self.material.copy()
        other = scenes.velour_node(copy)
        self._set(self.node.velour, "exposure", 1)
        self.assertEqual(other.group.inputs["Exposure"].default_value, 0)
        self._set(self.node.texture.velour, "exposure", 2)
        for node in (self.node, other):
            self.assertEqual(node.group.inputs["Exposure"].default_value, 2)

    def test_a_missing_input_is_told(self):
        material = scenes.measured_material(inputs.model_bytes(inputs.plastic_measurement()), "Isotropic")
        with self.assertWarnsRegex(DeprecationWarning, "has no effect: the node has no input 'Rotation'"):
            scenes.velour_node(material).velour.placement.rotation = 1

    def test_the_former_layout_says_nothing(self):
        settings = scenes.velour_node(scenes.former_material(inputs.brushed_model())).velour
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            settings.tint, settings.placement.rotation = (0.5, 0.25, 2), 2
        self.assertEqual((*settings.tint, settings.placement.rotation), (0.5, 0.25, 2, 2))


class Places(NodeTest):
    """Where the node is in the tree of a material."""

    def test_in_groups(self):
        material = self._plastic()
        scenes.set_look(material, tint=(0.9, 0.5, 0.2))
        picture = self._picture("plain")
        tree = material.node_tree
        _wrap(tree, scenes.velour_node(material).group)
        np.testing.assert_array_equal(self._picture("wrapped"), picture)
        self.assertEqual(scenes.velour_node(material).node.id_data.name, "Wrapped")

    def test_behind_a_mix_with_nothing(self):
        material = self._plastic()
        picture, tree, group = self._picture("plain"), material.node_tree, scenes.velour_node(material).group
        mix, glow = tree.nodes.new("ShaderNodeMixShader"), tree.nodes.new("ShaderNodeEmission")
        mix.inputs[0].default_value = 0.0
        tree.links.new(group.outputs[0], mix.inputs[1])
        tree.links.new(glow.outputs[0], mix.inputs[2])
        tree.links.new(mix.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
        np.testing.assert_array_equal(self._picture("mixed"), picture)

    def test_unlinked_it_is_not_rendered(self):
        material = self._plastic()
        tree, shader = material.node_tree, material.node_tree.nodes.new("ShaderNodeBsdfDiffuse")
        shader.inputs["Color"].default_value = (0.2, 0.4, 0.6, 1)
        tree.links.new(shader.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
        scenes.set_world()
        np.testing.assert_allclose(scenes.middle(self._picture("plain")), (0.2, 0.4, 0.6), rtol=0.05)

    def test_on_materials_that_geometry_nodes_set(self):
        material = self._plastic()
        picture, obj = self._picture("slot"), bpy.context.object
        obj.data.materials.clear()
        self.assertGreater(np.abs(self._picture("none") - picture).max(), 0.01)
        _set_by_geometry_nodes(obj, material)
        np.testing.assert_array_equal(self._picture("geometry-nodes"), picture)

    def test_a_group_of_an_asset_in_another_material(self):
        """A group that another file appends and adds to a material of its own."""
        material = self._plastic()
        picture, tree = self._picture("here"), scenes.velour_node(material).group.node_tree
        tree.asset_mark()
        path = str(self.folder / "library.blend")
        bpy.ops.wm.save_as_mainfile(filepath=path)
        for link in (False, True):
            with self.subTest(link=link):
                bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
                with bpy.data.libraries.load(path, link=link, assets_only=True) as (source, target):
                    self.assertEqual(list(source.node_groups), [tree_name := "Paint"])
                    target.node_groups = [tree_name]
                other = scenes.diffuse_material(name="Other")
                node = other.node_tree.nodes.new("ShaderNodeGroup")
                node.node_tree = target.node_groups[0]
                output = other.node_tree.nodes["Material Output"]
                other.node_tree.links.new(node.outputs[0], output.inputs["Surface"])
                self._stage(other)
                np.testing.assert_array_equal(self._picture(f"there-{link}"), picture)


class Mixed(NodeTest):
    def _layers(self, material):
        """The calls that make the layers of a material."""
        calls = mock.Mock()
        shader = calls.__enter__ = mock.MagicMock()
        shader.__enter__.return_value = calls
        notes, materials = inputs.module("export.notes").Notes(), inputs.module("export.materials")
        with inputs.native().Scene() as scene:
            table = materials.MaterialTable(scene, notes)
            with (
                mock.patch.object(materials.Shader, "new", return_value=shader),
                mock.patch.object(scene, "add_shader_material", return_value=0),
                mock.patch.object(scene, "hide_backs"),
            ):
                table.number(material)
        return [(name, args[0] if args else None) for name, args, _ in calls.method_calls], list(notes)

    def _mixed(self, share=0.5):
        material = self._plastic()
        tree, group = material.node_tree, scenes.velour_node(material).group
        mix, glow = tree.nodes.new("ShaderNodeMixShader"), tree.nodes.new("ShaderNodeEmission")
        mix.inputs[0].default_value = share
        tree.links.new(group.outputs[0], mix.inputs[1])
        tree.links.new(glow.outputs[0], mix.inputs[2])
        tree.links.new(mix.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
        return material

    def test_it_is_a_layer_beside_others(self):
        calls, notes = self._layers(self._mixed())
        names = [name for name, _kind in calls]
        self.assertEqual(
            names, ["add_measured_layer", "weigh_layer", "weigh_layer", "add_layer", "weigh_layer"]
        )
        self.assertEqual([kind for _name, kind in calls][1:], ["tint", "rest", "emission", "share"])
        self.assertEqual(notes, [])

    def test_a_textured_tint_is_a_weight(self):
        material = self._plastic()
        tree, group = material.node_tree, scenes.velour_node(material).group
        texture = tree.nodes.new("ShaderNodeTexImage")
        texture.image = bpy.data.images.new("Dirt", 4, 4)
        tree.links.new(texture.outputs[0], group.inputs["Tint"])
        calls, notes = self._layers(material)
        self.assertEqual(
            [name for name, _kind in calls], ["add_measured_layer", "weigh_layer", "weigh_layer"]
        )
        self.assertEqual(notes, [])

    def test_half_emission_makes_the_mean_of_both(self):
        glow = self._picture_of(self._mixed(1.0), "glow")
        model = self._picture_of(self._mixed(0.0), "model")
        mixed = self._picture_of(self._mixed(0.5), "mixed")
        np.testing.assert_allclose(mixed, (model + glow) / 2, rtol=1e-2)
        np.testing.assert_allclose(mixed.mean(), (model + glow).mean() / 2, rtol=1e-3)
        self.assertGreater(np.abs(model - glow).max(), 0.1)

    def _picture_of(self, material, name):
        bpy.context.scene.velour.samples = (
            4096  # the surface itself is a light, which takes samples from others
        )
        picture = self._picture(name)
        bpy.data.objects.remove(bpy.context.object)
        bpy.data.materials.remove(material)
        return picture

    def test_a_scene_model_is_told(self):
        material = self._mixed()
        node = scenes.velour_node(material)
        node.velour.scene_model, node.velour.use_scene_model = node.image, True
        _calls, notes = self._layers(material)
        self.assertTrue(any("scene models of mixed materials" in note for note in notes), notes)


class Shared(NodeTest):
    def setUp(self):
        super().setUp()
        self.first = scenes.measured_material(inputs.model_bytes(inputs.plastic_measurement()))
        self.second = self.first.copy()
        self.second.name = "Copy"
        measured = inputs.module("operators.measured")
        for material in (self.first, self.second):
            scenes.velour_node(material).velour.measurement = measured.file_image(
                str(inputs.lambert_measurement())
            )

    def _trees(self):
        return [scenes.velour_node(material).group.node_tree for material in (self.first, self.second)]

    def test_each_has_inputs_and_settings_of_its_own(self):
        self.assertEqual(*self._trees())
        scenes.set_look(self.second, tint=(0.5, 0.25, 1.0), exposure=1.0)
        scenes.velour_node(self.second).velour.tolerance = 0.3
        pictures = []
        for material in (self.first, self.second):
            self._stage(material)
            pictures.append(self._picture(material.name))
            bpy.data.objects.remove(bpy.context.object)
        np.testing.assert_allclose(pictures[1], pictures[0] * np.float32((1, 0.5, 2)), rtol=1e-5)
        self.assert_close(scenes.velour_node(self.first).velour.tolerance, 0.02, 1e-6)

    def test_a_fit_is_of_one_material(self):
        before = scenes.velour_node(self.first).image
        bpy.ops.velour.fit(material="Copy", tolerance=0.2, max_lobes=2)
        self.assertNotEqual(*self._trees())
        self.assertEqual(scenes.velour_node(self.first).image, before)
        self.assertNotEqual(scenes.velour_node(self.second).image, before)

    def test_or_of_all_if_asked(self):
        before = scenes.velour_node(self.first).image
        bpy.ops.velour.fit(material="Copy", tolerance=0.2, max_lobes=2, users="ALL")
        self.assertEqual(*self._trees())
        self.assertNotEqual(scenes.velour_node(self.first).image, before)

    def test_tiles_of_all_have_coordinates_and_show_holes(self):
        """In EEVEE and Cycles; a Vector without a link is one point of the tile."""
        measured, group = (inputs.module(f"operators.{name}") for name in ("measured", "approximation_group"))
        node, tiles = scenes.velour_node(self.second), {"texels": (4, 4)}
        image = measured.packed_model(inputs.quarters_model(), "Quarters")
        node = measured.set_model(self.second, node, image, print, users="ALL", info=tiles)
        holes = inputs.module("core.approximation").UNFITTED._replace(color_map=np.zeros((4, 4, 4), "f"))
        group.put(node, self.second, holes, tiles)
        for material in (self.first, self.second):
            vector = scenes.velour_node(material).group.inputs["Vector"]
            self.assertEqual(vector.links[0].from_node.bl_idname, "ShaderNodeUVMap", material.name)
            if hasattr(material, "shadow_method"):  # before 4.2
                self.assertEqual((material.blend_method, material.shadow_method), ("HASHED", "HASHED"))

    def test_a_single_user_keeps_its_group(self):
        bpy.data.materials.remove(self.second)
        tree = scenes.velour_node(self.first).group.node_tree
        tree.asset_mark()  # which counts as users of the group, but no material is one
        bpy.ops.velour.fit(material="Paint", tolerance=0.2, max_lobes=2)
        self.assertEqual(scenes.velour_node(self.first).group.node_tree, tree)

    def _local_with_linked_group(self):
        self.first.use_fake_user = True
        path = str(self.folder / "library.blend")
        bpy.ops.wm.save_as_mainfile(filepath=path)
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        with bpy.data.libraries.load(path, link=True) as (_source, target):
            target.materials = target.node_groups = ["Paint"]
        return bpy.data.materials["Paint"].make_local() or bpy.data.materials["Paint"]

    def test_linked_groups_are_refused(self):
        local = self._local_with_linked_group()
        node = scenes.velour_node(local)
        self.assertIsNotNone(node.group.node_tree.library)
        measured = inputs.module("operators.measured")
        node.velour.measurement = measured.file_image(str(inputs.lambert_measurement()))
        image = node.image
        for call in (bpy.ops.velour.fit, bpy.ops.velour.approximate):
            with self.assertRaisesRegex(RuntimeError, "its node group 'Paint' is linked from .*make"):
                call(material=local.name)
        self.assertEqual(scenes.velour_node(local).image, image)

    def test_overridden_groups_are_refused(self):
        """Blender resets their nodes when it loads the file."""
        local = self._local_with_linked_group()
        node = scenes.velour_node(local)
        node.group.node_tree = node.group.node_tree.override_create()
        image = node.image
        for call in (bpy.ops.velour.fit, bpy.ops.velour.approximate):
            with self.assertRaisesRegex(RuntimeError, "its node group 'Paint.*' overrides that of .*make"):
                call(material=local.name)
        self.assertEqual(scenes.velour_node(local).image, image)


def _wrap(tree, node):
    """Moves a node into a group of its own, which takes its place."""
    outer = scenes.new_group("Wrapped", "Shader")
    inner, sink = outer.nodes.new("ShaderNodeGroup"), outer.nodes.new("NodeGroupOutput")
    inner.node_tree = node.node_tree
    for socket in node.inputs:
        if socket.name in inner.inputs:
            inner.inputs[socket.name].default_value = socket.default_value
    outer.links.new(inner.outputs[0], sink.inputs[0])
    tree.nodes.remove(node)
    place = tree.nodes.new("ShaderNodeGroup")
    place.node_tree = outer
    tree.links.new(place.outputs[0], tree.nodes["Material Output"].inputs["Surface"])


def _set_by_geometry_nodes(obj, material):
    tree = bpy.data.node_groups.new("Set Material", "GeometryNodeTree")
    for in_out in ("INPUT", "OUTPUT"):
        if hasattr(tree, "interface"):  # 4.0 and newer
            tree.interface.new_socket(name="Geometry", in_out=in_out, socket_type="NodeSocketGeometry")
        else:
            sockets = tree.inputs if in_out == "INPUT" else tree.outputs
            sockets.new("NodeSocketGeometry", "Geometry")
    source, sink = tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")
    setting = tree.nodes.new("GeometryNodeSetMaterial")
    setting.inputs["Material"].default_value = material
    tree.links.new(source.outputs[0], setting.inputs["Geometry"])
    tree.links.new(setting.outputs[0], sink.inputs[0])
    obj.modifiers.new("Set Material", "NODES").node_group = tree
