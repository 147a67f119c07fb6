"""The command line inside Blender, as a script and (4.2 and newer) as a command: verbs, files, exit codes."""

import json
import os
import re
import unittest
from pathlib import Path

import bpy
import numpy as np

from support import blender, inputs, process
from support.blender import BlenderTest

SCRIPT = Path(__file__).resolve().parents[1] / "scripts/velour_in_blender.py"
HAS_COMMANDS = hasattr(bpy.utils, "register_cli_command") and "VELOUR_BPY" not in os.environ
SECONDS = 120
COARSE = ("--texels", 8, "--views", 16, "--lights", 16, "--samples", 1, "--bounces", 0, "--sides", "one")


class AsScript(BlenderTest):
    def _command(self, *arguments):
        before = ("--python-exit-code", 1, "-P", SCRIPT, "--")
        return blender.child_command(*before, *arguments, addons=False)

    def _velour(self, *arguments, status=0):
        done = process.run(self._command(*arguments), seconds=SECONDS)
        self.assertEqual(done.returncode, status, done.stdout)
        self.assertNotIn("Traceback", done.stdout)
        return done.stdout

    def _report(self, *arguments):
        """What lies in --json-file, and has to be in the text of --json."""
        path = self.folder / "report.json"
        said = self._velour(*arguments, "--json", "--json-file", path)
        written = path.read_text()
        path.unlink()
        self.assertIn(written.strip(), said)
        return json.loads(written)

    def _scene(self, model):
        mesh, world = self.folder / "square.obj", self.folder / "sky.exr"
        mesh.write_text(inputs.SQUARE)
        inputs.native().images.write(world, np.ones((4, 8, 3), np.float32))
        return "--mesh", mesh, "--material", model, "--world", world

    def test_of_a_brdf(self):
        measurement, model = inputs.glossy_measurement(), self.folder / "paint.velour"
        fitted = self._report("fit", measurement, "-o", model, "--tolerance", 0.1, "--max-lobes", 3)
        self.assertEqual(fitted["bytes"], model.stat().st_size)
        self.assertEqual(self._report("info", model)["lobes"], fitted["lobes"])
        picture = self.folder / "square.exr"
        rendered = self._report("render", *self._scene(model), "--size", "16x12", "--spp", 8, "-o", picture)
        self.assertEqual(rendered["nan_samples"], 0)
        pixels = inputs.native().images.read(picture)
        self.assertEqual(pixels.shape[:2], (12, 16))
        self.assertGreater(pixels[..., :3].std(), 0.01)  # of the square and the sky

    def test_of_a_btf(self):
        btf, model = self.folder / "weave.btf", self.folder / "weave.velour"
        captured = self._report("capture", "weave", *COARSE, "-o", btf)
        self.assertEqual(captured["pairs"], 256)
        compressed = self._report("compress", btf, "-o", model)
        self.assertEqual(compressed["bytes"], model.stat().st_size)
        self.assertEqual(self._report("info", model)["texels"], [8, 8])

    def test_what_fails(self):
        model = self.folder / "paint.velour"
        said = self._velour("fit", self.folder / "absent.binary", "-o", model, status=1)
        self.assertRegex(said, r"velour: .*absent\.binary.*No such file")
        self.assertFalse(model.exists())

    def test_wrong_usage(self):
        for arguments in ((), ("fits",), ("info",), ("info", "--wrong", "a")):
            with self.subTest(arguments=arguments):
                self.assertIn("usage: velour", self._velour(*arguments, status=2))

    def test_ctrl_c_leaves_nothing(self):
        model, picture = self.folder / "paint.velour", self.folder / "picture.exr"
        model.write_bytes(inputs.model_bytes(inputs.glossy_measurement()))
        options = ("--spp", 1 << 20, "--log-level", "info")
        command = self._command("render", *self._scene(model), *options, "-o", picture)
        status, said, seconds = blender.interrupt(command, after="velour: ")
        self.assertEqual(status, 130, said)
        self.assertIn("velour: Interrupted.", said)
        self.assertLess(seconds, 20)
        self.assertEqual(list(self.folder.glob("picture*")), [])


@unittest.skipUnless(HAS_COMMANDS, "this Blender has no commands of add-ons")
class AsCommand(AsScript):
    def _command(self, *arguments):
        return blender.child_command("--command", "velour", *arguments)

    def test_version(self):
        self.assertTrue(re.search(r"^velour \d+\.\d+\.\d+$", self._velour("--version"), re.MULTILINE))
