"""A job of scripts/farm, and nodes to render its frames on."""

import json
import os
import re
import shutil
from pathlib import Path

import bpy
import numpy as np

from . import inputs, process, scenes
from .blender import BlenderTest, folder

ROOT = Path(__file__).resolve().parents[2]
SECONDS = 120


class FarmTest(BlenderTest):
    """A .blend of three frames whose model is a file beside it, and its job, which nobody has rendered."""

    def setUp(self):
        super().setUp()
        self.shots = self.folder / "a b"  # a blank, as folders of productions have
        shutil.copytree(_prepared(), self.shots)
        self.blend = self.shots / "shot.blend"
        self.output = self.shots / "frames"
        self.edit_job(blend=str(self.blend))

    def farm(self, *arguments, environment=None):
        return _farm(*arguments, environment=environment)

    def node(self, *arguments, environment=None, prefix=()):
        """Runs the frame program as a farm's node does."""
        job = self.output / "farm"
        command = [*prefix, "/usr/bin/python3", job / "frame.pyz", job / "job.json", *arguments]
        return process.run(command, environment, SECONDS)

    def picture(self, frame):
        return self.output / f"shot_{frame:04d}.exr"

    def pictures(self):
        return sorted(path.name for path in self.output.glob("*.exr"))

    def film_end(self, frame):
        """How many samples are kept of a frame that was ended."""
        (film,) = (self.output / f"farm/partial/{frame:04d}/film").glob("*.exr")
        return int(re.search(r"\.0-(\d+)\.exr", film.name)[1])

    def first_sample(self, frame):
        """The first light direction that the latest run of a frame tells in its log; None before that."""
        log = self.output / f"farm/logs/{frame:04d}.log"
        found = re.search(r"Sample (\d+)/", log.read_text()) if log.is_file() else None
        return found and int(found[1]) * bpy.context.scene.velour.split

    def status(self):
        """The exit status, and what is said."""
        done = self.farm("--status", self.output)
        return done.returncode, done.stdout

    def job_of(self, name, samples, *options, time_limit=0):
        """Makes a job with so many samples, whose pictures go to the folder `name`. Returns what is said."""
        bpy.ops.wm.open_mainfile(filepath=str(self.blend))
        settings = bpy.context.scene.velour
        settings.samples, settings.time_limit = samples, time_limit
        return self.save_and_make(name, *options)

    def save_and_make(self, name, *options, status=0):
        """A job whose pictures go to a folder of that name; what is said."""
        bpy.ops.wm.save_mainfile()
        self.output = self.folder / name
        done = self.farm(self.blend, "--no-submit", "--threads", "1", "--output", self.output, *options)
        self.assertEqual(done.returncode, status, done.stdout)
        return done.stdout

    def assert_like_one_run(self, tolerance):
        """The picture of frame 1."""
        images = inputs.native().images
        shared = images.read(self.picture(1))
        self.job_of("whole", bpy.context.scene.velour.samples, "--frames", "1")
        self.assertEqual(self.node("--frames", 1).returncode, 0)
        whole = images.read(self.picture(1))
        self.assertLessEqual(np.abs(shared - whole).max(), tolerance * whole.max())

    def saved_job(self):
        """job.json as it is."""
        return json.loads((self.output / "farm/job.json").read_text())

    def edit_job(self, **changes):
        (self.output / "farm/job.json").write_text(json.dumps({**self.saved_job(), **changes}))

    def another_stage(self, name, file, before, after):
        """Variables for a copy of the staged add-on, in which `file` reads otherwise."""
        stage = self.folder / name
        shutil.copytree(os.environ["VELOUR_STAGE"], stage)
        path = stage / "addons/velour" / file
        text = path.read_text()
        self.assertIn(before, text)
        path.write_text(text.replace(before, after))
        return {"BLENDER_USER_SCRIPTS": str(stage)}


def _farm(*arguments, environment=None):
    command = [ROOT / "scripts/farm", "--blender", bpy.app.binary_path, *arguments]
    return process.run(command, environment, SECONDS)


def _prepared():
    """Made by the first test that asks."""
    shots = folder() / "prepared"
    if not shots.exists():
        shots.mkdir()
        scenes.worn_file(shots / "paint.velour")
        bpy.context.scene.frame_start, bpy.context.scene.frame_end = 1, 3
        blend = str(shots / "shot.blend")
        bpy.ops.wm.save_as_mainfile(filepath=blend)
        bpy.ops.file.make_paths_relative()
        bpy.ops.wm.save_mainfile()
        done = _farm(blend, "--no-submit", "--threads", "1")
        if done.returncode:
            raise RuntimeError(done.stdout)
    return shots
