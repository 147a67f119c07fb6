"""Files of the former layout, whose model is in a muted node of the material: they render as they did.

They are converted only if asked to be.
"""

import unittest

import bpy
import numpy as np

from support import inputs, older_file, scenes
from support.blender import BlenderTest


class FormerLayout(BlenderTest):
    def _stage(self, material):
        scenes.use_engine(samples=8, size=16)
        scenes.set_world((0.5, 0.7, 1.0))
        scenes.add_camera(ortho_scale=1.5)
        scenes.add_plane(material)

    def _former(self, data=None):
        material = scenes.former_material(data or inputs.model_bytes(inputs.plastic_measurement()))
        self._stage(material)
        return material

    def _is_unchanged(self, material, name=""):
        """Converts; the picture stays, bit by bit."""
        before = scenes.render(self.folder, "before")
        self.assertEqual(bpy.ops.velour.convert_materials(material=name), {"FINISHED"})
        node = scenes.velour_node(material)
        self.assertIsNotNone(node.group)
        np.testing.assert_array_equal(scenes.render(self.folder, "after"), before)
        return before

    def test_it_renders_whatever_is_linked(self):
        material = self._former()
        tree = material.node_tree
        picture = scenes.render(self.folder, "former")
        shader = tree.nodes.new("ShaderNodeEmission")
        tree.links.new(shader.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
        np.testing.assert_array_equal(scenes.render(self.folder, "linked"), picture)
        same = scenes.measured_material(bytes(scenes.velour_node(material).image.packed_file.data))
        bpy.context.object.material_slots[0].material = same
        np.testing.assert_array_equal(scenes.render(self.folder, "group"), picture)

    def test_a_look_is_converted(self):
        material = self._former()
        settings = scenes.velour_node(material).velour
        plain = scenes.render(self.folder, "plain")
        settings.tint, settings.exposure, settings.roughness = (0.9, 0.5, 0.3), 0.5, 0.4
        settings.tolerance, settings.btf.method = 0.07, "CTA"
        before = self._is_unchanged(material, material.name)
        self.assertGreater(np.abs(before - plain).max(), 0.05)
        node = scenes.velour_node(material)
        look = [tuple(node.group.inputs["Tint"].default_value)[:3]]
        look += [node.group.inputs[name].default_value for name in ("Exposure", "Roughness Offset")]
        np.testing.assert_allclose(look[0], (0.9, 0.5, 0.3), rtol=1e-6)
        np.testing.assert_allclose(look[1:], (0.5, 0.4), rtol=1e-6)
        self.assert_close(node.velour.tolerance, 0.07, 1e-6)
        self.assertEqual(node.velour.btf.method, "CTA")
        self.assertEqual([tree.name for tree in bpy.data.node_groups], [material.name])

    def test_the_approximation_goes_with_it(self):
        material = self._former()
        bpy.ops.velour.convert_materials()
        tree = scenes.velour_node(material).group.node_tree
        self.assertEqual(tree.velour.fitted, scenes.FORMER_FIT)
        shader = next(node for node in tree.nodes if node.bl_idname == "ShaderNodeBsdfPrincipled")
        np.testing.assert_allclose(shader.inputs["Base Color"].default_value[:3], (0.5, 0.25, 0.125))

    def test_tiles_are_converted(self):
        material = self._former(inputs.quarters_model())
        placement = scenes.velour_node(material).velour.placement
        plain = scenes.render(self.folder, "plain")
        placement.repeats, placement.rotation, placement.offset = (2, 1.5), 0.5, (0.1, 0.2)
        before = self._is_unchanged(material)
        self.assertGreater(np.abs(before - plain).max(), 0.05)
        group = scenes.velour_node(material).group
        self.assert_close(group.inputs["Rotation"].default_value, 0.5, 1e-6)
        self.assertEqual(group.inputs["Vector"].links[0].from_node.bl_idname, "ShaderNodeUVMap")

    def test_animations_point_to_the_inputs(self):
        material = self._former()
        settings = scenes.velour_node(material).velour
        tree, path = material.node_tree, f'nodes["{scenes.velour_node(material).name}"].velour.'
        for frame, tint in ((1, (1, 1, 1)), (2, (0.5, 0.25, 0.75))):
            settings.tint, settings.outline_width = tint, frame
            for name in ("tint", "outline_width"):
                _insert_key(tree, path + name, frame)
        tree.driver_add(f"{path}exposure").driver.expression = "-1"
        bpy.context.scene.frame_set(2)
        self._is_unchanged(material)
        node = scenes.velour_node(material)
        for frame, tint in ((1, (1, 1, 1)), (2, (0.5, 0.25, 0.75))):
            bpy.context.scene.frame_set(frame)
            np.testing.assert_allclose(node.group.inputs["Tint"].default_value[:3], tint, rtol=1e-6)
            self.assertEqual(node.velour.outline_width, frame)
        self.assertEqual(node.group.inputs["Exposure"].default_value, -1)

    @unittest.skipUnless("action_slot" in bpy.types.AnimData.bl_rna.properties, "slots are new in 4.4")
    def test_an_animation_may_be_in_any_slot(self):
        material = self._former()
        tree, name = material.node_tree, scenes.velour_node(material).name
        action, path = bpy.data.actions.new("Shared"), f'nodes["{name}"].velour.exposure'
        animation = tree.animation_data_create()
        animation.action = action
        action.slots.new("OBJECT", "Ball")
        animation.action_slot = slot = action.slots.new("NODETREE", "Tree")
        strip = action.layers.new("Layer").strips.new(type="KEYFRAME")
        other, own = (strip.channelbag(each, ensure=True) for each in action.slots)
        other.fcurves.new("location")
        own.fcurves.new(path).keyframe_points.insert(1, -1)
        bpy.ops.velour.convert_materials()
        self.assertEqual(tree.animation_data.action_slot, slot)
        (curve,) = strip.channelbag(slot).fcurves
        self.assertIn(".inputs[", curve.data_path)
        bpy.context.scene.frame_set(2)
        self.assertEqual(scenes.velour_node(material).group.inputs["Exposure"].default_value, -1)

    def test_a_fit_converts(self):
        material = self._former()
        measured = inputs.module("operators.measured")
        scenes.velour_node(material).velour.measurement = measured.file_image(
            str(inputs.lambert_measurement())
        )
        bpy.ops.velour.fit(tolerance=0.2, max_lobes=2)
        node = scenes.velour_node(material)
        self.assertIsNotNone(node.group)
        self.assertIsNotNone(node.velour.measurement)

    def test_linked_materials_stay_as_they_are(self):
        material = self._former()
        picture = scenes.render(self.folder, "here")
        path = str(self.folder / "library.blend")
        bpy.ops.wm.save_as_mainfile(filepath=path)
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        with bpy.data.libraries.load(path, link=True) as (_source, target):
            target.materials = ["Former"]
        material = bpy.data.materials["Former"]
        self._stage(material)
        np.testing.assert_array_equal(scenes.render(self.folder, "linked"), picture)
        with self.assertRaisesRegex(RuntimeError, "linked from another file; convert it there"):
            bpy.ops.velour.convert_materials(material="Former")
        self.assertIsNone(scenes.velour_node(material).group)

    def test_a_file_of_a_release_is_not_changed_by_loading_it(self):
        older_file.open_it()
        former = [m for m in bpy.data.materials if scenes.velour_node(m)]
        self.assertTrue(former)
        self.assertTrue(all(scenes.velour_node(m).group is None for m in former))
        self.assertEqual(bpy.ops.velour.convert_materials(), {"FINISHED"})
        self.assertTrue(all(scenes.velour_node(m).group is not None for m in former))
        self.assertEqual(bpy.ops.velour.convert_materials(), {"FINISHED"})

    def test_an_unknown_material_is_refused(self):
        with self.assertRaisesRegex(RuntimeError, "There is no material 'Nobody'"):
            bpy.ops.velour.convert_materials(material="Nobody")


def _insert_key(tree, path, frame):
    """Blender 4.3 inserts no keys for properties that add-ons give to nodes."""
    if tree.keyframe_insert(path, frame=frame):
        return
    curves, value = tree.animation_data.action.fcurves, tree.path_resolve(path)
    for index, number in enumerate(value if hasattr(value, "__len__") else (value,)):
        curve = curves.find(path, index=index) or curves.new(path, index=index)
        curve.keyframe_points.insert(frame, number)
