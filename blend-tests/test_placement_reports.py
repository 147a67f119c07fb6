"""Where tiles of BTFs lie on objects: what is measured, and what is said."""

import types
import unittest.mock

import bpy
import numpy as np
from mathutils import Matrix

from support import inputs, scenes
from support.notes import export_notes
from support.placement import SIZE, Placed


class Panel(Placed):
    def setUp(self):
        super().setUp()
        for kept in (self._summary._reports, self._summary._fresh, self._summary._waiting):
            kept.clear()  # of other tests

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
        self._read(material)
        self._draw(obj)
        self._measure()
        self.assertEqual(self._tile_size(obj), "2 x 2 m, 4 x 4 times real size")

    def test_editors_that_show_different_objects(self):
        """They draw in turn, and each redraws all; each object is measured once for a change."""
        objects = [scenes.add_plane(self._material(), size=size) for size in (2.0, 4.0)]
        for obj in objects:
            self._read(obj.active_material)
        sizes = ["2 x 2 m, 4 x 4 times real size", "4 x 4 m, 8 x 8 times real size"]
        for obj in objects:
            self.assertIsNone(self._draw(obj))
        self.assertEqual(self._measure(), 2)
        self.assertEqual([self._tile_size(obj) for obj in objects], sizes)
        self.assertEqual(self._measure(), 0)
        objects[0].scale = 2, 2, 2
        bpy.context.view_layer.update()
        self.assertEqual([self._tile_size(obj) for obj in objects], sizes, "outdated until measured")
        self.assertEqual(self._measure(), 2)
        self.assertEqual([self._tile_size(obj) for obj in objects], 2 * sizes[1:])

    def test_few_reports_are_kept(self):
        objects = [scenes.add_plane(self._material()) for _ in range(3)]
        with unittest.mock.patch.object(self._summary, "_KEPT", 2):
            for obj in objects:
                self._draw(obj)
            self.assertEqual((len(self._summary._reports), len(self._summary._waiting)), (2, 2))

    def test_another_frame_is_measured(self):
        obj = scenes.add_plane(self._material())
        self._read(obj.active_material)
        for frame, scale in ((1, 1.0), (2, 3.0)):
            obj.scale = scale, scale, scale
            obj.keyframe_insert("scale", frame=frame)
        for frame, size in ((1, "2 x 2 m"), (2, "6 x 6 m")):
            bpy.context.scene.frame_set(frame)
            self._draw(obj)
            self.assertGreater(self._measure(), 0)
            self.assertIn(size, self._tile_size(obj))

    def test_windows_with_other_scenes_and_view_layers(self):
        """The object is in the second view layer alone."""
        window, timer = bpy.data.scenes.new("Window"), bpy.context.scene
        bpy.context.window.scene = window
        obj = scenes.add_plane(self._material())
        self._read(obj.active_material)
        second = window.view_layers.new("Second")
        first = next(layer for layer in window.view_layers if layer != second)
        bpy.context.window.view_layer = second
        second.update()
        first.use = False
        obj.hide_set(True, view_layer=first)
        bpy.context.window.scene = timer
        self._draw(obj, window, second)
        self._measure()
        report = self._draw(obj, window, second)
        self.assertEqual(dict(report.placement.rows)["Tile size"], "2 x 2 m, 4 x 4 times real size")

    @property
    def _summary(self):
        return inputs.module("ui.placement_summary")

    def _draw(self, obj, scene=None, layer=None):
        """What an editor draws that shows an object."""
        scene, layer = scene or bpy.context.scene, layer or bpy.context.view_layer
        context = types.SimpleNamespace(object=obj, scene=scene, view_layer=layer)
        return self._summary.measured(context, obj.active_material)

    def _tile_size(self, obj):
        return dict(self._draw(obj).placement.rows)["Tile size"]

    def _measure(self):
        """Runs the timer until it ends, as after a rest; returns how often it has measured."""
        count = 0
        while bpy.app.timers.is_registered(self._summary._measure):
            self._summary._changed, count = 0.0, count + 1
            if self._summary._measure() is None:
                bpy.app.timers.unregister(self._summary._measure)
        return count

    def _read(self, material):
        summaries = inputs.module("ui.summaries")
        while summaries.model_summary(scenes.velour_node(material).image) is None:
            summaries._turn()


