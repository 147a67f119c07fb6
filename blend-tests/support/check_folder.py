"""A folder of .blend files, and velour-check run on it as a user does."""

import json
import shutil
from pathlib import Path

import bpy

from . import process, scenes
from .blender import BlenderTest

ROOT = Path(__file__).resolve().parents[2]
SAMPLES = 64


class CheckFolderTest(BlenderTest):
    """A ball under a lamp and a sky."""

    def setUp(self):
        super().setUp()
        self.scene = scenes.use_picture(SAMPLES, 48, 32)
        scenes.add_camera()
        scenes.add_sphere(scenes.diffuse_material((0.8, 0.5, 0.3)))
        scenes.add_plane(size=6).location.z = -1
        lamp = bpy.data.lights.new("Lamp", "AREA")
        lamp.energy, lamp.size = 300, 1
        self.scene.collection.objects.link(bpy.data.objects.new("Lamp", lamp))
        bpy.data.objects["Lamp"].location = (2, 1, 4)
        scenes.set_world(strength=0.4)
        self.shots = self.folder / "my shots"
        self.shots.mkdir()

    def save(self, name):
        bpy.ops.wm.save_as_mainfile(filepath=str(self.shots / f"{name}.blend"), copy=True)

    def references(self, *names):
        """Copies the reference of "shot" to other names."""
        for ending in (".exr", ".error.exr", ".passes.npz"):
            for name in names:
                shutil.copy(self.shots / f"shot{ending}", self.shots / f"{name}{ending}")

    def command(self, *arguments):
        return [ROOT / "scripts/velour-check", self.shots, "--blender", bpy.app.binary_path, *arguments]

    def check(self, *arguments):
        """The exit status, what was said, and outcomes by name."""
        done = process.run(self.command(*arguments))
        report = self.shots / "velour-check/report.json"
        text = report.read_text() if report.is_file() else ""
        outcomes = json.loads(text)["outcomes"] if text else []
        return done.returncode, done.stdout, {outcome["name"]: outcome for outcome in outcomes}

    def update(self, *arguments):
        """Makes references; nothing is there yet that would need approval."""
        status, said, _ = self.check("--update", *arguments)
        self.assertEqual(status, 0, said)
