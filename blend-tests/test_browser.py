"""The pictures of a folder of measurements, made without a window."""

import contextlib
import io
import os
import shutil
from unittest import mock

import bpy
import bpy.utils.previews
import numpy as np

from support import inputs
from support.blender import BlenderTest


class KeptThumbnails(BlenderTest):
    def setUp(self):
        super().setUp()
        self.browser = inputs.module("ui.browser")
        self.addCleanup(self.browser.forget)
        kept = mock.patch.object(self.browser, "_KEPT", 2)
        kept.start()
        self.addCleanup(kept.stop)

    def _show(self, number, pixels, modified=0):
        """Shows a thumbnail of a file; returns the file."""
        file = inputs.module("core.measurement_files").MeasurementFile(f"/{number}", "name", 1, modified)
        made = inputs.module("core.thumbnails").Thumbnail(pixels, {}, None if pixels is not None else "no")
        self.browser._show(file, made)
        return file

    def test_icons_of_the_oldest_are_freed(self):
        pixels, module = np.full((4, 4, 4), 255, np.uint8), bpy.utils.previews._utils_previews
        with mock.patch.object(module, "release", wraps=module.release) as release:
            for number in range(5):
                self._show(number, pixels)
            self.assertEqual((release.call_count, len(self.browser._previews)), (3, 2))

    def test_a_changed_file_keeps_its_icon(self):
        """Its former state is the oldest."""
        pixels = np.full((4, 4, 4), 255, np.uint8)
        self._show("other", pixels)
        self._show("file", pixels)
        now = self._show("file", pixels // 2, modified=1)
        self._show("last", pixels)
        preview = self.browser._previews[str(now)]
        self.assertEqual(preview.icon_id, self.browser.picture(now).icon)
        np.testing.assert_allclose(preview.image_pixels_float[0], 127 / 255, atol=0.01)

    def test_files_without_a_thumbnail(self):
        files = [self._show(number, None) for number in range(3)]
        self.assertIsNone(self.browser.picture(files[0]))
        self.assertEqual(self.browser.picture(files[2]).sentence, "no")


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
