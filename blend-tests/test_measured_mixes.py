"""Measured nodes among other shaders: varied inputs and mixes against closed forms, and datablocks' lives."""

import bpy
import numpy as np

from support import inputs, scenes
from support.blender import BlenderTest

ALBEDO = (0.8, 0.5, 0.2)
TINT = (0.25, 0.5, 1.0)


class MixTest(BlenderTest):
    """A plane of constant f that fills the picture, under a world of one color: pictures are closed forms."""

    def setUp(self):
        super().setUp()
        scenes.use_engine(samples=8, size=16)
        scenes.set_world()
        scenes.add_camera(ortho_scale=1.5)
        self.material = scenes.measured_material(inputs.model_bytes(inputs.lambert_measurement(ALBEDO)))
        self.node = scenes.velour_node(self.material).group
        self.tree = self.material.node_tree
        self.plane = scenes.add_plane(self.material)

    def picture(self, name="picture"):
        return scenes.render(self.folder, name)[..., :3]

    def assert_color(self, color, rtol=0.02):
        np.testing.assert_allclose(self.picture().mean(axis=(0, 1)), color, rtol=rtol)

    def add(self, idname, **values):
        """A node with these values of its inputs."""
        node = self.tree.nodes.new(f"ShaderNode{idname}")
        for name, value in values.items():
            socket = node.inputs[name]
            socket.default_value = (*value, 1.0) if isinstance(value, tuple) else value
        return node

    def show(self, shader):
        self.tree.links.new(shader.outputs[0], self.tree.nodes["Material Output"].inputs["Surface"])

    def mix(self, idname, first, second, factor=None):
        node = self.add(idname)
        sockets = [socket for socket in node.inputs if socket.type == "SHADER"]
        for shader, socket in zip((first, second), sockets, strict=True):
            self.tree.links.new(shader.outputs[0], socket)
        if factor is not None:
            node.inputs[0].default_value = factor
        return node


