"""From a tile to its material on an object: the steps of the panel, each in its turn."""

import os
from types import SimpleNamespace

import bpy

from support import inputs, scenes
from support.blender import BlenderTest
from support.panels import Layout

_SMALL = {"texels": 8, "views": 12, "lights": 12, "samples": 4, "bounces": 0, "sides": "ONE"}
_TILE = {"type": "CORDUROY", "count": 2, "resolution": 8}


class TileSteps(BlenderTest):
    def setUp(self):
        super().setUp()
        scenes.use_engine()

    def _worn_by_a_cube(self):
        """A tile that was added while a cube was selected; the cube."""
        bpy.ops.mesh.primitive_cube_add()
        cube = bpy.context.object
        bpy.ops.velour.add_mesostructure(**_TILE)
        return cube

    def _steps(self):
        return inputs.module("ui.tile_steps").steps(bpy.context, bpy.context.object)

    def _waiting(self):
        """Names of the steps whose buttons are gray."""
        steps = self._steps()
        return [name for name, step in zip(steps._fields, steps, strict=True) if step.reason]

    def _done(self):
        steps = self._steps()
        return [name for name, step in zip(steps._fields, steps, strict=True) if step.is_done]

    def test_each_step_waits_for_the_one_before(self):
        self._worn_by_a_cube()
        self.assertEqual(self._waiting(), ["material", "outline", "application"])
        self.assertEqual(self._done(), ["tile"])
        bpy.ops.velour.capture_btf(directory=str(self.folder / "ribs.btf"), **_SMALL)
        self.assertEqual(self._waiting(), ["outline", "application"])
        self.assertEqual(self._done(), ["tile", "capture"])
        bpy.ops.velour.compress_btf(megabytes=0.03)
        self.assertEqual(self._waiting(), [])
        self.assertEqual(self._done(), ["tile", "capture", "material"])
        bpy.ops.velour.apply_material()
        self.assertEqual(self._done(), ["tile", "capture", "material", "application"])

    def test_a_capture_that_was_stopped_is_none(self):
        self._worn_by_a_cube()
        folder = self.folder / "ribs.btf"
        folder.mkdir()
        bpy.context.object.velour.directory = str(folder)
        for number, text in enumerate(('{"content": null}', "no JSON", "[]")):
            (folder / "btf.json").write_text(text + number * " ")
            self.assertIn("material", self._waiting(), text)
        (folder / "btf.json").write_text('{"content": {}}')
        self.assertNotIn("material", self._waiting())

    def test_a_tile_without_geometry_waits(self):
        bpy.context.collection.objects.link(
            obj := bpy.data.objects.new("Empty", bpy.data.meshes.new("Empty"))
        )
        bpy.context.view_layer.objects.active = obj
        obj.velour.is_tile = True
        self.assertEqual(self._steps().capture.reason, "The tile has no geometry.")
        self.assertEqual(self._done(), [])

    def test_the_panel_has_a_button_for_each_step(self):
        self._worn_by_a_cube()
        bpy.context.object.velour.directory = str(self.folder / "ribs.btf")
        panel = inputs.module("ui.tile_panel").VELOUR_OBJECT_PT_tile
        layout = Layout(panel)
        panel.draw(layout, bpy.context)
        names = [button.name.partition(".")[2] for button in layout.operators]
        wanted = ["repeat_tile", "capture_btf", "compress_btf", "add_votf", "apply_material"]
        self.assertEqual([name for name in dict.fromkeys(names) if name in wanted], wanted)
        self.assertIn("Capture the tile first.", layout.labels)

    def test_a_capture_of_an_unsaved_file_is_temporary(self):
        self._worn_by_a_cube()
        obj = bpy.context.object
        self.assertTrue(inputs.module("operators.tiles").is_temporary(obj))
        bpy.ops.velour.capture_btf(**_SMALL)
        captured = os.path.join(bpy.app.tempdir, "Corduroy.btf", "btf.json")
        self.assertTrue(os.path.isfile(captured))
        self.assertEqual(obj.velour.directory, "")
        self.assertEqual(bpy.ops.velour.estimate_fit(), {"FINISHED"})  # it finds the capture
        bpy.ops.wm.read_homefile(use_factory_startup=True)
        self.assertFalse(os.path.isfile(captured), "a tile of the same name in the new file would take it")

    def test_a_temporary_capture_serves_in_the_saved_file_until_there_is_another(self):
        tiles = inputs.module("operators.tiles")
        self._worn_by_a_cube()
        obj = bpy.context.object
        bpy.ops.velour.capture_btf(**_SMALL)
        bpy.ops.wm.save_as_mainfile(filepath=str(self.folder / "saved.blend"))
        self.assertTrue(self._steps().capture.is_done)
        self.assertTrue(tiles.is_temporary(obj), "it is deleted with the session")
        bpy.ops.velour.capture_btf(**_SMALL)
        self.assertFalse(tiles.is_temporary(obj))
        self.assertEqual(tiles.capture_folder(obj), str(self.folder / "Corduroy.btf"))
        self.assertTrue(self._steps().capture.is_done)

    def test_a_numbered_folder_of_an_unsaved_file_is_temporary(self):
        self._worn_by_a_cube()
        bpy.ops.velour.capture_btf(**_SMALL)
        bpy.ops.velour.capture_btf(**_SMALL, new_folder=True)
        self.assertTrue(bpy.context.object.velour.directory)
        self.assertTrue(inputs.module("operators.tiles").is_temporary(bpy.context.object))

    def test_the_folder_of_a_linked_tile_is_beside_its_own_file(self):
        tiles, library, shot = (
            inputs.module("operators.tiles"),
            self.folder / "library",
            self.folder / "shots",
        )
        for folder in (library / "ribs.btf", shot):
            folder.mkdir(parents=True)
        self._worn_by_a_cube()
        bpy.ops.wm.save_as_mainfile(filepath=str(library / "cloth.blend"))
        for given in ("//ribs.btf", ""):
            bpy.context.object.velour.directory = given
            bpy.ops.wm.save_mainfile()
            bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
            with bpy.data.libraries.load(str(library / "cloth.blend"), link=True) as (_source, target):
                target.objects = ["Corduroy"]
            (obj,) = target.objects
            wanted = str(library / (given.removeprefix("//") or "Corduroy.btf"))
            self.assertEqual(tiles.output_folder(obj), wanted, "the file is not saved")
            bpy.ops.wm.save_as_mainfile(filepath=str(shot / "shot.blend"))
            self.assertEqual(tiles.capture_folder(obj), wanted)
            (library / "Corduroy.btf").mkdir(exist_ok=True)
            new = SimpleNamespace(owner=obj)
            self.assertEqual(tiles.new_folder(new), "//" + os.path.basename(wanted)[:-4] + ".001.btf")
            bpy.ops.wm.open_mainfile(filepath=str(library / "cloth.blend"))

    def test_no_silhouette_is_taken_for_the_tile_of_a_collection(self):
        button = Layout().operator("velour.add_votf")
        inputs.module("ui.tile_panel")._draw_outline(button, self._worn_by_a_cube(), "Bricks")
        self.assertEqual((button.collection, button.structure), ("Bricks", ""))


