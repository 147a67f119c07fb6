"""A measured material in the life of a .blend: the same model, byte for byte, and its settings."""

import shutil
from pathlib import Path

import bpy

from support import inputs, scenes
from support.blender import BlenderTest


class MaterialLife(BlenderTest):
    def setUp(self):
        super().setUp()
        self.data = inputs.model_bytes(inputs.lambert_measurement())
        self.measurement = self.folder / "sample.binary"
        self.measurement.write_bytes(b"only the path matters here")
        self.material = scenes.measured_material(self.data)
        node = scenes.velour_node(self.material)
        node.velour.tolerance = 0.07
        node.velour.kernel = "ABEL_POISSON"
        image = bpy.data.images.new("sample.binary", 1, 1)
        image.source, image.filepath_raw = "FILE", str(self.measurement)
        node.velour.measurement = image
        self.obj = scenes.add_plane(self.material)
        self.blend = self.folder / "scene.blend"

    def _check(self, material):
        node = scenes.velour_node(material)
        self.assertEqual(bytes(node.image.packed_file.data), self.data)
        self.assertEqual(len(node.image.velour.sha256), 64)
        self.assert_close(node.velour.tolerance, 0.07, 1e-6)
        self.assertEqual(node.velour.kernel, "ABEL_POISSON")
        self.assertEqual(self._files().absolute_path(node.velour.measurement), str(self.measurement))

    def _save(self, path=None):
        bpy.ops.wm.save_as_mainfile(filepath=str(path or self.blend), relative_remap=True)

    def test_save_and_reload(self):
        self._save()
        bpy.ops.wm.open_mainfile(filepath=str(self.blend))
        self._check(bpy.data.materials["Paint"])

    def test_unsaved_file(self):
        self.assertEqual(bpy.data.filepath, "")
        self._check(self.material)

    def test_duplicate(self):
        self._check(self.material.copy())

    def test_copy_and_paste(self):
        other = bpy.data.materials.new("Other")
        other.use_nodes = True
        with bpy.context.temp_override(material=self.material):
            self.assertEqual(bpy.ops.material.copy(), {"FINISHED"})
        with bpy.context.temp_override(material=other):
            self.assertEqual(bpy.ops.material.paste(), {"FINISHED"})
        self._check(other)

    def _into_new_file(self, link):
        self._save()
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        with bpy.data.libraries.load(str(self.blend), link=link) as (source, target):
            target.materials = ["Paint"]
            self.assertIn("Paint", source.materials)
        return bpy.data.materials["Paint"]

    def test_append(self):
        self._check(self._into_new_file(link=False))

    def test_link(self):
        material = self._into_new_file(link=True)
        self.assertIsNotNone(material.library)
        self._check(material)

    def test_library_override(self):
        linked = self._into_new_file(link=True)
        material = linked.override_create(remap_local_usages=True)
        self.assertIsNotNone(material.override_library)
        self._check(material)

    def test_linked_model_on_disk(self):
        """A relative path of a linked .blend is relative to that .blend, not to the one that links it."""
        shop = self.folder / "shop"
        shop.mkdir()
        (shop / "paint.velour").write_bytes(self.data)
        bpy.ops.velour.load_material(filepath=str(shop / "paint.velour"), pack=False)
        name = self.obj.active_material.name
        self.blend = shop / "library.blend"
        self._save()
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        with bpy.data.libraries.load(str(self.blend), link=True, relative=False) as (_source, target):
            target.materials = [name]
        self._save(self.folder / "elsewhere.blend")
        image = scenes.velour_node(bpy.data.materials[name]).image
        self.assertTrue(image.filepath.startswith("//"), image.filepath)
        self.assertEqual(self._files().content(image, "Test"), self.data)

    def test_unpack_and_pack(self):
        self._save()
        image = scenes.velour_node(self.material).image
        image.unpack(method="WRITE_LOCAL")
        self.assertIsNone(image.packed_file)
        self.assertEqual(self._files().content(image, "Test"), self.data)
        image.pack()
        self._check(self.material)

    def test_pack_all(self):
        self._save()
        bpy.ops.file.pack_all()
        self._check(self.material)
        measurement = scenes.velour_node(self.material).velour.measurement
        with self._files().StoredFile.of(measurement, "Test").readable_path() as path:
            self.assertEqual(Path(path).read_bytes(), self.measurement.read_bytes())

    def test_make_relative_and_save_elsewhere(self):
        self._save()
        bpy.ops.file.make_paths_relative()
        measurement = scenes.velour_node(self.material).velour.measurement
        self.assertEqual(measurement.filepath, "//sample.binary")
        (self.folder / "deep/er").mkdir(parents=True)
        self._save(self.folder / "deep/er/scene.blend")
        self.assertEqual(measurement.filepath, "//../../sample.binary")
        self._check(self.material)

    def test_moved_project(self):
        self._save()
        bpy.ops.file.make_paths_relative()
        bpy.ops.wm.save_mainfile()
        moved = self.folder.with_name(self.folder.name + "-moved")
        shutil.rmtree(moved, ignore_errors=True)
        shutil.copytree(self.folder, moved)
        self.measurement.unlink()
        bpy.ops.wm.open_mainfile(filepath=str(moved / "scene.blend"))
        self.measurement = moved / "sample.binary"
        self._check(bpy.data.materials["Paint"])
        shutil.rmtree(moved)

    def test_find_missing_files(self):
        self._save()
        (self.folder / "found").mkdir()
        self.measurement.rename(self.folder / "found/sample.binary")
        bpy.ops.file.find_missing_files(directory=str(self.folder / "found"))
        self.measurement = self.folder / "found/sample.binary"
        self._check(self.material)

    def test_listed_by_asset_tracers(self):
        self._save()
        self.assertIn(str(self.measurement), bpy.utils.blend_paths(absolute=True))

    def test_undo_and_redo(self):
        """Fit, undo, redo: the model before comes back exactly, and goes again."""
        bpy.context.preferences.edit.use_global_undo = True
        node = scenes.velour_node(self.material)
        node.velour.measurement.filepath_raw = str(inputs.lambert_measurement())
        bpy.ops.ed.undo_push(message="before")
        bpy.ops.velour.fit(material="Paint", max_lobes=2, tolerance=0.2)
        bpy.ops.ed.undo_push(message="fit")
        fitted = bytes(scenes.velour_node(bpy.data.materials["Paint"]).image.packed_file.data)
        self.assertNotEqual(fitted, self.data)
        bpy.ops.ed.undo()
        node = scenes.velour_node(bpy.data.materials["Paint"])
        self.assertEqual(bytes(node.image.packed_file.data), self.data)
        self.assert_close(node.velour.tolerance, 0.07, 1e-6)
        bpy.ops.ed.redo()
        self.assertEqual(
            bytes(scenes.velour_node(bpy.data.materials["Paint"]).image.packed_file.data), fitted
        )

    def test_animated_setting(self):
        scene = bpy.context.scene
        for frame, seed in ((1, 3), (2, 9)):
            scene.velour.seed = seed
            scene.velour.keyframe_insert("seed", frame=frame)
        scene.frame_set(1)
        self.assertEqual(scene.velour.seed, 3)
        scene.frame_set(2)
        self.assertEqual(scene.velour.seed, 9)

    @staticmethod
    def _files():
        return inputs.module("export.files")
