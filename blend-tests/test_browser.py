"""The pictures of a folder of measurements, made without a window."""

import contextlib
import io
import os
import shutil
from unittest import mock

import bpy

from support import inputs
from support.blender import BlenderTest


class MakeThumbnails(BlenderTest):
    def setUp(self):
        super().setUp()
        cache = mock.patch.dict(os.environ, {"XDG_CACHE_HOME": str(self.folder / "cache")})
        cache.start()
        self.addCleanup(cache.stop)

    def _filled(self):
        made = self.folder / "measurements"
        made.mkdir()
        shutil.copy(inputs.glossy_measurement(), made)
        (made / "brushed.velour").write_bytes(inputs.brushed_model())
        (made / "damaged.bsdf").write_bytes(b"nothing of the kind")
        return made

    def _said(self, **values):
        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            self.assertEqual(bpy.ops.velour.make_thumbnails(**values), {"FINISHED"})
        return said.getvalue()

    def test_pictures_and_what_ails_the_others(self):
        folder = self._filled()
        said = self._said(directory=str(folder))
        self.assertIn("3 files, 2 of them with a thumbnail", said)
        self.assertIn("damaged.bsdf", said)
        self.assertEqual(len(list((self.folder / "cache").rglob("*.npz"))), 2)

    def test_the_folder_of_the_preferences(self):
        browse = inputs.module("operators.browse")
        preferences = browse.addon_preferences(bpy.context)
        self.addCleanup(setattr, preferences, "measurements", "")
        preferences.measurements = str(self._filled())
        self.assertIn("3 files, 2 of them", self._said())

    def test_no_folder_is_a_sentence(self):
        with self.assertRaisesRegex(RuntimeError, "No folder of measurements is chosen"):
            bpy.ops.velour.make_thumbnails()

    def test_a_folder_that_is_gone_is_a_sentence(self):
        said = self._said(directory=str(self.folder / "gone"))
        self.assertIn("gone cannot be read", said)
        self.assertIn("0 files", said)
