"""Tiles of Blender captured as BTFs."""

import contextlib
import io
import json

import bpy
import numpy as np
from mathutils import Matrix

from support import inputs, scenes
from support.blender import BlenderTest
from support.panels import Layout

_SMALL = {"texels": 4, "views": 6, "lights": 6, "samples": 4, "bounces": 0, "sides": "ONE"}
_COLOR = (0.8, 0.5, 0.2)


class CaptureBtf(BlenderTest):
    def _capture(self, name="tile", **settings):
        """The index of what is captured."""
        path = self.folder / f"{name}.btf"
        arguments = {**_SMALL, "directory": str(path), **settings}
        self.assertEqual(bpy.ops.velour.capture_btf(**arguments), {"FINISHED"})
        return json.loads((path / "btf.json").read_text())

    def _plane(self, **arguments):
        bpy.ops.mesh.primitive_plane_add(**arguments)
        bpy.context.object.data.materials.append(scenes.diffuse_material(_COLOR))
        return bpy.context.object

    def _sawtooth(self):
        """Casts shadows, and looks the same from no other side."""
        mesh = bpy.data.meshes.new("Sawtooth")
        corners = [(0, 0, 0), (0.7, 0, 0.3), (1, 0, 0), (0, 1, 0), (0.7, 1, 0.3), (1, 1, 0)]
        mesh.from_pydata(corners, [], [(0, 1, 4, 3), (1, 2, 5, 4)])
        mesh.materials.append(scenes.diffuse_material(_COLOR))
        obj = bpy.data.objects.new("Sawtooth", mesh)
        bpy.context.scene.collection.objects.link(obj)
        bpy.context.view_layer.objects.active = obj
        return obj

    def _files(self, index):
        return [file["sha256"] for file in index["content"]["files"]]

    def test_a_plane_is_what_the_library_captures_of_it(self):
        self._plane(size=2)
        index = self._capture()
        velour = inputs.native()
        path = self.folder / "native.btf"
        with velour.Scene() as scene:
            corners = np.array([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], np.float32)
            mesh, _ = scene.add_mesh(corners, np.array([(0, 1, 2), (0, 2, 3)], np.uint32))
            paint = scene.add_principled_material(
                base_color=_COLOR, metallic=0.0, roughness=1.0, specular=0.0
            )
            scene.add_instance(mesh, np.eye(4), [paint])
            scene.commit()
            six = velour.directions("6")
            options = {"views": six, "lights": six, "texels": 4, "samples": 4, "bounces": 0, "sides": "one"}
            with velour.capture_job(scene, path, **options) as job:
                job.run()
        other = json.loads((path / "btf.json").read_text())
        self.assertEqual(self._files(index), self._files(other))
        self.assertEqual(len(self._files(index)), 6)

    def test_the_panel_tells_how_many_bytes_it_takes(self):
        self._plane(size=2)
        panel = inputs.module("ui.tile_panel")
        for samples, texels in ((1, 32), (4, 48)):  # smaller ones are heads of files for the most part
            self._capture(f"tile-{samples}", texels=texels, views=8, lights=16, samples=samples)
            written = sum(file.stat().st_size for file in (self.folder / f"tile-{samples}.btf").iterdir())
            told = panel.capture_bytes(bpy.context.object.velour)
            self.assertLess(abs(written / told - 1), 0.1, (written, told))

    def test_an_estimate_before_it_begins(self):
        """By small captures that leave no trace; it is of these settings alone."""
        self._plane(size=2)
        obj = bpy.context.object
        settings, state = obj.velour, bpy.context.window_manager.velour
        settings.texels, settings.views, settings.lights = 16, 8, 20
        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            self.assertEqual(bpy.ops.velour.estimate_capture(), {"FINISHED"})
        self.assertRegex(
            said.getvalue(), r"'Plane': About \d+ seconds, \d+ kB on disk, [\d.]+ kB of additional memory"
        )
        self.assertIn(state.estimate, said.getvalue())
        tiles = inputs.module("operators.tiles")
        self.assertEqual(state.estimated, tiles.captured_as(obj))
        settings.texels = 17
        self.assertNotEqual(state.estimated, tiles.captured_as(obj))
        self.assertEqual(settings.directory, "")

    def test_a_new_folder_leaves_what_is_there(self):
        """Beside it, with a number, by a button of its own."""
        obj = self._plane(size=2)
        first = self._capture()
        for number in (1, 2):
            self.assertEqual(bpy.ops.velour.capture_btf(new_folder=True), {"FINISHED"})
            folder = self.folder / f"tile.{number:03}.btf"
            self.assertEqual(obj.velour.directory, str(folder))
            self.assertEqual(self._files(json.loads((folder / "btf.json").read_text())), self._files(first))
        with self.assertRaisesRegex(RuntimeError, "resume the capture, or choose another folder"):
            bpy.ops.velour.capture_btf()
        panel = inputs.module("ui.tile_panel").VELOUR_OBJECT_PT_tile
        layout = Layout(panel)
        panel.draw(layout, bpy.context)
        buttons = [button for button in layout.operators if button.name == "velour.capture_btf"]
        self.assertEqual([getattr(button, "new_folder", False) for button in buttons], [False, True])

    def test_an_estimate_is_of_the_tile_as_it_was(self):
        self._plane(size=2)
        obj = bpy.context.object
        tiles = inputs.module("operators.tiles")
        told = {tiles.captured_as(obj)}
        for name, value in (("held_out", 64), ("period", (3, 3)), ("use_approximate", True)):
            setattr(obj.velour, name, value)
            told.add(tiles.captured_as(obj))
        self.assertEqual(len(told), 4)
        obj.location.x = 5
        bpy.context.view_layer.update()
        self.assertIn(tiles.captured_as(obj), told)
        modifier = obj.modifiers.new("Finer", "SUBSURF")
        modifier.subdivision_type = "SIMPLE"
        bpy.context.view_layer.update()
        self.assertNotIn(tiles.captured_as(obj), told)

    def test_the_estimate_counts_the_pairs_to_judge_by(self):
        self._plane(size=2)
        settings, state = bpy.context.object.velour, bpy.context.window_manager.velour
        settings.texels, settings.views, settings.lights = 16, 8, 20
        panel, told = inputs.module("ui.tile_panel"), []
        for settings.held_out in (0, 4000):
            self._said(bpy.ops.velour.estimate_capture)
            told.append((state.estimate.split(", ")[1], panel._size(settings)))
        self.assertTrue(told[0][0].endswith("kB on disk"), told)
        self.assertTrue(told[1][0].endswith("MB on disk"), told)
        self.assertNotEqual(told[0][1], told[1][1])

    def _said(self, operator):
        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            self.assertEqual(operator(), {"FINISHED"})
        return said.getvalue()

    def test_a_period_along_one_axis_alone(self):
        """The bounding box tells the other."""
        self._plane(size=2).velour.period = (3, 0)
        np.testing.assert_allclose(self._capture()["tile_metres"], [3, 2], rtol=1e-6)

    def test_size_is_that_of_the_scene_in_metres(self):
        self._plane(size=2)
        bpy.context.scene.unit_settings.scale_length = 0.001
        index = self._capture()
        np.testing.assert_allclose(index["tile_metres"], [0.002, 0.002], rtol=1e-6)
        self.assertEqual(index["texels"], [4, 4])
        self.assertEqual(index["source"], "Plane")

    def test_a_procedural_tile_in_any_unit_is_the_same(self):
        bpy.ops.velour.add_mesostructure(type="GRAVEL", count=3, resolution=8)
        metres = self._capture("metres")
        bpy.context.scene.unit_settings.scale_length = 0.001
        bpy.ops.velour.add_mesostructure(type="GRAVEL", count=3, resolution=8)
        millimeters = self._capture("millimeters")
        np.testing.assert_allclose(metres["tile_metres"], [0.02, 0.02], rtol=1e-6)
        np.testing.assert_allclose(millimeters["tile_metres"], metres["tile_metres"], rtol=1e-6)
        np.testing.assert_allclose(millimeters["shell"]["thickness"], metres["shell"]["thickness"], rtol=1e-5)

    def test_in_the_tile_s_own_axes(self):
        obj = self._sawtooth()
        straight = self._capture("straight")
        obj.matrix_world = Matrix.Translation((8, 0, 0)) @ Matrix.Rotation(np.pi / 2, 4, "Z")
        turned = self._capture("turned")
        np.testing.assert_allclose(straight["tile_metres"], turned["tile_metres"], rtol=1e-6)
        np.testing.assert_allclose(straight["shell"]["thickness"], turned["shell"]["thickness"], rtol=1e-5)
        obj.matrix_world = Matrix()
        self.assertEqual(self._files(self._capture("back")), self._files(straight))

    def test_scale_of_the_object_counts(self):
        self._plane(size=2).scale = (1, 3, 1)
        np.testing.assert_allclose(self._capture()["tile_metres"], [2, 6], rtol=1e-6)

    def test_repeats_are_not_captured(self):
        self._sawtooth()
        alone = self._capture("alone")
        bpy.ops.velour.repeat_tile()
        self.assertEqual(self._files(self._capture("repeated")), self._files(alone))

    def test_a_collection(self):
        for x in (-0.5, 0.5):
            bpy.ops.mesh.primitive_cube_add(size=0.5, location=(x, 0, 0))
        bricks = bpy.data.collections.new("Bricks")
        bpy.context.scene.collection.children.link(bricks)
        for obj in list(bpy.data.objects):
            bricks.objects.link(obj)
        bpy.ops.mesh.primitive_cube_add(size=9)  # not of the tile
        bricks.velour.period = (2, 1)
        index = self._capture(collection="Bricks")
        np.testing.assert_allclose(index["tile_metres"], [2, 1], rtol=1e-6)
        self.assert_close(index["shell"]["thickness"], 0.5, 1e-5)
        self.assertEqual(bricks.velour.texels, 4, "what was given is kept as the tile's settings")

    def test_modifiers_count(self):
        obj = self._plane(size=1)
        modifier = obj.modifiers.new("Thick", "SOLIDIFY")
        modifier.thickness, modifier.offset = 0.25, 0
        self.assert_close(self._capture()["shell"]["thickness"], 0.25, 1e-4)

    def test_over_a_capture_only_to_go_on_with_it(self):
        self._plane()
        first = self._capture()
        with self.assertRaisesRegex(RuntimeError, "tile.btf"):
            self._capture()
        self.assertEqual(self._files(self._capture(resume=True)), self._files(first))

    def test_beside_the_blend(self):
        self._plane()
        bpy.ops.wm.save_as_mainfile(filepath=str(self.folder / "scene.blend"))
        bpy.ops.velour.capture_btf(**_SMALL)
        self.assertTrue((self.folder / "Plane.btf/btf.json").is_file())
        bpy.ops.velour.capture_btf(held_out=3)
        held_out = json.loads((self.folder / "Plane.held-out.btf/btf.json").read_text())
        self.assertEqual(held_out["pairs"], [[0], [1], [2]])
        self.assertEqual(held_out["texels"], [4, 4], "the tile's settings hold for them, too")

    def test_held_out_pairs_leave_the_tile_s_folder_alone(self):
        obj = self._plane()
        self._capture("fitted")
        self.assertEqual(len(self._capture("judges", held_out=2)["views"]), 2)
        self.assertEqual(obj.velour.directory, str(self.folder / "fitted.btf"))


