"""Where tiles of BTFs lie on objects: pictures of a tile of four greys, what is measured and what is said."""

import importlib
import types
import unittest.mock

import bpy
import numpy as np
from mathutils import Matrix

from support import inputs, scenes
from support.blender import BlenderTest

SIZE = 64  # pixels of a picture two units wide
_OF_PANELS = ("summaries", "placement_summary")


def _export(name):
    return importlib.import_module(f"{inputs.ADDON}.export.{name}")


def _expected(uv_map, uvs):
    """Albedo at texture coordinates [n x 2], and whether that is far from the borders of the quarters."""
    tiles = uvs @ uv_map[:, :2].T + uv_map[:, 2]
    part = tiles - np.floor(tiles)
    halves = (2 * part).astype(int)
    far = (np.abs(2 * part - halves - 0.5) < 0.3).all(axis=1)
    return np.array(inputs.QUARTERS)[halves[:, 1], halves[:, 0]], far


class Placed(BlenderTest):
    def setUp(self):
        super().setUp()
        self.scene = scenes.use_engine(samples=64, size=SIZE)
        scenes.set_world()
        scenes.add_camera(ortho_scale=2.0)

    def _material(self, metres=0.5, **settings):
        material = scenes.measured_material(inputs.quarters_model(metres), "Quarters")
        for name, value in settings.items():
            setattr(scenes.velour_node(material).velour.placement, name, value)
        return material

    def _placement(self):
        return scenes.velour_node(bpy.data.materials["Quarters"]).velour.placement

    def _check_picture(self, uv_map, width=1.0, height=1.0):
        """The plane's picture, where the plane takes `width` and `height` of the picture."""
        pixels = scenes.render(self.folder)[..., 0]
        rows, columns = np.mgrid[0:SIZE, 0:SIZE]
        at = (np.stack([columns, rows], axis=-1).reshape(-1, 2) + 0.5) / SIZE
        uvs = (at - 0.5) / (width, height) + 0.5
        albedo, far = _expected(np.asarray(uv_map, float), uvs)
        far &= (np.abs(uvs - 0.5) < 0.48).all(axis=1)
        self.assertGreater(far.mean(), 0.05)
        error = np.abs(pixels.reshape(-1)[far] / albedo[far] - 1).max()
        self.assertLess(error, 0.06)

    def _report(self, obj=None, material=None):
        obj = obj or bpy.context.object
        material = material or obj.active_material
        node = scenes.velour_node(material)
        with inputs.native().Model.from_bytes(node.image.packed_file.data, "model") as model:
            tile = _export("placement").Tile.of(material, model.info())
        depsgraph = bpy.context.evaluated_depsgraph_get()
        return _export("placement_report").report_on(depsgraph, obj, material, tile)

    def _rows(self, **arguments):
        return dict(self._report(**arguments).rows)

    def _notes(self):
        export = importlib.import_module(f"{inputs.ADDON}.export")
        notes = export.Notes()
        depsgraph = bpy.context.evaluated_depsgraph_get()
        export.export_scene(depsgraph, _export("camera").final_view(depsgraph, notes), notes)[0].close()
        return list(notes)


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
        self.assertEqual(self._rows()["Tile here"], "500 x 500 mm, real size")
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
        """Of all instances that are exported, as the library gets them."""
        native = inputs.native()
        given, add = [], native.Scene.add_instance

        def recorded(scene, mesh, matrix, materials, placements=None, hidden=()):
            given.append(np.array(placements))
            add(scene, mesh, matrix, materials, placements, hidden)

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
        self.assertEqual(
            (settings.mode, settings.rotation, tuple(settings.tile_size)), ("REAL_SIZE", 1.0, (20, 30))
        )

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
        self.assertEqual(self._rows()["Tile here"], "500 x 500 mm, real size")
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


class Panel(Placed):
    def test_a_linked_material_on_an_object_of_this_file(self):
        """It is measured by its own name, which another one may have."""
        blend = self.folder / "library.blend"
        scenes.add_plane(self._material())
        bpy.ops.wm.save_as_mainfile(filepath=str(blend))
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        with bpy.data.libraries.load(str(blend), link=True) as (_source, target):
            target.materials = ["Quarters"]
        (material,) = target.materials
        obj = scenes.add_plane(material)
        ui = {name: importlib.import_module(f"{inputs.ADDON}.ui.{name}") for name in _OF_PANELS}
        context = types.SimpleNamespace(object=obj, scene=bpy.context.scene)
        while ui["summaries"].model_summary(scenes.velour_node(material).image) is None:
            ui["summaries"]._turn()
        ui["placement_summary"]._changed = 0.0
        ui["placement_summary"].measured(context, material)
        ui["placement_summary"]._measure()
        report = ui["placement_summary"].measured(context, material)
        self.assertEqual(dict(report.placement.rows)["Tile here"], "2 x 2 m, 4 x 4 of real size")


