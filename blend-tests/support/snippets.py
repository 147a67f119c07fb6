"""Runs what pages show: Python in a Blender of its own, shell in the test's folder."""

import shlex
from pathlib import Path

from . import blender, process

ROOT = Path(__file__).resolve().parents[2]
SECONDS = 120


class SnippetTest(blender.BlenderTest):
    def run_python(self, text):
        path = self.folder / "snippets.py"
        path.write_text(text)
        self._run(blender.child_command("--python-exit-code", "1", "--python", path))

    def run_shell(self, text):
        """What it prints."""
        return self._run(["sh", "-e", "-c", text])

    def _run(self, command):
        done = process.run(["env", "-C", self.folder, *command], seconds=SECONDS)
        self.assertEqual(done.returncode, 0, f"{shlex.join(map(str, command))}\n{done.stdout}")
        return done.stdout