class ApplyMaterial(BlenderTest):
    def setUp(self):
        super().setUp()
        bpy.ops.mesh.primitive_cube_add()
        self.cube = bpy.context.object
        bpy.ops.velour.add_mesostructure(**_TILE)
        self.tile = bpy.context.object
        self.cloth = self.tile.velour.material = scenes.diffuse_material()

    def test_the_selected_object_becomes_the_target_of_a_new_tile(self):
        self.assertEqual(self.tile.velour.target, self.cube)
        bpy.ops.velour.add_mesostructure(**_TILE)
        self.assertIsNone(bpy.context.object.velour.target, "a tile is no target")
        bpy.ops.object.select_all(action="DESELECT")
        bpy.ops.velour.add_mesostructure(**_TILE)
        self.assertIsNone(bpy.context.object.velour.target, "nothing was selected")

    def test_the_target_gets_the_material(self):
        before = list(self.tile.data.materials)
        self.assertEqual(bpy.ops.velour.apply_material(), {"FINISHED"})
        self.assertEqual(self.cube.active_material, self.cloth)
        self.assertEqual(list(self.tile.data.materials), before)

    def test_without_a_target_the_other_selected_objects_get_it(self):
        self.tile.velour.target = None
        bpy.ops.object.camera_add()
        bpy.ops.mesh.primitive_plane_add()
        plane = bpy.context.object
        for obj in bpy.context.view_layer.objects:
            obj.select_set(True)
        bpy.context.view_layer.objects.active = self.tile
        before = list(self.tile.data.materials)
        bpy.ops.velour.apply_material()
        self.assertEqual((self.cube.active_material, plane.active_material), (self.cloth,) * 2)
        self.assertEqual(list(self.tile.data.materials), before)

    def test_named(self):
        bpy.ops.mesh.primitive_plane_add()
        plane, other = bpy.context.object, scenes.diffuse_material()
        bpy.ops.velour.apply_material(material=other.name, object=plane.name)
        self.assertEqual(plane.active_material, other)
        self.assertIsNone(self.cube.active_material)

    def test_of_a_collection(self):
        bpy.context.collection.children.link(ribs := bpy.data.collections.new("Ribs"))
        ribs.objects.link(self.tile)
        ribs.velour.material, ribs.velour.target = self.cloth, self.cube
        bpy.context.view_layer.objects.active = self.cube
        bpy.ops.velour.apply_material(collection="Ribs")
        self.assertEqual(self.cube.active_material, self.cloth)

    def test_refused(self):
        with self.assertRaisesRegex(RuntimeError, "no object 'Nothing'"):
            bpy.ops.velour.apply_material(object="Nothing")
        bpy.ops.object.camera_add()
        camera = bpy.context.object.name
        bpy.context.view_layer.objects.active = self.tile
        with self.assertRaisesRegex(RuntimeError, f"'{camera}' cannot have materials"):
            bpy.ops.velour.apply_material(object=camera)
        self.tile.velour.target = None
        bpy.ops.object.select_all(action="DESELECT")
        with self.assertRaisesRegex(RuntimeError, "choose its Target"):
            bpy.ops.velour.apply_material()
        self.tile.velour.material = None
        with self.assertRaisesRegex(RuntimeError, "press Make Material"):
            bpy.ops.velour.apply_material()
        self.assertIsNone(self.cube.active_material)
