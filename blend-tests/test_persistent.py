"""Persistent Data: frames that go on from the one before are those that are exported whole."""

import contextlib
import io
import shutil
from pathlib import Path
from unittest import mock

import bpy
import numpy as np

from support import inputs, scenes
from support.blender import BlenderTest, printed


def _insert_key(tree, path, value, frame):
    """Blender 4.3 inserts none where an add-on's settings of nodes are a group, and follows curves there."""
    if tree.keyframe_insert(path, frame=frame):
        return
    animation = tree.animation_data or tree.animation_data_create()
    animation.action = animation.action or bpy.data.actions.new("Keys")
    curves = animation.action.fcurves
    for index, number in enumerate(np.atleast_1d(value)):
        curve = curves.find(path, index=index) or curves.new(path, index=index)
        curve.keyframe_points.insert(frame, number)


class PersistentData(BlenderTest):
    def setUp(self):
        super().setUp()
        self.scene = scenes.use_engine(samples=8, size=24)
        self.scene.frame_start, self.scene.frame_end = 1, 3
        scenes.add_camera(distance=8.0)
        scenes.set_world((0.5, 0.7, 1.0), 0.4)
        self.still = self._ball("Still", (-2, 0, 0), scenes.diffuse_material((0.8, 0.3, 0.1), "Orange"))
        self.moving = self._ball("Moving", (2, 0, 0), scenes.diffuse_material((0.2, 0.6, 0.3), "Green"))
        self.bending = self._ball("Bending", (0, 0, 2), scenes.diffuse_material((0.6, 0.6, 0.9), "Blue"))
        bpy.ops.object.light_add(type="POINT", location=(0, -5, 4))
        self.lamp = bpy.context.object.data
        self.lamp.energy = 500

    def _ball(self, name, location, material):
        scenes.add_sphere(material)
        ball = bpy.context.object
        ball.name, ball.location = name, location
        return ball

    def _animate(self):
        """Something of each kind that is followed."""
        self._keys(self.moving, "location", (2, 0, 0), (3, 0, 1))
        self.bending.shape_key_add(name="Basis")
        bent = self.bending.shape_key_add(name="Bent")
        for point in bent.data:
            point.co.x *= 2
        self._keys(bent, "value", 0.0, 1.0)
        self._keys(self._color("Orange"), "default_value", (0.8, 0.3, 0.1, 1), (0.1, 0.3, 0.8, 1))
        self._keys(self.lamp, "energy", 500.0, 900.0)
        background = self.scene.world.node_tree.nodes["Background"]
        self._keys(background.inputs["Strength"], "default_value", 0.4, 1.0)
        late = self._ball("Late", (0, 0, -2), bpy.data.materials["Green"])
        self._keys(late, "hide_render", True, False)

    def _keys(self, owner, name, first, last):
        for value, frame in ((first, 1), (last, 3)):
            setattr(owner, name, value)
            owner.keyframe_insert(name, frame=frame)

    def _color(self, material):
        nodes = bpy.data.materials[material].node_tree.nodes
        return next(node for node in nodes if node.type == "BSDF_DIFFUSE").inputs["Color"]

    def _pictures(self, is_persistent):
        """Pictures of all frames, and the objects whose meshes were added in each."""
        self.scene.render.use_persistent_data = is_persistent
        self.scene.render.image_settings.file_format = "OPEN_EXR"
        self.scene.render.image_settings.color_depth = "32"
        pictures, added = [], []
        add = inputs.module("core.mesh_queue").MeshQueue.add

        def watched(queue, arrays, owner):
            added[-1].append(owner)
            return add(queue, arrays, owner)

        with mock.patch.object(inputs.module("core.mesh_queue").MeshQueue, "add", watched):
            for frame in range(self.scene.frame_start, self.scene.frame_end + 1):
                added.append([])
                self.scene.frame_set(frame)
                path = self.folder / f"{is_persistent}-{frame}.exr"
                self.scene.render.filepath = str(path)
                bpy.ops.render.render(write_still=True)
                pictures.append(scenes.read(path))
        return pictures, added

    def _assert_same(self):
        """Frames of a kept scene, beside those that are exported whole; what the former have added."""
        kept, added = self._pictures(True)
        whole, _ = self._pictures(False)
        for ours, truth in zip(kept, whole, strict=True):
            np.testing.assert_array_equal(ours, truth)
        return kept, added

    def test_an_animation(self):
        self._animate()
        pictures, added = self._assert_same()
        self.assertEqual(sorted(added[0]), ["Bending", "Moving", "Still"])
        self.assertEqual(added[1], ["Bending"])
        self.assertEqual(sorted(added[2]), ["Bending", "Late"])
        self.assertGreater(np.abs(pictures[0] - pictures[2]).max(), 0.1)

    def test_the_render_result_is_not_read(self):
        """Blender prints a warning if its color space is read."""
        bpy.ops.render.render()  # creates it
        self.scene.render.use_persistent_data = True
        with printed() as said:
            bpy.ops.render.render()
            self.assertNotIn("ColorManagedInput", said())

    def test_nothing_is_left_of_geometry_that_changes(self):
        self._animate()
        sizes = []
        take = inputs.module("export.scene").SceneExport.take

        def counted(*given):
            exported = take(*given)
            sizes.append(exported.scene.info()["bytes"])
            return exported

        with mock.patch.object(inputs.module("export.scene").SceneExport, "take", counted):
            self._assert_same()
        np.testing.assert_allclose(sizes[:3], sizes[3:], rtol=0.05)

    def test_without_it_all_is_exported_each_time(self):
        _, added = self._pictures(False)
        self.assertEqual([len(names) for names in added], [3, 3, 3])

    def test_edits_between_frames(self):
        self.scene.frame_end = 1
        edits = (
            lambda: setattr(self._color("Green"), "default_value", (0.9, 0.1, 0.1, 1)),
            lambda: setattr(self.still.scale, "z", 2.0),
            lambda: self._ball("New", (0, 0, -2), bpy.data.materials["Blue"]),
            lambda: bpy.data.objects.remove(bpy.data.objects["Bending"]),
            lambda: setattr(self.moving.material_slots[0], "material", bpy.data.materials["Orange"]),
            lambda: setattr(self.scene, "world", None),
        )
        last, _ = self._pictures(True)
        for edit in edits:
            edit()
            now, _ = self._assert_same()
            self.assertGreater(np.abs(now[0] - last[0]).max(), 0.01)
            last = now

    def test_images_that_change(self):
        self.scene.frame_end = 1
        image = bpy.data.images.new("Checks", 4, 4)
        tree = bpy.data.materials["Green"].node_tree
        node = tree.nodes.new("ShaderNodeTexImage")
        node.image = image
        tree.links.new(node.outputs["Color"], self._color("Green"))
        before, _ = self._pictures(True)
        image.pixels = np.tile(np.float32([1, 0, 0, 1]), 16).tolist()
        image.update_tag()
        after, _ = self._assert_same()
        self.assertGreater(np.abs(after[0] - before[0]).max(), 0.01)
        image.colorspace_settings.name = "Non-Color"
        image.pixels = np.tile(np.float32([0.2, 0.5, 0.7, 1]), 16).tolist()
        image.update_tag()
        raw, _ = self._assert_same()
        image.colorspace_settings.name = "sRGB"
        decoded, _ = self._assert_same()
        self.assertGreater(np.abs(raw[0] - decoded[0]).max(), 0.01)

    def _sky(self, name):
        """A world of noise under `name`, whose node it returns, and the path of its file."""
        path = self.folder / name
        noise = np.random.default_rng(3).random((8, 16, 3), np.float32)
        inputs.native().images.write(path, noise)
        tree = self.scene.world.node_tree
        node = tree.nodes.new("ShaderNodeTexEnvironment")
        node.image = bpy.data.images.load(str(path))
        tree.links.new(node.outputs[0], tree.nodes["Background"].inputs["Color"])
        return node, path

    def _sequence(self):
        """A world of two files whose second shows in frames 2 and 3, and its node."""
        node, path = self._sky("sky0001.exr")
        inputs.native().images.write(path.with_name("sky0002.exr"), np.full((8, 16, 3), 2, np.float32))
        node.image.source, node.image_user.frame_duration = "SEQUENCE", 2
        return node

    def _assert_read(self, times):
        """That a kept scene's frames are right, and read their sky so often."""
        kind, read = inputs.module("native").Scene, []

        def watched(name):
            method = getattr(kind, name)
            return mock.patch.object(
                kind, name, lambda *given, **more: (read.append(name), method(*given, **more))[1]
            )

        with watched("set_world_file"), watched("set_world_pixels"):
            kept, _ = self._pictures(True)
            self.assertEqual(len(read), times)
            whole, _ = self._pictures(False)
        self.assertEqual(len(read), times + len(whole))
        for ours, truth in zip(kept, whole, strict=True):
            np.testing.assert_array_equal(ours, truth)
        return kept

    def _turn_sky(self, node):
        tree = self.scene.world.node_tree
        mapping, place = tree.nodes.new("ShaderNodeMapping"), tree.nodes.new("ShaderNodeTexCoord")
        tree.links.new(place.outputs["Generated"], mapping.inputs["Vector"])
        tree.links.new(mapping.outputs[0], node.inputs["Vector"])
        self._keys(mapping.inputs["Rotation"], "default_value", (0, 0, 0), (0, 0, 2))
        self._keys(tree.nodes["Background"].inputs["Strength"], "default_value", 0.4, 1.0)

    def test_a_sky_that_turns_is_read_once(self):
        self._turn_sky(self._sky("sky.exr")[0])
        pictures = self._assert_read(1)
        self.assertGreater(np.abs(pictures[0] - pictures[2]).max(), 0.1)

    def test_a_packed_sky_that_turns_is_read_once(self):
        node, path = self._sky("packed.exr")
        self._turn_sky(node)
        node.image.pack()
        path.unlink()
        self._assert_read(1)

    def test_a_sun_of_a_sky_stays(self):
        """Lamps are added again in each frame, the world is not."""
        sky = inputs.module("export.world.sky")

        def write(path, _values):
            with open(path, "wb") as file:
                np.savez(file, sky=np.full((4, 8, 3), 0.1, np.float16), sun=np.full(3, 4e4))

        self._keys(self.moving, "location", (2, 0, 0), (3, 0, 1))
        tree = self.scene.world.node_tree
        node = tree.nodes.new("ShaderNodeTexSky")
        node.sun_elevation, node.sun_rotation = 0.6, 3.0  # behind the camera
        tree.links.new(node.outputs[0], tree.nodes["Background"].inputs["Color"])
        with (
            mock.patch.object(sky, "cache_folder", return_value=str(self.folder)),
            mock.patch.object(sky, "_start_blender", write),
        ):
            lit, _ = self._assert_same()
            node.sun_disc = False
            with mock.patch.object(sky, "_sun", return_value=None):
                dark, _ = self._assert_same()
        for with_sun, without in zip(lit, dark, strict=True):
            self.assertGreater(with_sun.mean(), without.mean() + 0.01)

    def test_a_sky_that_changes_is_read_anew(self):
        self.scene.frame_end = 1
        node, path = self._sky("changing.exr")
        before = self._assert_read(1)
        inputs.native().images.write(path, np.full((8, 16, 3), 2, np.float32))
        node.image.reload()
        after = self._assert_read(1)
        self.assertGreater(np.abs(after[0] - before[0]).max(), 0.1)

    def test_a_sky_that_is_a_sequence(self):
        self._sequence()
        pictures = self._assert_read(2)
        self.assertGreater(np.abs(pictures[0] - pictures[1]).max(), 0.1)
        np.testing.assert_array_equal(pictures[1], pictures[2])

    def test_a_sky_that_is_painted_is_read_anew(self):
        self.scene.frame_end = 1
        node, _ = self._sky("painted.exr")
        node.image.pack()
        before = self._assert_read(1)
        node.image.pixels = np.tile(np.float32([1, 0, 0, 1]), 128).tolist()
        node.image.update_tag()
        self.scene.world.update_tag()
        after = self._assert_read(1)
        self.assertGreater(np.abs(after[0] - before[0]).max(), 0.1)

    def test_another_model(self):
        """The image of a measured node is of the node alone."""
        self.scene.frame_end = 1
        paint = scenes.measured_material(inputs.model_bytes(inputs.glossy_measurement()))
        other = scenes.measured_material(inputs.model_bytes(inputs.lambert_measurement()), "Other")
        self.still.material_slots[0].material = paint
        before, _ = self._pictures(True)
        scenes.velour_node(paint).image = scenes.velour_node(other).image
        after, _ = self._assert_same()
        self.assertGreater(np.abs(after[0] - before[0]).max(), 0.01)

    def test_a_model_is_read_once(self):
        """A tint, and how a tile lies, say nothing of the files."""
        files, reads = inputs.module("export.files"), []
        weave = scenes.measured_material((Path(__file__).parent / "scenes/data/weave.velour").read_bytes())
        self.still.material_slots[0].material = weave
        node = scenes.velour_node(weave)
        node.velour.placement.repeats = (2, 2)
        for name, values in (
            ("Exposure", (0.0, 2.0)),
            ("Tint", ((1, 1, 1, 1), (1, 0.2, 0.1, 1))),
            ("Rotation", (0.0, 1.0)),
        ):
            path = node.group.inputs[name].path_from_id("default_value")
            for value, frame in zip(values, (1, 3), strict=True):
                node.group.inputs[name].default_value = value
                _insert_key(weave.node_tree, path, value, frame)
        read = files.read_model
        with mock.patch.object(files, "read_model", lambda *given: (reads.append(1), read(*given))[1]):
            kept, _ = self._pictures(True)
        self.assertEqual(len(reads), 1)
        whole, _ = self._pictures(False)
        for ours, truth in zip(kept, whole, strict=True):
            np.testing.assert_array_equal(ours, truth)
        self.assertGreater(np.abs(kept[0] - kept[2]).max(), 0.1)

    def _wear_paint(self):
        """The settings of a measured material that an object is given."""
        paint = scenes.measured_material(inputs.model_bytes(inputs.glossy_measurement()))
        self.still.material_slots[0].material = paint
        return scenes.velour_node(paint).velour

    def test_what_models_are_read_for_is_read(self):
        self.scene.frame_end = 1
        settings = self._wear_paint()
        before, _ = self._pictures(True)
        for name, value in (("roughness", 0.5), ("use_reference", True), ("use_reference", False)):
            if name == "use_reference" and value:
                path = self.folder / "glossy.binary"
                shutil.copy(inputs.glossy_measurement(), path)
                settings.measurement = bpy.data.images.load(str(path))
            if name == "roughness":
                scenes.set_look(bpy.data.materials["Paint"], roughness=value)
            else:
                setattr(settings, name, value)
            after, _ = self._assert_same()
            self.assertGreater(np.abs(after[0] - before[0]).max(), 0.001, name)
            before = after

    def test_a_material_that_is_measured_no_more(self):
        self.scene.frame_end = 1
        self._wear_paint()
        settings = scenes.velour_node(bpy.data.materials["Paint"]).texture.velour
        first, _ = self._pictures(True)
        settings.enabled = False
        plain, _ = self._assert_same()
        settings.enabled = True
        again, _ = self._assert_same()
        np.testing.assert_array_equal(again[0], first[0])
        self.assertGreater(np.abs(plain[0] - first[0]).max(), 0.01)

    def test_another_index(self):
        self.scene.frame_end = 1
        bpy.context.view_layer.use_pass_material_index = True
        show = scenes.composite(self.scene)
        layers = next(node for node in scenes.compositor(self.scene).nodes if node.type == "R_LAYERS")
        show("IndexMA" if "IndexMA" in layers.outputs else "Material Index")
        self._pictures(True)
        bpy.data.materials["Orange"].pass_index = 7
        after, _ = self._assert_same()
        self.assertEqual(after[0][..., 0].max(), 7)

    def test_nothing_is_kept_over_an_undo(self):
        self.scene.frame_end = 1
        self._pictures(True)
        self.assertEqual(self._pictures(True)[1], [[]])
        for handler in bpy.app.handlers.undo_post:
            handler(self.scene, None)
        self.assertEqual(len(self._pictures(True)[1][0]), 3)

    def test_other_passes_begin_anew(self):
        """Meshes of a UV pass have texture coordinates."""
        self.scene.frame_end = 1
        self._pictures(True)
        bpy.context.view_layer.use_pass_uv = True
        self.assertEqual(len(self._pictures(True)[1][0]), 3)

    def test_warnings_are_said_once(self):
        node = bpy.data.materials["Green"].node_tree.nodes.new("ShaderNodeBsdfToon")
        tree = bpy.data.materials["Green"].node_tree
        tree.links.new(node.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
        said = {}
        for is_persistent in (True, False):
            with contextlib.redirect_stdout(io.StringIO()) as out:
                self._pictures(is_persistent)
            said[is_persistent] = out.getvalue().count("is not supported; rendered gray")
        self.assertEqual(said, {True: 1, False: 3})

    def test_a_frame_that_fails_leaves_nothing_behind(self):
        self.scene.frame_end = 1
        self._pictures(True)
        fails = mock.patch.object(inputs.module("engine.final"), "final_view", side_effect=ZeroDivisionError)
        with fails, self.assertRaises(RuntimeError):
            bpy.ops.render.render()
        self.assertEqual(len(self._pictures(True)[1][0]), 3)