class Reports(Placed):
    def test_rows_of_a_plane(self):
        scenes.add_plane(self._material(mode="REAL_SIZE"))
        self.assertEqual(
            self._rows(),
            {
                "UV density": "0.5 x 0.5 per metre",
                "Tile here": "500 x 500 mm, real size",
                "Spread": "1.00 to 1.00",
                "Texels": "0.032 per mm",  # 16 over 500 mm
                "In the camera": "1 texels per pixel, least 1",  # a pixel is 1/32 m wide
                "Stretch": "1.00:1, 0% above 2:1",
            },
        )

    def test_texels_by_perspective(self):
        """Two planes of the same tiles; the one that is nearer hides the other, and its texels are larger."""
        material = self._material(repeats=(8, 8))  # 64 texels a unit
        far = scenes.add_plane(material)
        camera = self.scene.camera
        camera.data.type, camera.data.angle = "PERSP", 2 * np.arctan(0.5)  # a pixel is distance / 64 wide
        camera.location.z = 4
        self.assertEqual(self._rows()["In the camera"], "4 texels per pixel, least 4")
        near = scenes.add_plane(material)
        near.location.z = 2
        bpy.context.view_layer.update()
        self.assertEqual(self._rows(obj=near)["In the camera"], "2 texels per pixel, least 2")
        self.assertEqual(self._rows(obj=far)["In the camera"], "not seen")
        near.hide_set(True)
        camera.location.z = 9  # the plane fills a small part of the picture
        bpy.context.view_layer.update()
        self.assertEqual(self._rows(obj=far)["In the camera"], "9 texels per pixel, least 9")

    def test_ground_that_reaches_the_eye(self):
        obj = scenes.add_plane(self._material(repeats=(100, 100)), size=100.0)
        camera = self.scene.camera
        camera.data.type = "PERSP"
        camera.location, camera.rotation_euler = (0, 0, 1.5), (np.radians(80), 0, 0)
        bpy.context.view_layer.update()
        value = self._rows(obj=obj)["In the camera"]
        median, least = (
            float(value.split(word)[1 if word == "least" else 0].split()[0]) for word in ("texels", "least")
        )
        pixel = 2 * np.tan(camera.data.angle / 2) / SIZE  # at distance 1
        lowest = 1.5 / np.sin(np.radians(10) + camera.data.angle / 2)  # along the lowest rays
        self.assert_close(least, 16 * pixel * lowest * np.cos(camera.data.angle / 2), 0.1 * least)
        self.assertGreater(median, least)

    def test_while_the_object_is_edited(self):
        scenes.add_plane(self._material(mode="REAL_SIZE"))
        rows = self._rows()
        bpy.ops.object.mode_set(mode="EDIT")
        self.assertEqual(self._rows(), rows)

    def test_curves_have_texture_coordinates_of_their_own(self):
        bpy.ops.curve.primitive_bezier_circle_add()
        curve = bpy.context.object
        curve.data.materials.append(self._material())
        curve.data.extrude = 0.5
        bpy.context.view_layer.update()
        # u runs around once, v over 1 m.
        self.assertEqual(self._rows()["UV density"], "0.159 x 1 per metre")
        self.assertIn("stretched", self._notes()[0])
        self._placement().mode = "REAL_SIZE"
        self.assertEqual(self._notes(), [])

    def test_modifiers_count(self):
        obj = scenes.add_plane(self._material(mode="REAL_SIZE"))
        array = obj.modifiers.new("Array", "ARRAY")
        array.count = 3
        self.assertEqual(self._rows()["Tile here"], "500 x 500 mm, real size")
        obj.modifiers.new("Lift", "DISPLACE").strength = 0.5
        self.assertEqual(self._rows()["Stretch"], "1.00:1, 0% above 2:1")

    def test_without_a_camera(self):
        scenes.add_plane(self._material())
        self.scene.camera = None
        self.assertEqual(self._rows()["In the camera"], "no camera that renders")

    def test_spread_and_stretch_of_a_sphere(self):
        bpy.ops.mesh.primitive_uv_sphere_add()
        bpy.context.object.data.materials.append(self._material(mode="REAL_SIZE"))
        report = self._report()
        low, high = (float(end) for end in dict(report.rows)["Spread"].split(" to "))
        self.assert_close(low, 0.71, 0.03)
        self.assert_close(high, 1.07, 0.03)
        self.assertEqual(len(report.warnings), 1)

    def test_operators_say_the_same(self):
        scenes.add_plane(self._material(mode="REAL_SIZE"))
        self.assertEqual(bpy.ops.velour.describe_placement(), {"FINISHED"})
        self.assertEqual(bpy.ops.velour.describe_placement(object="Plane", material="Quarters"), {"FINISHED"})

    def test_operators_refuse_by_name(self):
        with self.assertRaisesRegex(RuntimeError, "no active object"):
            bpy.ops.velour.describe_placement()
        with self.assertRaisesRegex(RuntimeError, "no object 'Gone'"):
            bpy.ops.velour.describe_placement(object="Gone")
        obj = scenes.add_plane()
        with self.assertRaisesRegex(RuntimeError, "Object 'Plane': there is no material"):
            bpy.ops.velour.describe_placement()
        data = inputs.model_bytes(inputs.glossy_measurement())
        obj.data.materials.append(scenes.measured_material(data))
        with self.assertRaisesRegex(RuntimeError, "'Paint' is the same all over"):
            bpy.ops.velour.describe_placement()
        obj.data.materials[0] = self._material()
        obj.data.uv_layers.remove(obj.data.uv_layers[0])
        with self.assertRaisesRegex(RuntimeError, "'Plane': it has no UV map"):
            bpy.ops.velour.keep_uv_density()

    def test_keeping_the_density_is_one_undo_step(self):
        scenes.add_plane(self._material(mode="REAL_SIZE"))
        bpy.ops.ed.undo_push(message="before")
        bpy.ops.velour.keep_uv_density()
        bpy.ops.ed.undo_push(message="after")
        bpy.ops.ed.undo()
        self.assertEqual(tuple(self._placement().uv_density), (0, 0))


