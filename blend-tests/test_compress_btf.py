"""Materials made from BTFs."""

import contextlib
import io
import os
import shutil
import unittest
from unittest import mock

import bpy
import numpy as np

from support import blender, inputs, level, scenes
from support.blender import BlenderTest

_SMALL = {"texels": 16, "views": 24, "lights": 24, "samples": 16, "bounces": 0, "sides": "ONE"}
_SMALLEST = {"texels": 8, "views": 12, "lights": 12}


class CompressBtf(BlenderTest):
    def _captured(self, **settings):
        """The folder of a captured tile, which is the active object. The first test that asks captures it."""
        settings = {**_SMALL, **settings}
        bpy.ops.velour.add_mesostructure(type="CORDUROY", count=2, resolution=8)
        folder, shared = self.folder / "ribs.btf", blender.folder() / f"captured {settings['texels']}.btf"
        if shared.is_dir():
            shutil.copytree(shared, folder)
            bpy.context.object.velour.directory = str(folder)
        else:
            bpy.ops.velour.capture_btf(directory=str(folder), **settings)
            shutil.copytree(folder, shared)
        return folder

    def test_what_was_captured_of_a_tile_becomes_a_packed_model(self):
        self._captured(**_SMALLEST)
        before = {material.name for material in bpy.context.object.data.materials}
        self.assertEqual(bpy.ops.velour.compress_btf(), {"FINISHED"})
        image = scenes.velour_node(bpy.data.materials["ribs"]).image
        self.assertIsNotNone(image.packed_file)
        self.assertEqual(bytes(image.packed_file.data[:4]), b"v/1\x01")
        self.assertTrue(bpy.data.materials["ribs"].use_fake_user)
        self.assertEqual({material.name for material in bpy.context.object.data.materials}, before)

    def test_it_is_named_as_the_folder_where_the_index_in_it_is_named(self):
        """As imports do, and the browser."""
        index = self._captured(**_SMALLEST) / "btf.json"
        bpy.ops.velour.compress_btf(filepath=str(index))
        bpy.ops.velour.load_material(filepath=str(index))
        self.assertLessEqual({"ribs", "ribs.001"}, set(bpy.data.materials.keys()))

    def _estimate(self, **arguments):
        with contextlib.redirect_stdout(io.StringIO()):
            self.assertEqual(bpy.ops.velour.estimate_fit(**arguments), {"FINISHED"})
        return bpy.context.window_manager.velour.fit_estimate

    def test_an_estimate_is_by_the_fits_that_were_made(self):
        folder = self._captured(**_SMALLEST)
        with mock.patch.dict(os.environ, XDG_CACHE_HOME=str(self.folder / "cache")):
            before = self._estimate()
            self.assertIn("no similar fit was made on this computer yet", before)
            self.assertIn("MB of additional memory", before)
            bpy.ops.velour.compress_btf()
            self.assertIn("estimated from one fit on this computer", self._estimate())
            self.assertIn("estimated from one fit on this computer", self._estimate(filepath=str(folder)))
            self.assertIn("no similar fit", self._estimate(method="SVD"))
            self.assertEqual(bpy.context.object.velour.method, "SRBF")  # it was only asked about
            self.assertIn("smallest model within Max Error", self._estimate(tolerance=0.2))
            bpy.ops.velour.compress_btf()
            self.assertIn("estimated from 2 fits on this computer", self._estimate())
        with self.assertRaisesRegex(RuntimeError, "nothing.btf"):
            self._estimate(filepath=str(self.folder / "nothing.btf"))

    @unittest.skipUnless(level.LONG, level.REASON)
    def test_bytes_are_bounded(self):
        self._captured()
        bpy.ops.velour.compress_btf(megabytes=0.02)
        small = scenes.velour_node(bpy.data.materials["ribs"]).image.packed_file.size
        bpy.ops.velour.compress_btf(megabytes=0.06)
        self.assertGreater(
            scenes.velour_node(bpy.data.materials["ribs.001"]).image.packed_file.size, small + 25000
        )

    def _model_info(self, name="ribs"):
        image = scenes.velour_node(bpy.data.materials[name]).image
        with inputs.native().Model.from_bytes(image.packed_file.data, image.name) as model:
            return model.info()

    def test_the_smallest_model_within_an_error(self):
        self._captured(**_SMALLEST)
        tile = bpy.context.object
        bpy.ops.velour.compress_btf(tolerance=0.3, megabytes=0.03)
        info = self._model_info()
        self.assertAlmostEqual(tile.velour.tolerance, 0.3)  # the tile keeps what was given
        self.assertLessEqual(info["relative_l2"], 0.3)
        self.assertEqual(tile.velour.material, bpy.data.materials["ribs"])
        self.assertGreater(len(info["order"]["lobes"]), 3)
        tile.velour.tolerance = 0.2
        bpy.ops.velour.compress_btf()
        closer = self._model_info("ribs.001")
        self.assertLessEqual(closer["relative_l2"], 0.2)
        self.assertGreater(closer["parameter_bytes"], info["parameter_bytes"])

    def test_pairs_to_judge_by_are_captured_beside_the_btf(self):
        bpy.ops.velour.add_mesostructure(type="CORDUROY", count=2, resolution=8)
        bpy.context.object.velour.held_out = 8
        folder = self.folder / "ribs.btf"
        bpy.ops.velour.capture_btf(directory=str(folder), **{**_SMALL, **_SMALLEST})
        self.assertTrue((folder / "btf.json").is_file())
        self.assertTrue((self.folder / "ribs.held-out.btf" / "btf.json").is_file())
        bpy.ops.velour.compress_btf(megabytes=0.005)
        self.assertGreater(self._model_info()["psnr_held_out"], 5)
        # The control: not asked for.
        bpy.context.object.velour.held_out = 0
        bpy.ops.velour.compress_btf(megabytes=0.005)
        self.assertIsNone(self._model_info("ribs.001")["psnr_held_out"])

    def _plane_of_ribs(self):
        """The model's node in a scene that tests share: a plane wears it, not the tile that was captured."""
        shared = blender.folder() / "shared"
        if not shared.is_dir():
            folder, self.folder = self.folder, shared
            shared.mkdir()
            btf = self._captured()
            self.folder = folder
            bpy.data.objects.remove(bpy.context.object)
            scenes.use_engine(size=64)
            scenes.add_plane(size=4)
            bpy.ops.velour.compress_btf(filepath=str(btf), assign=True, megabytes=0.03)
            scenes.set_world()
            scenes.add_camera(ortho_scale=4)
            bpy.ops.wm.save_as_mainfile(filepath=str(shared / "plane.blend"))
        bpy.ops.wm.open_mainfile(filepath=str(shared / "plane.blend"))
        return scenes.velour_node(bpy.data.materials["ribs"])

    def test_the_material_renders_on_another_object_under_its_texture_coordinates(self):
        self._plane_of_ribs()
        self.assertEqual(bpy.context.object.active_material.name, "ribs")
        picture = scenes.render(self.folder)[:, :, :3]
        self.assertGreater(picture.min(), 0.01)
        # One tile covers the plane: its ribs run one way, so only across them is it uneven.
        spread = [picture.mean(axis=axis).std(axis=0).max() for axis in (0, 1)]
        self.assertGreater(max(spread), 5 * min(spread))

    def test_the_btf_itself_renders_in_place_of_its_model(self):
        node = self._plane_of_ribs()
        model = scenes.render(self.folder, "model")[:, :, :3]
        node.velour.use_reference = True
        itself = scenes.render(self.folder, "itself")[:, :, :3]
        self.assertLess(np.abs(model - itself).mean(), 0.1 * itself.mean())  # roots darken
        # The control: the same picture half a rib further on.
        moved = np.maximum(*(np.abs(np.roll(model, 16, axis) - itself).mean() for axis in (0, 1)))
        self.assertGreater(moved, 3 * np.abs(model - itself).mean())

    def test_the_btf_itself_is_placed_as_its_model_is(self):
        node = self._plane_of_ribs()
        node.velour.use_reference = True
        plain = scenes.render(self.folder, "plain")[:, :, :3]
        scenes.set_look(bpy.data.materials["ribs"], rotation=np.pi / 2)
        turned = scenes.render(self.folder, "turned")[:, :, :3]
        node.velour.use_reference = False
        model = scenes.render(self.folder, "model")[:, :, :3]
        self.assertLess(np.abs(model - turned).mean(), 0.1 * turned.mean())
        self.assertGreater(np.abs(model - plain).mean(), 3 * np.abs(model - turned).mean())

    def test_a_btf_that_changed_is_not_rendered_unless_accepted(self):
        folder = self._captured(**_SMALLEST)
        scenes.use_engine(samples=1, size=8)
        scenes.set_world()
        scenes.add_camera()
        bpy.ops.velour.compress_btf(assign=True, megabytes=0.005)
        scenes.velour_node(bpy.data.materials["ribs"]).velour.use_reference = True
        scenes.render(self.folder)
        index = folder / "btf.json"
        index.write_text(index.read_text() + " ")
        with self.assertRaisesRegex(RuntimeError, "has changed"):
            scenes.render(self.folder)
        bpy.ops.velour.accept_file()
        scenes.render(self.folder)
        index.rename(folder / "away.json")
        with self.assertRaisesRegex(RuntimeError, "btf.json.* is missing"):
            scenes.render(self.folder)

    def test_a_btf_is_no_measurement_to_fit(self):
        self._captured(**_SMALLEST)
        bpy.ops.velour.compress_btf(assign=True, megabytes=0.005)
        with self.assertRaisesRegex(RuntimeError, r"btf.json is a BTF.*compress_btf\(material='ribs'\)"):
            bpy.ops.velour.fit()

    def test_the_btf_of_a_material_is_fitted_anew(self):
        """With other settings, which the material keeps; the model before it stays as it was."""
        folder = self._captured(**_SMALLEST)
        bpy.ops.velour.compress_btf(filepath=str(folder), assign=True, megabytes=0.005)
        material, count = bpy.data.materials["ribs"], len(bpy.data.materials)
        node = scenes.velour_node(material)
        before, data = node.image, bytes(node.image.packed_file.data)
        self.assertAlmostEqual(node.velour.btf.megabytes, 0.005)
        bpy.data.objects.remove(bpy.context.object)  # no tile is asked
        self.assertEqual(bpy.ops.velour.compress_btf(material="ribs", method="SVD"), {"FINISHED"})
        self.assertEqual(len(bpy.data.materials), count)
        self.assertNotEqual(node.image, before)
        self.assertEqual(bytes(before.packed_file.data), data)
        self.assertEqual(self._model_info()["method"], "svd")
        self.assertLessEqual(self._model_info()["parameter_bytes"], 5000)  # as it was asked for before
        self.assertEqual(node.velour.btf.method, "SVD")
        sizes = [self._estimate(material="ribs", **size) for size in ({}, {"megabytes": 0.04})]
        self.assertNotEqual(*sizes)
        self.assertAlmostEqual(node.velour.btf.megabytes, 0.005)  # it was only asked about
        # As it is on disk by now.
        index, digest = folder / "btf.json", node.velour.measurement.velour.sha256
        index.write_text(index.read_text() + " ")
        bpy.ops.velour.compress_btf(material="ribs")
        self.assertEqual(self._model_info()["method"], "svd")
        self.assertNotEqual(node.velour.measurement.velour.sha256, digest)
        index.rename(folder / "away.json")
        with self.assertRaisesRegex(RuntimeError, "btf.json.* is missing"):
            bpy.ops.velour.compress_btf(material="ribs")

    def test_a_material_without_a_btf_has_none_to_fit(self):
        material = bpy.data.materials.new("Plain")
        for operator in (bpy.ops.velour.compress_btf, bpy.ops.velour.estimate_fit):
            with self.assertRaisesRegex(RuntimeError, f"{material.name}.*no BTF is chosen"):
                operator(material=material.name)

    def test_what_is_not_a_btf_is_refused_with_its_name(self):
        with self.assertRaisesRegex(RuntimeError, "nowhere.btf"):
            bpy.ops.velour.compress_btf(filepath=str(self.folder / "nowhere.btf"))
        with self.assertRaisesRegex(RuntimeError, "'Plane' has not been captured"):
            bpy.ops.mesh.primitive_plane_add()
            bpy.ops.velour.compress_btf()
        self.assertNotIn("nowhere", bpy.data.materials)

    def test_it_stays_beside_what_is_packed(self):
        """Blender packs the index of a BTF alone; its images stay where they are."""
        self._captured(**_SMALLEST)
        bpy.ops.velour.compress_btf(assign=True, megabytes=0.005)
        bpy.ops.wm.save_as_mainfile(filepath=str(self.folder / "packed.blend"))
        bpy.ops.file.pack_all()
        self.assertEqual(bpy.ops.velour.compress_btf(material="ribs", megabytes=0.005), {"FINISHED"})

    def test_importing_a_btf_makes_a_material_of_it(self):
        path = self._captured(**_SMALLEST)
        bpy.ops.mesh.primitive_cube_add()
        cube = bpy.context.object
        for name in ("Front", "Back"):
            cube.data.materials.append(bpy.data.materials.new(name))
        bpy.ops.mesh.primitive_plane_add()  # another object is active
        self.assertEqual(
            bpy.ops.velour.load_material(filepath=str(path), object=cube.name, slot=1), {"FINISHED"}
        )
        self.assertEqual(cube.material_slots[0].material.name, "Front")
        node = scenes.velour_node(cube.material_slots[1].material)
        self.assertIsNotNone(node.image.packed_file)
        self.assertIsNone(bpy.context.object.active_material)
