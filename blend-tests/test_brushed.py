"""Anisotropic measurements: which way they lie on objects, by pictures under a sun from one side."""

import bpy
import numpy as np

from support import inputs, scenes
from support.blender import BlenderTest
from support.notes import export_notes

SIZE = 32


class Brushed(BlenderTest):
    """Everything is seen from above; the sun is a point, so that nothing but edges of objects is noise."""

    def setUp(self):
        super().setUp()
        scenes.use_engine(samples=64, size=SIZE)
        scenes.set_world(strength=0)
        scenes.add_camera(ortho_scale=2.0)
        lamp = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
        lamp.data.angle, lamp.rotation_euler = 0, (0, np.radians(40), 0)
        bpy.context.scene.collection.objects.link(lamp)
        self.material = scenes.measured_material(inputs.brushed_model(), "Metal")

    def _placement(self):
        return scenes.velour_node(self.material).velour.placement

    def _wave(self):
        """A sheet that waves along x. Its map 'Turned' says what the other one says after a quarter turn."""
        bpy.ops.mesh.primitive_grid_add(x_subdivisions=40, y_subdivisions=4, size=3)
        obj = bpy.context.object
        for vertex in obj.data.vertices:
            vertex.co.z = 0.1 * np.sin(6 * vertex.co.x)
        obj.data.materials.append(self.material)
        bpy.ops.object.shade_smooth()
        plain, turned = obj.data.uv_layers[0], obj.data.uv_layers.new(name="Turned")
        for before, after in zip(plain.data, turned.data, strict=True):
            after.uv = before.uv.y, -before.uv.x
        obj.data.uv_layers[0].active_render = True
        return obj

    def _picture(self):
        return scenes.render(self.folder)[..., :3]

    def _assert_alike(self, a, b):
        self.assertLess(np.abs(a - b).max(), 0.02 * b.mean())

    def _assert_unlike(self, a, b):
        self.assertGreater(np.abs(a - b).mean(), 0.1 * b.mean())


class Rotation(Brushed):
    def test_it_is_as_if_the_object_were_turned_by_hand(self):
        obj = scenes.add_plane(self.material, size=4.0)
        plain = self._picture()
        for angle in (0.6, np.pi / 2):
            obj.rotation_euler.z = angle
            scenes.set_look(self.material, rotation=0)
            by_hand = self._picture()
            obj.rotation_euler.z = 0
            scenes.set_look(self.material, rotation=angle)
            self._assert_alike(self._picture(), by_hand)
            self._assert_unlike(by_hand, plain)

    def test_each_slot_has_its_own(self):
        obj = scenes.add_plane(self.material, size=4.0)
        scenes.set_look(self.material, rotation=np.pi / 2)
        turned = self._picture()
        other = scenes.measured_material(inputs.brushed_model(), "Other")
        obj.data.materials.append(other)
        obj.data.polygons[0].material_index = 1
        plain = self._picture()
        self._assert_unlike(plain, turned)
        scenes.set_look(other, rotation=np.pi / 2)
        self._assert_alike(self._picture(), turned)

    def test_many_instances_share_a_mesh(self):
        """Half of them turned by an object of their own."""
        obj = scenes.add_plane(self.material, size=1.0)
        obj.location = (-0.5, 0, 0)
        other = bpy.data.objects.new("Other", obj.data)
        other.location = (0.5, 0, 0)
        bpy.context.scene.collection.objects.link(other)
        scenes.set_look(self.material, rotation=0.4)
        other.rotation_euler.z = -0.4
        left, right = np.split(self._picture()[SIZE * 3 // 8 : SIZE * 5 // 8], 2, axis=1)
        scenes.set_look(self.material, rotation=0)
        other.rotation_euler.z = 0
        plain = self._picture()[SIZE * 3 // 8 : SIZE * 5 // 8]
        middle = slice(SIZE // 8, SIZE * 3 // 8)
        self._assert_alike(right[:, middle], plain[:, SIZE // 2 :][:, middle])
        self._assert_unlike(left[:, middle], plain[:, : SIZE // 2][:, middle])

    def test_isotropic_materials_have_no_use_for_it(self):
        self.material = scenes.measured_material(inputs.model_bytes(inputs.lambert_measurement()), "Matt")
        obj = self._wave()
        plain = self._picture()
        self._placement().uv_map = "none of that name"
        np.testing.assert_array_equal(self._picture(), plain)
        while obj.data.uv_layers:
            obj.data.uv_layers.remove(obj.data.uv_layers[0])
        np.testing.assert_array_equal(self._picture(), plain)
        self.assertEqual(export_notes(), [])


class UvMaps(Brushed):
    def test_another_uv_map(self):
        self._wave()
        plain = self._picture()
        scenes.set_look(self.material, rotation=np.pi / 2)
        turned = self._picture()
        self._assert_unlike(turned, plain)
        scenes.set_look(self.material, rotation=0)
        self._placement().uv_map = "Turned"
        self._assert_alike(self._picture(), turned)

    def test_one_that_is_not_there_is_named(self):
        self._wave()
        plain = self._picture()
        self._placement().uv_map = "Coarse"
        np.testing.assert_array_equal(self._picture(), plain)
        self.assertTrue(any("no UV map 'Coarse'" in note for note in export_notes()))

    def test_without_any_the_mesh_is_projected(self):
        obj = self._wave()
        plain = self._picture()
        self.assertEqual(export_notes(), [])
        while obj.data.uv_layers:
            obj.data.uv_layers.remove(obj.data.uv_layers[0])
        obj.data.update_tag()  # Blender 5.2 does not see it by itself
        self._assert_alike(self._picture(), plain)  # from above u is x
        scenes.set_look(self.material, rotation=np.pi / 2)
        self._assert_unlike(self._picture(), plain)
        (note,) = export_notes()
        self.assertIn(f"Object '{obj.name}': it has no UV map", note)
        self.assertIn("material 'Metal' is projected", note)

    def test_measurements_themselves_look_at_them_too(self):
        obj = scenes.add_plane(self.material)
        obj.data.uv_layers.remove(obj.data.uv_layers[0])
        settings = scenes.velour_node(self.material).velour
        settings.use_reference = True
        settings.measurement = bpy.data.images.load(str(inputs.anisotropic_measurement()))
        self.assertIn("is projected onto it", export_notes()[0])
        settings.measurement = bpy.data.images.load(str(inputs.lambert_measurement()))
        settings.id_data.update_tag()
        self.assertEqual(export_notes(), [])