class Warnings(Placed):
    def test_an_even_plane_is_silent(self):
        scenes.add_plane(self._material(mode="REAL_SIZE"))
        self.assertEqual(self._notes(), [])

    def test_stretch_above_two_names_object_share_and_place(self):
        obj = scenes.add_plane(self._material())
        obj.name = "Carpet"
        for vertex in obj.data.vertices:
            vertex.co.x *= 3
        notes = self._notes()
        self.assertEqual(len(notes), 1)
        for words in (
            "Object 'Carpet'",
            "material 'Quarters'",
            "2:1 on 100% of it",
            "up to 3.0:1",
            "own axes",
        ):
            self.assertIn(words, notes[0])
        report = self._report()
        self.assertEqual(list(report.warnings), notes)
        self.assertEqual(dict(report.rows)["Tile here"], "6 x 2 m, 12 x 4 of real size")
        for vertex in obj.data.vertices:
            vertex.co.x /= 3
        obj.scale.x = 3
        bpy.context.view_layer.update()
        self.assertIn("up to 3.0:1", self._notes()[0])
        self._placement().mode = "REAL_SIZE"
        self.assertEqual(self._notes(), [])

    def test_objects_that_share_a_mesh_are_all_named(self):
        obj = scenes.add_plane(self._material())
        obj.data.transform(Matrix.Diagonal((3, 1, 1, 1)))
        for name in ("Second", "Third"):
            self.scene.collection.objects.link(bpy.data.objects.new(name, obj.data))
        owners = {note.split("'")[1] for note in self._notes()}
        self.assertEqual(owners, {"Plane", "Second", "Third"})

    def test_texture_coordinates_without_extent(self):
        obj = scenes.add_plane(self._material(mode="REAL_SIZE"))
        for loop in obj.data.uv_layers[0].data:
            loop.uv = (0.5, 0.5)
        self.assertIn("has no extent", self._notes()[0])

    def test_real_size_of_unknown_size_is_refused(self):
        scenes.add_plane(self._material(metres=0, mode="REAL_SIZE"))
        with self.assertRaisesRegex(RuntimeError, "Material 'Quarters': its model does not know how large"):
            scenes.render(self.folder)
        report = self._report()
        self.assertIn("enter Tile Size", report.warnings[0])
        self._placement().tile_size = (500, 500)
        self._check_picture(((4, 0, 0), (0, 4, 0)))
        self.assertEqual(self._rows()["Tile here"], "500 x 500 mm, real size")

    def test_a_preview_without_a_size_is_not_refused(self):
        scenes.add_plane(self._material(metres=0, mode="REAL_SIZE"))
        export = importlib.import_module(f"{inputs.ADDON}.export")
        notes, depsgraph = export.Notes(), bpy.context.evaluated_depsgraph_get()
        view = _export("camera").final_view(depsgraph, notes)
        export.export_scene(depsgraph, view, notes, strict=False)[0].close()
        self.assertIn("enter Tile Size", " ".join(notes))

    def test_repeats_of_unknown_size_are_fine_and_said(self):
        scenes.add_plane(self._material(metres=0))
        self.assertEqual(self._notes(), [])
        self.assertEqual(self._rows()["Tile here"], "2 x 2 m, real size not known")

    def test_slots_are_measured_apart(self):
        """Two faces, one of them 3 times as dense in u: only the material of that one is stretched."""
        mesh = bpy.data.meshes.new("Two")
        mesh.from_pydata(
            [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (2, 0, 0), (2, 1, 0)],
            [],
            [(0, 1, 2, 3), (1, 4, 5, 2)],
        )
        layer = mesh.uv_layers.new()
        uvs = [(0, 0), (1, 0), (1, 1), (0, 1), (0, 0), (3, 0), (3, 1), (0, 1)]
        for loop, uv in zip(layer.data, uvs, strict=True):
            loop.uv = uv
        other = self._material()
        other.name = "Other"
        for material in (self._material(), other):
            mesh.materials.append(material)
        mesh.polygons[1].material_index = 1
        self.scene.collection.objects.link(bpy.data.objects.new("Two", mesh))
        notes = self._notes()
        self.assertEqual(len(notes), 1)
        self.assertIn("material 'Other'", notes[0])
