"""Fit for this scene: a second, smaller model beside the full one, and the frames that may not use it."""

import contextlib
import io
import math
import sys
import unittest.mock

import bpy
import numpy as np

from support import inputs, scenes
from support.blender import run_blender
from support.scene_models import SceneModelTest

WIDTH, HEIGHT = 64, 48
TILT = math.radians(40)


def place_camera(camera, angle):
    """5 m from the origin, `angle` radians off the plane's normal."""
    camera.location = (0, -5 * math.sin(angle), 5 * math.cos(angle))
    camera.rotation_euler = (angle, 0, 0)


class PaintedPlane(SceneModelTest):
    """A glossy plane under a constant world, seen at 30 to 50 degrees."""

    def setUp(self):
        super().setUp()
        self.scene = scenes.use_engine(samples=32, size=WIDTH)
        self.scene.render.resolution_y = HEIGHT
        self.scene.frame_end = 1
        self.camera = scenes.add_camera()
        self.camera.data.angle = math.radians(16)
        place_camera(self.camera, TILT)
        scenes.set_world((0.5, 0.6, 0.7))
        self.obj = scenes.add_plane()
        bpy.ops.velour.load_material(filepath=str(inputs.glossy_measurement()), fit=False)
        self.obj.active_material.name = "Paint"
        self.node.image = self._full_model()

    def _full_model(self):
        """A model of the default tolerance, fitted once and kept."""
        measured = inputs.module("operators.measured")
        data = inputs.full_model_bytes(inputs.glossy_measurement())
        return measured.packed_model(data, "Paint")

    def _add_lamp(self):
        lamp = bpy.data.lights.new("Lamp", "POINT")
        lamp.energy, lamp.shadow_soft_size = 50, 0.0
        obj = bpy.data.objects.new("Lamp", lamp)
        obj.location = (0.3, 0.5, 2)
        self.scene.collection.objects.link(obj)

    def _refused(self, *words, **arguments):
        """... and nothing has changed."""
        before = self._state()
        with self.assertRaises(RuntimeError) as caught:
            bpy.ops.velour.fit_for_scene(material="Paint", **arguments)
        for word in words:
            self.assertIn(word, str(caught.exception))
        self.assertNotIn("Traceback", str(caught.exception))
        self.assertEqual(self._state(), before)

    def _state(self):
        scene = bpy.context.scene
        return (
            [image.name for image in bpy.data.images if image.name != "Render Result"],
            [other.name for other in bpy.data.scenes],
            (scene.frame_current, scene.frame_subframe, scene.render.engine, scene.render.use_compositing),
            (self.settings.use_scene_model, self.settings.scene_model, self.node.image.name),
        )


