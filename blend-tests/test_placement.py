"""Where tiles of BTFs lie on objects: pictures of a tile of four grays."""

import unittest.mock

import bpy
import numpy as np

from support import inputs, scenes
from support.placement import Placed


class Pictures(Placed):
    def test_one_tile_over_the_unit_square_by_default(self):
        scenes.add_plane(self._material())
        self._check_picture(((1, 0, 0), (0, 1, 0)))

    def test_repeats_offset_and_rotation(self):
        scenes.add_plane(self._material(repeats=(2, 3), offset=(0.1, 0.3), rotation=np.radians(90)))
        # The tile's x runs along v, its y against u; its corner is at (0.1, 0.3).
        self._check_picture(((0, 2, -0.6), (-3, 0, 0.3)))

    def test_real_size(self):
        scenes.add_plane(self._material(mode="REAL_SIZE"))  # 2 m, tiles of 0.5 m
        self._check_picture(((4, 0, 0), (0, 4, 0)))

    def test_real_size_on_any_shape_and_unit(self):
        """A plane of 2 x 1 units of half a metre under one unit square of texture coordinates."""
        self.scene.unit_settings.scale_length = 0.5
        obj = scenes.add_plane(self._material(mode="REAL_SIZE"))
        for vertex in obj.data.vertices:
            vertex.co.y /= 2
        self.assertEqual(self._rows()["Stretch"], "1.00:1, 0% above 2:1")
        self.assertEqual(self._rows()["Tile size"], "500 x 500 mm, real size")
        self._check_picture(((2, 0, 0), (0, 1, 0)), height=0.5)

    def test_entered_size_goes_before_the_btfs_own(self):
        scenes.add_plane(self._material(mode="REAL_SIZE", tile_size=(1000, 250)))
        self._check_picture(((2, 0, 0), (0, 8, 0)))

    def test_object_scale_keeps_or_stretches(self):
        obj = scenes.add_plane(self._material(mode="REAL_SIZE"), size=1.0)
        obj.scale = (2, 2, 1)  # as large as the picture
        self._check_picture(((4, 0, 0), (0, 4, 0)))
        self._placement().real_size_scale = "STRETCH"
        self._check_picture(((2, 0, 0), (0, 2, 0)))
        self._placement().mode = "REPEATS"
        self._placement().repeats = (3, 3)
        self._check_picture(((3, 0, 0), (0, 3, 0)))
        self._placement().repeats_scale = "KEEP"
        self._check_picture(((6, 0, 0), (0, 6, 0)))

    def test_keeping_size_undoes_an_uneven_scale(self):
        obj = scenes.add_plane(self._material(mode="REAL_SIZE"), size=1.0)
        obj.scale = (2, 4, 1)
        self._check_picture(((4, 0, 0), (0, 8, 0)), height=2)
        self.assertEqual(self._rows()["Stretch"], "1.00:1, 0% above 2:1")

    def test_each_object_has_its_own_density(self):
        material = self._material(mode="REAL_SIZE")
        small = scenes.add_plane(material, size=1.0)
        small.location = (-0.5, -0.5, 1e-4)  # no shadow
        scenes.add_plane(material)
        # Both begin a tile in the same corner, and tiles are as large: the small one cannot be told apart.
        self._check_picture(((4, 0, 0), (0, 4, 0)))

    def test_instances_of_one_mesh_in_several_sizes(self):
        material = self._material(mode="REAL_SIZE")
        large = scenes.add_plane(material, size=1.0)
        large.scale = (2, 2, 1)
        small = bpy.data.objects.new("Small", large.data)
        small.location = (-0.5, -0.5, 1e-4)  # no shadow
        self.scene.collection.objects.link(small)
        self._check_picture(((4, 0, 0), (0, 4, 0)))

    def _maps(self):
        """Placements of all exported instances, as the library receives them."""
        native = inputs.native()
        given, add = [], native.Scene.add_instance

        def recorded(scene, mesh, matrix, materials, placements=None, *rest):
            given.append(np.array(placements))
            add(scene, mesh, matrix, materials, placements, *rest)

        with unittest.mock.patch.object(native.Scene, "add_instance", recorded):
            scenes.render(self.folder)
        return given

    def test_slots_of_objects_of_one_mesh_have_densities_of_their_own(self):
        """Faces of two densities: one object shows the material on both, the other on the first alone."""
        both = scenes.add_plane(self._material(mode="REAL_SIZE"))
        bpy.context.view_layer.objects.active = both
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.subdivide()
        bpy.ops.object.mode_set(mode="OBJECT")
        for polygon in both.data.polygons[1:]:
            polygon.material_index = 1
            for loop in polygon.loop_indices:
                both.data.uv_layers[0].data[loop].uv *= 5
        both.data.materials.append(both.data.materials[0])
        first = bpy.data.objects.new("First", both.data)
        first.material_slots[1].link = "OBJECT"
        first.material_slots[1].material = scenes.diffuse_material()
        self.scene.collection.objects.link(first)
        together = self._maps()
        alone = []
        for obj in (both, first):
            both.hide_render, first.hide_render = obj is not both, obj is not first
            alone += self._maps()
        self.assertEqual((len(together), len(alone)), (2, 2))
        self.assertGreater(np.abs(alone[0][0] - alone[1][0]).max(), 0.1)
        for maps in alone:
            self.assertTrue(any(np.array_equal(maps, other) for other in together), together)

    def test_a_density_that_is_kept_does_not_follow_the_mesh(self):
        obj = scenes.add_plane(self._material(mode="REAL_SIZE"), size=1.0)
        self.assertEqual(bpy.ops.velour.keep_uv_density(), {"FINISHED"})
        self.assertEqual(tuple(self._placement().uv_density), (1, 1))
        for vertex in obj.data.vertices:
            vertex.co *= 2  # as a mesh that grows in an animation
        self._check_picture(((2, 0, 0), (0, 2, 0)))
        obj.scale = (0.5, 0.5, 1)  # its scale still counts
        self._check_picture(((1, 0, 0), (0, 1, 0)), width=0.5, height=0.5)
        self._placement().uv_density = (0, 0)
        obj.scale = (1, 1, 1)
        self._check_picture(((4, 0, 0), (0, 4, 0)))

    def test_placement_is_saved(self):
        scenes.add_plane(self._material(mode="REAL_SIZE", rotation=1.0, tile_size=(20, 30)))
        path = self.folder / "placed.blend"
        bpy.ops.wm.save_as_mainfile(filepath=str(path))
        bpy.ops.wm.open_mainfile(filepath=str(path))
        settings = self._placement()
        self.assertEqual((settings.mode, tuple(settings.tile_size)), ("REAL_SIZE", (20, 30)))
        group = scenes.velour_node(bpy.data.materials["Quarters"]).group
        self.assertEqual(group.inputs["Rotation"].default_value, 1.0)

    def _plane_with_two_maps(self, scale, **settings):
        """A second map, which does not render, counts `scale` times as much."""
        plane = scenes.add_plane(size=2.0)
        layer = plane.data.uv_layers.new(name="Fine")
        for loop in layer.data:
            loop.uv *= scale
        plane.data.uv_layers[0].active_render = True
        plane.data.materials.append(self._material(**settings))
        return plane

    def test_another_uv_map(self):
        self._plane_with_two_maps(3, uv_map="Fine")
        self._check_picture([[3, 0, 0], [0, 3, 0]])
        self._placement().uv_map = ""
        self._check_picture([[1, 0, 0], [0, 1, 0]])

    def test_real_size_is_of_the_chosen_map(self):
        self._plane_with_two_maps(3, metres=0.5, mode="REAL_SIZE", uv_map="Fine")
        # A tile is half a metre whatever map it is placed by; the plane is two metres wide.
        self._check_picture([[4, 0, 0], [0, 4, 0]])

    def test_a_uv_map_that_is_not_there_is_named(self):
        self._plane_with_two_maps(3, uv_map="Coarse")
        self._check_picture([[1, 0, 0], [0, 1, 0]])
        self.assertTrue(any("no UV map 'Coarse'" in note for note in self._notes()))