class Refusals(BlenderTest):
    def _refused(self, words, **arguments):
        folder = self.folder / "refused.btf"
        with self.assertRaises(RuntimeError) as caught:
            bpy.ops.velour.capture_btf(**{**_SMALL, "directory": str(folder), **arguments})
        for word in words:
            self.assertIn(word, str(caught.exception))
        self.assertNotIn("Traceback", str(caught.exception))
        self.assertFalse(folder.exists())

    def _glass(self):
        material = bpy.data.materials.new("Glass")
        material.use_nodes = True
        tree = material.node_tree
        glass = tree.nodes.new("ShaderNodeBsdfGlass")
        tree.links.new(glass.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
        scenes.add_plane(material)

    def test_nothing_to_capture(self):
        self._refused(["no active object"])
        self._refused(["Bricks"], collection="Bricks")
        bpy.ops.object.empty_add()
        self._refused(["Empty", "no visible geometry"])

    def test_unsupported_material(self):
        self._glass()
        self._refused(["Material 'Glass'", "transmitted light", "Approximate"])
        path = self.folder / "glass.btf"
        result = bpy.ops.velour.capture_btf(**_SMALL, directory=str(path), use_approximate=True)
        self.assertEqual(result, {"FINISHED"})
        self.assertTrue((path / "btf.json").is_file())

    def _textured(self, sockets, values):
        """A plane of a Principled material with an image at the first of `sockets` that there is."""
        image = bpy.data.images.new("Picture", 2, 2, float_buffer=True)
        image.pixels.foreach_set(np.repeat(np.array(values, np.float32), 4))
        material = bpy.data.materials.new("Painted")
        material.use_nodes = True
        tree = material.node_tree
        texture = tree.nodes.new("ShaderNodeTexImage")
        texture.image = image
        node = tree.nodes["Principled BSDF"]
        socket = next(node.inputs[name] for name in sockets if name in node.inputs)
        tree.links.new(texture.outputs[0], socket)
        if "Emission Strength" in node.inputs:  # 0 in 4.0 and newer
            node.inputs["Emission Strength"].default_value = 1.0
        return scenes.add_plane(material), socket.name

    def test_textures_of_what_is_not_textured_are_named(self):
        for sockets in (("Subsurface Weight", "Subsurface"), ("Anisotropic",)):
            obj, socket = self._textured(sockets, (0.2, 0.4, 0.6, 0.8))
            bpy.context.view_layer.objects.active = obj
            self._refused(["Material 'Painted", f"'{socket}'", "Approximate"])
        for sockets in (("Emission Color", "Emission"), ("Emission Strength",)):
            bpy.context.view_layer.objects.active = self._textured(sockets, (0.2, 0.4, 0.6, 0.8))[0]
            self._refused(["Material 'Painted", "emission", "Approximate"])
        sockets = ("Transmission Weight", "Transmission")
        bpy.context.view_layer.objects.active = self._textured(sockets, (0.2, 0.4, 0.6, 0.8))[0]
        self._refused(["Material 'Painted", "transmitted light", "Approximate"])
        path = self.folder / "approximate.btf"
        arguments = {**_SMALL, "directory": str(path), "use_approximate": True}
        self.assertEqual(bpy.ops.velour.capture_btf(**arguments), {"FINISHED"})

    def test_textured_alpha_is_captured(self):
        hashes = []
        for number, values in enumerate(((1, 1, 1, 1), (0, 1, 1, 0), (0, 0, 0, 0.5))):
            obj, _ = self._textured(("Alpha",), values)
            bpy.context.view_layer.objects.active = obj
            path = self.folder / f"alpha{number}.btf"
            bpy.ops.velour.capture_btf(**_SMALL, directory=str(path))
            index = json.loads((path / "btf.json").read_text())
            hashes.append(tuple(file["sha256"] for file in index["content"]["files"]))
            bpy.data.objects.remove(obj)
        self.assertEqual(len(set(hashes)), 3)

    def test_a_copy_is_not_the_tile(self):
        scenes.add_plane()
        bpy.ops.velour.repeat_tile()
        copy = next(o for o in bpy.data.objects if o.velour.is_repeat)
        bpy.context.view_layer.objects.active = copy
        self._refused(["Plane Repeat", "the tile itself"])
