"""A job of scripts/farm, and nodes to render its frames on."""

import json
import os
import shutil
from pathlib import Path

import bpy

from . import process, scenes
from .blender import BlenderTest

ROOT = Path(__file__).resolve().parents[2]
SECONDS = 120


class FarmTest(BlenderTest):
    """A .blend of three frames whose model is a file beside it."""

    def setUp(self):
        super().setUp()
        # A blank, as folders of productions have.
        self.shots = self.folder / "a b"
        self.shots.mkdir(parents=True)
        scenes.worn_file(self.shots / "paint.velour")
        bpy.context.scene.frame_start, bpy.context.scene.frame_end = 1, 3
        self.blend = self.shots / "shot.blend"
        bpy.ops.wm.save_as_mainfile(filepath=str(self.blend))
        self.output = self.shots / "frames"

    def farm(self, *arguments, environment=None):
        command = [ROOT / "scripts/farm", "--blender", bpy.app.binary_path, *arguments]
        return process.run(command, environment, SECONDS)

    def make(self, *arguments):
        done = self.farm(self.blend, "--no-submit", *arguments)
        self.assertEqual(done.returncode, 0, done.stdout)

    def node(self, *arguments, environment=None, prefix=()):
        """Runs the frame program as a farm's node does."""
        folder = self.output / "farm"
        command = [*prefix, "/usr/bin/python3", folder / "frame.pyz", folder / "job.json", *arguments]
        return process.run(command, environment, SECONDS)

    def picture(self, frame):
        return self.output / f"shot_{frame:04d}.exr"

    def pictures(self):
        return sorted(path.name for path in self.output.glob("*.exr"))

    def status(self):
        """The exit status, and what is said."""
        done = self.farm("--status", self.output)
        return done.returncode, done.stdout

    def edit_job(self, **changes):
        path = self.output / "farm/job.json"
        path.write_text(json.dumps({**json.loads(path.read_text()), **changes}))

    def another_stage(self, name, file="", before="", after=""):
        """Variables for a copy of the staged add-on, in which `file` reads otherwise."""
        stage = self.folder / name
        shutil.copytree(os.environ["VELOUR_STAGE"], stage)
        if file:
            path = stage / "addons/velour" / file
            text = path.read_text()
            self.assertIn(before, text)
            path.write_text(text.replace(before, after))
        return {"BLENDER_USER_SCRIPTS": str(stage)}