class Fits(PaintedPlane):
    def test_smaller_model_beside_the_full_one(self):
        full = self.node.image
        self.scene.frame_set(7, subframe=0.25)
        with contextlib.redirect_stdout(io.StringIO()) as said:
            self.assertEqual(bpy.ops.velour.fit_for_scene(), {"FINISHED"})
        self.assertEqual(self.node.image, full)
        self.assertTrue(self.settings.use_scene_model)
        info = self.info(self.settings.scene_model)
        self.assertLess(info["parameter_bytes"], self.info(full)["parameter_bytes"])
        self.assertEqual(info["scene"]["full_parameter_bytes"], self.info(full)["parameter_bytes"])
        self.assertLessEqual(info["scene"]["picture_error"], info["scene"]["full_picture_error"])
        self.assertGreater(info["view_range"][0], 25)
        self.assertLess(info["view_range"][1], 55)
        self.assertEqual(info["scene"]["frames"], 1)
        self.assertEqual((self.scene.frame_current, self.scene.frame_subframe), (7, 0.25))
        self.assertEqual([scene.name for scene in bpy.data.scenes], ["Scene"])
        self.assertIn("observed frame 1 (1/1)", said.getvalue())

    def test_picture_close_to_the_full_one(self):
        bpy.ops.velour.fit_for_scene()
        pixels, said = self.render()
        self.assertIn("rendered with the scene model", said)
        full = self.full_picture()
        self.assertGreater(np.abs(pixels - full).max(), 0, "the full model was rendered")
        np.testing.assert_allclose(scenes.middle(pixels), scenes.middle(full), rtol=0.02)

    def test_keeps_the_outline_of_the_full_model(self):
        bpy.ops.velour.add_mesostructure(type="NET", count=2, resolution=8)
        tile = bpy.context.object
        tile.hide_render = True
        self.scene.render.film_transparent = True
        bpy.ops.velour.fit_for_scene(material="Paint")
        bpy.ops.velour.add_votf(material="Paint", structure=tile.name, texels=32)
        self.assertFalse(self.settings.use_scene_model, "it has no outline")
        full = self.node.image
        bpy.ops.velour.fit_for_scene(material="Paint")
        info = self.info(self.settings.scene_model)
        self.assertLess(info["parameter_bytes"], self.info(full)["parameter_bytes"])
        self.assertEqual(info["shell"], self.info(full)["shell"])
        pixels, said = self.render()
        self.assertIn("rendered with the scene model", said)
        alpha = pixels[..., 3].mean()
        self.assertAlmostEqual(alpha, self.full_picture()[..., 3].mean(), delta=1e-3)

    def test_covers_frames_and_view_layers(self):
        """Frames 1, 3 and 5 of a moving camera, in two view layers of three."""
        self.scene.view_layers.new("Second")
        self.scene.view_layers.new("Idle").use = False
        self.scene.frame_end, self.scene.frame_step = 5, 2
        for frame, angle in ((1, 0.4), (5, 1.0)):
            place_camera(self.camera, angle)
            self.camera.keyframe_insert("location", frame=frame)
            self.camera.keyframe_insert("rotation_euler", frame=frame)
        self.scene.frame_set(3)
        location = self.camera.location.copy()
        bpy.ops.velour.fit_for_scene()
        info = self.info(self.settings.scene_model)
        self.assertEqual(info["scene"]["frames"], 6)
        self.assertLess(info["view_range"][0], math.degrees(0.4))
        self.assertGreater(info["view_range"][1], math.degrees(1.0))
        self.assertEqual(self.camera.location, location, "animated values stay those of the current frame")
        bpy.ops.velour.fit_for_scene(current_frame=True)
        info = self.info(self.settings.scene_model)
        self.assertEqual(info["scene"]["frames"], 2)
        self.assertGreater(info["view_range"][0], math.degrees(0.4))

    def test_covers_what_only_renders_show(self):
        """Another plane, seen flat, hidden in the viewport but not in renders."""
        bpy.ops.velour.fit_for_scene()
        narrow = self.info(self.settings.scene_model)["view_range"][1]
        other = scenes.add_plane(bpy.data.materials["Paint"], size=1.0)
        other.rotation_euler.x = math.radians(-30)
        other.location.z = 0.4
        other.hide_viewport = True
        bpy.ops.velour.fit_for_scene(material="Paint")
        self.assertGreater(self.info(self.settings.scene_model)["view_range"][1], narrow + 10)

    def test_covers_instances(self):
        """An empty that instances a collection outside of the scene."""
        collection = bpy.data.collections.new("Prop")
        tilted = scenes.add_plane(bpy.data.materials["Paint"], size=1.0)
        tilted.rotation_euler.x = math.radians(-30)
        self.scene.collection.objects.unlink(tilted)
        collection.objects.link(tilted)
        empty = bpy.data.objects.new("Empty", None)
        empty.instance_type, empty.instance_collection = "COLLECTION", collection
        empty.location.z = 0.4
        self.scene.collection.objects.link(empty)
        bpy.ops.velour.fit_for_scene(material="Paint")
        self.assertGreater(self.info(self.settings.scene_model)["view_range"][1], 60)

    def test_without_a_window(self):
        """`blender -b` with a script: the report is printed, the .blend keeps both models."""
        blend, script = self.folder / "scene.blend", self.folder / "fit.py"
        bpy.ops.wm.save_as_mainfile(filepath=str(blend))
        script.write_text(
            "import bpy\n"
            "bpy.ops.velour.fit_for_scene(material='Paint', current_frame=True)\n"
            "bpy.ops.wm.save_mainfile()\n"
        )
        child = run_blender(blend, "--python-exit-code", 1, "--python", script)
        self.assertEqual(child.returncode, 0, child.stdout)
        words = r"Fitted 'Paint' for scene 'Scene', 1 frames, in .* image error [0-9]"
        self.assertRegex(child.stdout, words)
        bpy.ops.wm.open_mainfile(filepath=str(blend))
        info = self.info(self.settings.scene_model)
        self.assertLess(info["parameter_bytes"], self.info(self.node.image)["parameter_bytes"])

    def test_save_and_load(self):
        bpy.ops.velour.fit_for_scene()
        both = [bytes(i.packed_file.data) for i in (self.node.image, self.settings.scene_model)]
        blend = self.folder / "scene.blend"
        bpy.ops.wm.save_as_mainfile(filepath=str(blend))
        bpy.ops.wm.open_mainfile(filepath=str(blend))
        self.assertTrue(self.settings.use_scene_model)
        loaded = [bytes(i.packed_file.data) for i in (self.node.image, self.settings.scene_model)]
        self.assertEqual(loaded, both)
        path = self.folder / "small.velour"
        bpy.ops.velour.save_model(material="Paint", filepath=str(path), for_scene=True)
        self.assertEqual(path.read_bytes(), both[1])

    def test_undo(self):
        bpy.context.preferences.edit.use_global_undo = True
        bpy.ops.ed.undo_push(message="before")
        bpy.ops.velour.fit_for_scene()
        bpy.ops.ed.undo_push(message="fit")
        self.settings.use_scene_model = False
        bpy.ops.ed.undo_push(message="switch")
        bpy.ops.ed.undo()
        self.assertTrue(self.settings.use_scene_model)
        bpy.ops.ed.undo()
        self.assertFalse(self.settings.use_scene_model)
        self.assertIsNone(self.settings.scene_model)
        bpy.ops.ed.redo()
        self.assertTrue(self.settings.use_scene_model)
        self.assertIsNotNone(self.settings.scene_model)

    def test_switch_reaches_a_kept_depsgraph(self):
        """With persistent data Blender evaluates only what has changed."""
        self.scene.render.use_persistent_data = True
        bpy.ops.velour.fit_for_scene()
        picture, said = self.render()
        self.assertIn("rendered with the scene model", said)
        self.settings.use_scene_model = False
        self.assertNotIn("Paint", self.render()[1])
        self.settings.use_scene_model = True
        again, said = self.render()
        self.assertIn("rendered with the scene model", said)
        np.testing.assert_array_equal(again, picture)

    def test_a_new_fit_switches_it_off(self):
        bpy.ops.velour.fit_for_scene()
        bpy.ops.velour.fit(tolerance=0.1, max_lobes=3)
        self.assertFalse(self.settings.use_scene_model)
        self.assertIsNotNone(self.settings.scene_model)

    def test_nothing_smaller(self):
        """The library gives the full model back where nothing smaller does: then nothing is kept."""
        model = inputs.native().Model
        info = model.info

        def as_large(self):
            found = info(self)
            if "scene" in found:
                found["parameter_bytes"] = found["scene"]["full_parameter_bytes"]
            return found

        before = self._state()
        with unittest.mock.patch.object(model, "info", as_large):
            self.assertEqual(bpy.ops.velour.fit_for_scene(), {"CANCELLED"})
        self.assertEqual(self._state(), before)


