"""How often a tile repeats once Apply Material has put it on objects, counted along edges of their meshes."""

import contextlib
import io
from unittest import mock

import bpy
import numpy as np

from support import inputs, scenes
from support.placement import Placed, export_module


class AppliedTiles(Placed):
    def _apply(self, obj, material=None, **arguments):
        """Applies the material; returns its placement, and what is reported, as Blender prints it."""
        material = material or bpy.data.materials.get("Quarters") or self._small()
        with contextlib.redirect_stdout(io.StringIO()) as said:
            done = bpy.ops.velour.apply_material(material=material.name, object=obj.name, **arguments)
        self.assertEqual((done, obj.active_material), ({"FINISHED"}, material))
        return scenes.velour_node(material).velour.placement, said.getvalue()

    def _small(self, **settings):
        """The material with tiles of 2 mm."""
        return self._material(tile_size=(2, 2), **settings)

    def _cube(self, **arguments):
        bpy.ops.mesh.primitive_cube_add(**arguments)
        return bpy.context.object

    def _plane(self, size=2.0):
        return scenes.add_plane(size=size)

    def _assert_tiles(self, obj, along, tolerance=0.01):
        """Tiles are square and as many along the object's longest side, by the edges of its largest face."""
        evaluated = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
        mesh, repeats = evaluated.data, self._placement().repeats
        face = max(mesh.polygons, key=lambda each: each.area)
        vertices = [evaluated.matrix_world @ mesh.vertices[i].co for i in face.vertices]
        uvs = [np.array(mesh.uv_layers[0].data[i].uv) * repeats for i in face.loop_indices]
        for k in range(len(vertices)):
            side = (vertices[k] - vertices[k - 1]).length / np.linalg.norm(uvs[k] - uvs[k - 1])
            self.assert_close(max(evaluated.dimensions) / side, along, tolerance * along)

    def test_a_tile_too_small_to_be_seen(self):
        """1000 tiles of 2 mm would lie along the cube, whose faces have a quarter of a unit each."""
        cube = self._cube()
        placement, said = self._apply(cube)
        self.assertEqual((placement.mode, tuple(placement.repeats)), ("REPEATS", (80, 80)))
        self._assert_tiles(cube, 20)
        self.assertNotIn("Warning", said)
        self.assertIn(", 20 tiles along the longest side of 'Cube'.", said)

    def test_the_check_of_these_tests_sees_a_density_that_is_not_measured(self):
        cube = self._cube()
        metric = export_module("placement").UvMetric
        with mock.patch.object(metric, "density", return_value=(1.0, 1.0)):
            self._apply(cube)
        with self.assertRaises(AssertionError):
            self._assert_tiles(cube, 20)

    def test_a_tile_as_large_as_the_object(self):
        """As in a scene of millimeters, whose cube is as wide as a weave."""
        self.scene.unit_settings.scale_length = 0.001
        cube = self._cube()
        self._apply(cube)
        self._assert_tiles(cube, 20)

    def test_real_size_where_it_can_be_seen(self):
        cube = self._cube(size=5)
        self._apply(cube, self._material())
        self._assert_tiles(cube, 10)

    def test_a_tile_of_unknown_size(self):
        cube = self._cube(size=0.3)
        self._apply(cube, self._material(0))
        self._assert_tiles(cube, 20)

    def test_an_entered_size(self):
        cube = self._cube()
        self._apply(cube, self._material(tile_size=(50, 50)))
        self._assert_tiles(cube, 40)

    def test_a_sphere(self):
        """Repeats around it are a whole number, without a seam; tiles are square at the median latitude."""
        bpy.ops.mesh.primitive_uv_sphere_add(segments=64, ring_count=64)
        placement, _said = self._apply(bpy.context.object)
        wanted = np.array((2 * np.pi * np.cos(np.pi / 6), np.pi)) / 0.1
        np.testing.assert_allclose(placement.repeats, wanted, rtol=0.03)
        np.testing.assert_array_equal(placement.repeats, np.round(placement.repeats))

    def test_an_uneven_scale(self):
        for scale_of_object in ("STRETCH", "KEEP"):
            with self.subTest(scale_of_object):
                plane, material = self._plane(), self._small(repeats_scale=scale_of_object)
                plane.scale = 3, 1, 1
                self._apply(plane, material)
                self.assertEqual(self._rows(obj=plane)["Stretch"], "1.00:1, 0% above 2:1")
                self.assertRegex(self._rows(obj=plane)["Tile size"], "^300 x 300 mm")
                material.name = "Former"

    def test_modifiers_count(self):
        plane = self._plane()
        plane.modifiers.new("Array", "ARRAY").count = 3
        self._apply(plane)
        self._assert_tiles(plane, 20)

    def test_a_rotated_tile_of_another_scale(self):
        material = self._small(rotation=np.pi / 2)
        scenes.velour_node(material).group.inputs["Scale"].default_value = 2.0
        plane = self._plane()
        plane.scale = 3, 1, 1
        self._apply(plane, material, tiles=30)
        self.assertRegex(self._rows(obj=plane)["Tile size"], "^200 x 200 mm")

    def test_without_a_uv_map(self):
        cube = self._cube()
        cube.data.uv_layers.remove(cube.data.uv_layers[0])
        _placement, said = self._apply(cube)
        self.assertRegex(said, "Warning: Object 'Cube': .*Unwrap it")
        self.assertRegex(self._rows(obj=cube)["Tile size"], "^100 x 100 mm")

    def test_a_uv_map_without_extent(self):
        cube = self._cube()
        for loop in cube.data.uv_layers[0].data:
            loop.uv = 0, 0
        placement, said = self._apply(cube)
        self.assertRegex(said, "Warning: Object 'Cube': .*Unwrap it")
        self.assertEqual(tuple(placement.repeats), (1, 1))

    def test_the_first_of_several_objects_decides(self):
        first = self._cube()
        second = bpy.data.objects.new("Second", first.data)
        second.scale = 3, 3, 3
        self.scene.collection.objects.link(second)
        self._apply(first)
        self._assert_tiles(first, 20)
        self._apply(second)
        self._assert_tiles(second, 20)  # stretched with the object
        self._assert_tiles(first, 20)

    def test_a_linked_object(self):
        cube = self._cube()
        cube.data.materials.append(scenes.diffuse_material())
        path = str(self.folder / "prop.blend")
        bpy.data.libraries.write(path, {cube}, fake_user=True)
        bpy.data.objects.remove(cube)
        with bpy.data.libraries.load(path, link=True) as (_source, target):
            target.objects = ["Cube"]
        self.scene.collection.objects.link(target.objects[0])
        self.scene.collection.objects.link(bpy.data.objects.new("Own", target.objects[0].data))
        material = self._material()
        for name in ("Cube", "Own"):
            with self.assertRaisesRegex(RuntimeError, f"'{name}' is linked from a library; choose another"):
                bpy.ops.velour.apply_material(material=material.name, object=name)
        self.assertFalse(self._placement().is_property_set("repeats"))

    def test_what_was_placed_stays(self):
        cube = self._cube()
        placement, _said = self._apply(cube, self._material(repeats=(5, 6)))
        self.assertEqual(tuple(placement.repeats), (5, 6))
        bpy.data.materials["Quarters"].name = "First"
        placement, said = self._apply(cube, self._material(mode="REAL_SIZE"))
        self.assertEqual((placement.mode, tuple(placement.repeats)), ("REAL_SIZE", (1, 1)))
        self.assertIn(", 4 tiles along", said)
        bpy.data.materials["Quarters"].name = "Second"
        material = self._material()
        scenes.velour_node(material).group.inputs["Scale"].default_value = 0.5
        placement, _said = self._apply(cube, material)
        self.assertEqual(tuple(placement.repeats), (1, 1))

    def test_a_number_replaces_what_was_placed(self):
        cube = self._cube()
        placement, _said = self._apply(cube, self._material(mode="REAL_SIZE"), tiles=7.5)
        self.assertEqual((placement.mode, tuple(placement.repeats)), ("REPEATS", (30, 30)))
        self._apply(cube, tiles=10)
        self._assert_tiles(cube, 10)

    def test_a_uniform_material_has_no_tiles(self):
        material = scenes.measured_material(inputs.model_bytes(inputs.glossy_measurement()))
        placement, said = self._apply(self._cube(), material)
        self.assertFalse(placement.is_property_set("repeats"))
        self.assertEqual(said.strip(), "Info: Material 'Paint' is on 'Cube'.")

    def test_undone_in_one_step(self):
        cube, material = self._cube(), self._material()
        bpy.ops.ed.undo_push(message="before")
        self._apply(cube, material)
        bpy.ops.ed.undo_push(message="after")
        bpy.ops.ed.undo()
        self.assertIsNone(bpy.data.objects["Cube"].active_material)
        self.assertFalse(self._placement().is_property_set("repeats"))