class VariedInputs(MixTest):
    """Each way to feed Tint makes the same picture as the constant."""

    def _link(self, node, output=0):
        self.tree.links.new(node.outputs[output], self.node.inputs["Tint"])
        self.assert_color(np.multiply(ALBEDO, TINT))

    def test_a_constant(self):
        scenes.set_look(self.material, tint=TINT)
        self.assert_color(np.multiply(ALBEDO, TINT))
        scenes.set_look(self.material, exposure=-1)
        self.assert_color(np.multiply(ALBEDO, TINT) / 2)

    def test_an_image(self):
        image = bpy.data.images.new("Tint", 2, 2, float_buffer=True)
        image.pixels.foreach_set(np.tile(np.float32((*TINT, 1)), 4))
        texture = self.add("TexImage")
        texture.image = image
        self._link(texture)

    def test_an_attribute(self):
        colors = self.plane.data.color_attributes.new("Dirt", "FLOAT_COLOR", "CORNER")
        for each in colors.data:
            each.color = (*TINT, 1)
        attribute = self.add("Attribute")
        attribute.attribute_name = "Dirt"
        self._link(attribute, "Color")

    def test_calculated_nodes(self):
        scale = self.add("VectorMath")
        scale.operation = "SCALE"
        scale.inputs[0].default_value = np.multiply(TINT, 2)
        scale.inputs["Scale"].default_value = 0.5
        self._link(scale)

    def _assert_stops(self):
        """Half of the surface reflects all, the other half a fourth."""
        picture = self.picture()
        dark = picture[..., 0] < ALBEDO[0] / 2
        self.assertTrue(0.3 < dark.mean() < 0.7)
        np.testing.assert_allclose(np.median(picture[~dark], axis=0), ALBEDO, rtol=0.05)
        np.testing.assert_allclose(np.median(picture[dark], axis=0), np.divide(ALBEDO, 4), rtol=0.05)

    def test_exposure_over_the_surface(self):
        """From an image, an attribute and a calculation: 0 or -2 stops."""
        image = bpy.data.images.new("Stops", 2, 1, float_buffer=True)
        image.pixels.foreach_set(np.float32([0, 0, 0, 1, -2, -2, -2, 1]))
        texture = self.add("TexImage")
        texture.image, texture.interpolation = image, "Closest"
        corners = self.plane.data.attributes.new("Stops", "FLOAT", "CORNER")
        left = [self.plane.data.vertices[loop.vertex_index].co.x < 0 for loop in self.plane.data.loops]
        for corner, is_left in zip(corners.data, left, strict=True):
            corner.value = 0.0 if is_left else -2.0
        attribute, step = self.add("Attribute"), self.add("Math")
        attribute.attribute_name, step.operation = "Stops", "LESS_THAN"
        self.tree.links.new(attribute.outputs["Fac"], step.inputs[0])
        step.inputs[1].default_value = -1.0
        stops = self.add("Math")
        stops.operation = "MULTIPLY"
        self.tree.links.new(step.outputs[0], stops.inputs[0])
        stops.inputs[1].default_value = -2.0
        for node in (texture, stops):
            with self.subTest(node.bl_idname):
                self.tree.links.new(node.outputs[0], self.node.inputs["Exposure"])
                self._assert_stops()
        self.tree.links.new(attribute.outputs["Fac"], self.node.inputs["Exposure"])
        picture = self.picture().mean(axis=0)  # 2^stops between the corners
        slope = np.log2(picture[-1, 0] / picture[0, 0]) / (len(picture) - 1)
        self.assertAlmostEqual(slope * len(picture) / 0.75, -2, delta=0.1)

    def test_a_mask_over_the_surface(self):
        """A checker of black and white: half of the surface has no reflection."""
        checker = self.add("TexChecker", Scale=8.0, Color1=(1.0, 1.0, 1.0), Color2=(0.0, 0.0, 0.0))
        self.tree.links.new(self.add("TexCoord").outputs["UV"], checker.inputs["Vector"])
        self.tree.links.new(checker.outputs["Color"], self.node.inputs["Tint"])
        picture = self.picture()
        dark = picture[..., 0] < 0.05
        self.assertTrue(0.3 < dark.mean() < 0.7)
        np.testing.assert_allclose(np.median(picture[~dark], axis=0), ALBEDO, rtol=0.05)


class Relief(MixTest):
    """A measured Lambert surface bends light as a Diffuse BSDF does."""

    def _as_diffuse(self, relief):
        """Pictures under a sun from the side, of the measured node and of a Diffuse BSDF with that relief."""
        scenes.set_world(strength=0.0)
        sun = bpy.data.lights.new("Sun", "SUN")
        sun.energy = np.pi
        lamp = bpy.data.objects.new("Sun", sun)
        lamp.rotation_euler = 0, 0.7, 0
        bpy.context.scene.collection.objects.link(lamp)
        flat = self.picture("flat")
        self.tree.links.new(relief.outputs["Normal"], self.node.inputs["Normal"])
        measured = self.picture("measured")
        diffuse = self.add("BsdfDiffuse", Color=ALBEDO)
        self.tree.links.new(relief.outputs["Normal"], diffuse.inputs["Normal"])
        self.show(diffuse)
        np.testing.assert_allclose(measured, self.picture("diffuse"), rtol=0.03, atol=0.01)
        self.assertGreater(np.abs(measured - flat).max(), 0.05)

    def test_a_normal_map(self):
        relief = self.add("NormalMap", Color=(0.7, 0.5, 0.9))
        self._as_diffuse(relief)

    def test_bump(self):
        gradient, coordinates, relief = self.add("TexGradient"), self.add("TexCoord"), self.add("Bump")
        relief.inputs["Distance"].default_value = 1.0
        self.tree.links.new(coordinates.outputs["UV"], gradient.inputs["Vector"])
        self.tree.links.new(gradient.outputs["Fac"], relief.inputs["Height"])
        self._as_diffuse(relief)