class Projected(Placed):
    """Meshes without UV maps: seen from above, u is x and v is y, in units of the object."""

    def _bare_plane(self, *arguments, **settings):
        obj = scenes.add_plane(self._material(*arguments, **settings))
        obj.data.uv_layers.remove(obj.data.uv_layers[0])
        return obj

    def test_tiles_have_their_real_size(self):
        obj = self._bare_plane()
        expected = ((4, 0, -2), (0, 4, -2))  # tiles of half a metre from the middle of 2 m
        self._check_picture(expected)
        (note,) = self._notes()
        self.assertIn("Object 'Plane': it has no UV map; material 'Quarters' is projected", note)
        self.assertEqual(list(self._report().warnings), [note])
        self.assertEqual(self._rows()["Tile size"], "500 x 500 mm, real size")
        self._placement().mode = "REAL_SIZE"
        self._check_picture(expected)
        self._placement().uv_density = (7, 7)  # of another object, which has a UV map
        self._check_picture(expected)
        obj.data.uv_layers.new()
        self.assertEqual(self._notes(), [])

    def test_repeats_are_of_tiles_of_real_size(self):
        self._bare_plane(repeats=(2, 1), rotation=np.radians(90))
        self._check_picture(((0, 8, -4), (-4, 0, 2)))

    def test_repeats_of_unknown_size_are_of_metres(self):
        self.scene.unit_settings.scale_length = 2.0
        self._bare_plane(metres=0)
        self._check_picture(((4, 0, -2), (0, 4, -2)))  # four metres

    def test_the_units_of_the_scene_and_the_objects_scale_count(self):
        self.scene.unit_settings.scale_length = 0.5
        obj = self._bare_plane(mode="REAL_SIZE")
        self._check_picture(((2, 0, -1), (0, 2, -1)))
        for vertex in obj.data.vertices:
            vertex.co /= 2
        obj.scale = (2, 2, 1)
        self._check_picture(((2, 0, -1), (0, 2, -1)))
        self._placement().real_size_scale = "STRETCH"
        self._check_picture(((1, 0, -0.5), (0, 1, -0.5)))

    def test_faces_are_seen_along_the_axis_that_they_face(self):
        """A box from the front: z is up."""
        bpy.ops.mesh.primitive_cube_add(size=2.0)
        bpy.context.object.data.materials.append(self._material())
        bpy.context.object.data.uv_layers.remove(bpy.context.object.data.uv_layers[0])
        camera = self.scene.camera
        camera.location, camera.rotation_euler = (0, -5, 0), (np.radians(90), 0, 0)
        self._check_picture(((4, 0, -2), (0, 4, -2)))
        camera.location, camera.rotation_euler = (-5, 0, 0), (np.radians(90), 0, np.radians(-90))
        self._check_picture(((4, 0, -2), (0, 4, -2)))  # u is -y, which is to the right

    def test_pictures_of_other_slots_still_show_one_point(self):
        """A picture on a mesh without UV maps is what Cycles shows of it."""
        obj = self._bare_plane()
        picture = scenes.diffuse_material(name="Picture")
        tree = picture.node_tree
        texture = tree.nodes.new("ShaderNodeTexImage")
        texture.image = bpy.data.images.new("Black and white", 2, 2)
        texture.image.pixels = [0, 0, 0, 1, 1, 1, 1, 1] * 2
        tree.links.new(texture.outputs[0], tree.nodes["Diffuse BSDF"].inputs["Color"])
        obj.data.materials.append(picture)
        notes = self._notes()
        self.assertEqual(len(notes), 1)  # it shows on no face
        obj.data.polygons[0].material_index = 1
        notes = self._notes()
        self.assertTrue(any("one point of material 'Picture'" in note for note in notes), notes)
        pixels = scenes.render(self.folder)[..., 0]
        self.assertGreater(pixels.mean(), 0.1)
        self.assertLess(pixels.std(), 0.01 * pixels.mean())

    def test_what_is_no_mesh_yet(self):
        bpy.ops.object.metaball_add(radius=0.5)
        bpy.context.object.data.materials.append(self._material())
        bpy.context.view_layer.update()
        (note,) = self._notes()
        self.assertIn("Object 'Mball': it has no UV map", note)