class Frames(PaintedPlane):
    """Frames that show the material otherwise take the full model, bit by bit, and say so."""

    def setUp(self):
        super().setUp()
        bpy.ops.velour.fit_for_scene()

    def _takes_the_full_model(self):
        pixels, said = self.render()
        self.assertRegex(said, r"Material 'Paint', frame 1: .*more than 0\.1%: rendered with the full model")
        np.testing.assert_array_equal(pixels, self.full_picture())

    def test_moved_camera(self):
        place_camera(self.camera, 0.05)
        self._takes_the_full_model()

    def test_strict(self):
        """A frame is refused if its script asks for that and the scene model does not cover it."""
        strict = unittest.mock.patch.object(sys, "argv", ["blender", "--", "--velour-strict-usage"])
        with strict:
            self.assertIn("rendered with the scene model", self.render()[1])
        place_camera(self.camera, 0.05)
        with strict, self.assertRaisesRegex(RuntimeError, "outside its scene model's range.*strict-usage"):
            self.render()

    def test_point_light(self):
        self._add_lamp()
        self._takes_the_full_model()

    def test_brighter_world_is_no_other_light(self):
        """Negative control: the domain is of directions, not of brightness."""
        scenes.set_world((3, 3, 3))
        self.assertIn("rendered with the scene model", self.render()[1])

    def test_order_of_frames(self):
        """Frame 3 alone, and after frames 1 and 2, one of which takes the full model."""
        for frame, angle in ((1, TILT), (2, 0.05), (3, TILT + 0.01)):
            place_camera(self.camera, angle)
            self.camera.keyframe_insert("location", frame=frame)
            self.camera.keyframe_insert("rotation_euler", frame=frame)
        self.scene.frame_set(3)
        alone, said = self.render("alone")
        self.assertIn("rendered with the scene model", said)
        for frame, words in ((1, "rendered with the scene model"), (2, "rendered with the full model")):
            self.scene.frame_set(frame)
            self.assertIn(words, self.render()[1])
        self.scene.frame_set(3)
        np.testing.assert_array_equal(self.render("after")[0], alone)

    def test_render_region_takes_what_the_frame_takes(self):
        """A corner where the plane is seen as before, of a frame with another plane that is not."""
        other = scenes.add_plane(bpy.data.materials["Paint"], size=0.5)
        other.rotation_euler.x = math.radians(-30)
        other.location = (0.4, 0.3, 0.3)
        self._takes_the_full_model()
        render = self.scene.render
        render.use_border, render.border_max_x, render.border_max_y = True, 0.3, 0.3
        self._takes_the_full_model()

    def test_stamp(self):
        pixels_said = self.render()
        self.assertEqual(pixels_said[0].shape[:2], (HEIGHT, WIDTH))
        header = (self.folder / "picture.exr").read_bytes()[:4096]
        self.assertIn(b"velour.ViewLayer.Paint", header)
        self.assertIn(b"rendered with the scene model", header)

    def test_missing_full_model(self):
        place_camera(self.camera, 0.05)
        self.node.image = None
        pixels, said = self.render()
        self.assertIn("the full model is missing", said)
        self.assertGreater(scenes.middle(pixels).min(), 0)

    def test_previews_take_the_full_model(self):
        """The sphere of a preview is seen at every angle."""
        export = inputs.module("export")
        camera = inputs.module("export.camera")
        depsgraph, notes = bpy.context.evaluated_depsgraph_get(), export.Notes()
        view = camera.final_view(depsgraph)
        scene, materials, *_ = export.export_scene(depsgraph, view, notes, strict=False)
        with scene:
            self.assertEqual([entry.has_full for entry in materials.reduced], [True])