class Mixes(MixTest):
    def test_nested_mixes_and_sums(self):
        """Half of (a fourth of the model plus emission), half diffuse."""
        quarter = self.mix("MixShader", self.add("BsdfDiffuse", Color=(0.0, 0.0, 0.0)), self.node, 0.25)
        both = self.mix("AddShader", quarter, self.add("Emission", Color=(0.1, 0.2, 0.3), Strength=2.0))
        self.show(self.mix("MixShader", both, self.add("BsdfDiffuse", Color=(0.4, 0.4, 0.4)), 0.5))
        inner = np.divide(ALBEDO, 4) + np.multiply((0.1, 0.2, 0.3), 2)
        self.assert_color((inner + 0.4) / 2)

    def test_two_measured_nodes(self):
        other = scenes.measured_material(
            inputs.model_bytes(inputs.lambert_measurement((0.2, 0.2, 0.6))), "Other"
        )
        second = self.add("Group")
        second.node_tree = scenes.velour_node(other).group.node_tree
        self.show(self.mix("MixShader", self.node, second, 0.25))
        self.assert_color(0.75 * np.array(ALBEDO) + 0.25 * np.array((0.2, 0.2, 0.6)))

    def test_what_is_left_out_is_said(self):
        toon = self.add("BsdfToon")
        self.show(self.mix("MixShader", self.node, toon, 0.5))
        notes = inputs.module("export.notes").Notes()
        shaders = inputs.module("export.shaders")
        shaders.surface_layers(self.material, notes)
        self.assertTrue(any("'Paint'" in note and "Toon" in note for note in notes), list(notes))

    def test_two_silhouettes_are_refused(self):
        bpy.ops.velour.add_mesostructure(type="NET", count=2, resolution=8)
        tile = bpy.context.object
        tile.hide_render = True
        bpy.ops.velour.add_votf(material="Paint", structure=tile.name, texels=16)
        node, second = scenes.velour_node(self.material).group, self.add("Group")
        second.node_tree = node.node_tree
        self.show(self.mix("MixShader", node, second, 0.5))
        with self.assertRaisesRegex(RuntimeError, "'Paint': it mixes two measured nodes with a silhouette"):
            self.picture()


class Lives(MixTest):
    """Datablocks that Blender copies, links and overrides render as the first did."""

    def setUp(self):
        super().setUp()
        scenes.set_look(self.material, tint=TINT)
        self.before = self.picture("before")

    def _is_same(self, material):
        self.plane.data.materials[0] = material
        np.testing.assert_array_equal(self.picture("after"), self.before)

    def test_copies(self):
        self._is_same(self.material.copy())

    def test_a_group_made_single_user(self):
        before = self.node.node_tree
        self.node.node_tree = before.copy()
        self._is_same(self.material)
        copy = scenes.velour_node(self.material)
        self.assertNotEqual(copy.group.node_tree, before)
        self.assertEqual(copy.image.name, "Paint.velour")

    def _reopened(self, link):
        """The material in another file."""
        path = str(self.folder / "library.blend")
        bpy.ops.wm.save_as_mainfile(filepath=path)
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        with bpy.data.libraries.load(path, link=link) as (_source, target):
            target.materials = ["Paint"]
        scenes.use_engine(samples=8, size=16)
        scenes.set_world()
        scenes.add_camera(ortho_scale=1.5)
        self.plane = scenes.add_plane()
        self.plane.data.materials.append(None)
        return bpy.data.materials["Paint"]

    def test_appended(self):
        self._is_same(self._reopened(link=False))

    def test_linked_and_overridden(self):
        linked = self._reopened(link=True)
        self._is_same(linked)
        override = linked.override_create()
        scenes.velour_node(override).velour.tolerance = 0.125
        path = str(self.folder / "override.blend")
        self._is_same(override)
        override.override_library.operations_update()
        bpy.ops.wm.save_as_mainfile(filepath=path)
        bpy.ops.wm.open_mainfile(filepath=path)
        (override,) = (m for m in bpy.data.materials if m.override_library)
        self.assertEqual(scenes.velour_node(override).velour.tolerance, 0.125)
        np.testing.assert_array_equal(self.picture("reloaded"), self.before)