class Reports(Placed):
    def test_rows_of_a_plane(self):
        scenes.add_plane(self._material(mode="REAL_SIZE"))
        self.assertEqual(
            self._rows(),
            {
                "UV density": "0.5 x 0.5 per meter",
                "Tile size": "500 x 500 mm, real size",
                "Spread": "1.00 to 1.00",
                "Texels": "0.032 per mm",  # 16 over 500 mm
                "In the camera": "1 texels per pixel, minimum 1",  # a pixel is 1/32 m wide
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
        self.assertEqual(self._rows()["In the camera"], "4 texels per pixel, minimum 4")
        near = scenes.add_plane(material)
        near.location.z = 2
        bpy.context.view_layer.update()
        self.assertEqual(self._rows(obj=near)["In the camera"], "2 texels per pixel, minimum 2")
        self.assertEqual(self._rows(obj=far)["In the camera"], "not visible")
        near.hide_set(True)
        camera.location.z = 9  # the plane fills a small part of the picture
        bpy.context.view_layer.update()
        self.assertEqual(self._rows(obj=far)["In the camera"], "9 texels per pixel, minimum 9")

    def test_ground_that_reaches_the_eye(self):
        obj = scenes.add_plane(self._material(repeats=(100, 100)), size=100.0)
        camera = self.scene.camera
        camera.data.type = "PERSP"
        camera.location, camera.rotation_euler = (0, 0, 1.5), (np.radians(80), 0, 0)
        bpy.context.view_layer.update()
        value = self._rows(obj=obj)["In the camera"]
        median, least = (
            float(value.split(word)[1 if word == "minimum" else 0].split()[0])
            for word in ("texels", "minimum")
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
        self.assertEqual(self._rows()["UV density"], "0.159 x 1 per meter")
        self.assertIn("stretched", self._notes()[0])
        self._placement().mode = "REAL_SIZE"
        self.assertEqual(self._notes(), [])

    def test_modifiers_count(self):
        obj = scenes.add_plane(self._material(mode="REAL_SIZE"))
        array = obj.modifiers.new("Array", "ARRAY")
        array.count = 3
        self.assertEqual(self._rows()["Tile size"], "500 x 500 mm, real size")
        obj.modifiers.new("Lift", "DISPLACE").strength = 0.5
        self.assertEqual(self._rows()["Stretch"], "1.00:1, 0% above 2:1")

    def test_without_a_camera(self):
        scenes.add_plane(self._material())
        self.scene.camera = None
        self.assertEqual(self._rows()["In the camera"], "no render camera")

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
        with self.assertRaisesRegex(RuntimeError, "Object 'Plane' has no material"):
            bpy.ops.velour.describe_placement()
        data = inputs.model_bytes(inputs.glossy_measurement())
        obj.data.materials.append(scenes.measured_material(data))
        with self.assertRaisesRegex(RuntimeError, "'Paint' is uniform"):
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
            "local coordinates",
        ):
            self.assertIn(words, notes[0])
        report = self._report()
        self.assertEqual(list(report.warnings), notes)
        self.assertEqual(dict(report.rows)["Tile size"], "6 x 2 m, 12 x 4 times real size")
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
        with self.assertRaisesRegex(RuntimeError, "Material 'Quarters': its model does not store the size"):
            scenes.render(self.folder)
        report = self._report()
        self.assertIn("enter Tile Size", report.warnings[0])
        self._placement().tile_size = (500, 500)
        self._check_picture(((4, 0, 0), (0, 4, 0)))
        self.assertEqual(self._rows()["Tile size"], "500 x 500 mm, real size")

    def test_a_preview_without_a_size_is_not_refused(self):
        scenes.add_plane(self._material(metres=0, mode="REAL_SIZE"))
        self.assertIn("enter Tile Size", " ".join(export_notes(strict=False)))

    def test_repeats_of_unknown_size_are_fine_and_said(self):
        scenes.add_plane(self._material(metres=0))
        self.assertEqual(self._notes(), [])
        self.assertEqual(self._rows()["Tile size"], "2 x 2 m, real size unknown")

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