class Refusals(PaintedPlane):
    def test_shared_object(self):
        other = bpy.data.scenes.new("Other")
        other.collection.objects.link(self.obj)
        self._refused("Paint", "'Other'")
        self.assertEqual(bpy.ops.velour.fit_for_scene(material="Paint", shared=True), {"FINISHED"})

    def test_shared_through_an_instance(self):
        collection = bpy.data.collections.new("Prop")
        collection.objects.link(self.obj)
        empty = bpy.data.objects.new("Empty", None)
        empty.instance_type, empty.instance_collection = "COLLECTION", collection
        bpy.data.scenes.new("Other").collection.objects.link(empty)
        self._refused("Paint", "'Other'")

    def test_shared_through_geometry_nodes(self):
        tree = bpy.data.node_groups.new("Set", "GeometryNodeTree")
        tree.nodes.new("GeometryNodeSetMaterial").inputs["Material"].default_value = bpy.data.materials[
            "Paint"
        ]
        mesh = bpy.data.objects.new("Plain", bpy.data.meshes.new("Plain"))
        mesh.modifiers.new("Nodes", "NODES").node_group = tree
        bpy.data.scenes.new("Other").collection.objects.link(mesh)
        self._refused("Paint", "'Other'")

    def test_shared_through_an_override(self):
        other = bpy.data.scenes.new("Other")
        other.view_layers[0].material_override = bpy.data.materials["Paint"]
        self._refused("Paint", "'Other'")

    def test_shared_through_a_background_scene(self):
        bpy.data.scenes.new("Other").background_set = self.scene
        self._refused("Paint", "'Other'")

    def test_other_scenes_do_not_matter(self):
        """Negative control."""
        other = bpy.data.scenes.new("Other")
        other.collection.objects.link(bpy.data.objects.new("Plain", self.obj.data.copy()))
        bpy.data.objects["Plain"].data.materials.clear()
        self.assertEqual(bpy.ops.velour.fit_for_scene(material="Paint"), {"FINISHED"})

    def test_not_seen(self):
        self.obj.hide_render = True
        self._refused("Paint", "not visible", "frame 1")

    def test_no_measurement(self):
        self.settings.measurement = None
        self._refused("Paint", "no measurement")

    def test_no_full_model(self):
        self.node.image = None
        with self.assertRaisesRegex(RuntimeError, "no full model"):
            bpy.ops.velour.fit_for_scene(material="Paint")

    def test_no_camera(self):
        self.scene.camera = None
        self._refused("no camera")

    def test_no_view_layer(self):
        self.scene.view_layers[0].use = False
        self._refused("no view layer")

    def test_anisotropic(self):
        self.settings.measurement.filepath = str(inputs.anisotropic_measurement())
        self.settings.measurement.velour.sha256 = ""
        self._refused("Paint", "anisotropic")

    def test_another_measurement(self):
        self.settings.measurement.filepath = str(inputs.lambert_measurement())
        self._refused("Paint", "has changed")
        self.settings.measurement.velour.sha256 = ""
        self._refused("Paint", "not fitted to this measurement")

    def test_missing_measurement(self):
        self.settings.measurement.filepath = str(self.folder / "gone.binary")
        self._refused("gone.binary", "missing")
