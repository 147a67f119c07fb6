"""A real Slurm: what is left is submitted, what failed is told, memory and threads are asked for."""

import re
import unittest

from support import slurm
from support.farm import FarmTest


@unittest.skipIf(slurm.why_not(), slurm.why_not())
class FarmSlurm(FarmTest):
    def setUp(self):
        super().setUp()
        self.slurm = slurm.Slurm()
        self.addCleanup(self.slurm.stop)

    def _submit(self, *arguments, status=0):
        """The number of Slurm's job, or None."""
        done = self.farm(self.blend, *arguments, environment=self.slurm.environment)
        self.assertEqual(done.returncode, status, done.stdout)
        found = re.search(r"Slurm's job (\d+);", done.stdout)
        return (found and found[1]), done.stdout

    def _job(self, number):
        """What Slurm knows of it: of the array's first element that it names."""
        return dict(re.findall(r"(\S+?)=(\S*)", self.slurm.run("scontrol", "-o", "show", "job", number)))

    def test_failed_frames_are_told_and_rendered_again(self):
        empty = self.folder / "empty"
        empty.mkdir()
        # Nodes that have no Velour, in the first attempt.
        without = f"--sbatch=--export=ALL,BLENDER_USER_SCRIPTS={empty}"
        number, _ = self._submit("--threads", "1", "--memory", "700M", without)
        job = self._job(number)
        self.assertEqual((job["NumCPUs"], job["MinMemoryNode"]), ("1", "700M"))
        self.slurm.wait_until_empty()
        self.assertEqual(self._job(number)["JobState"], "FAILED")
        status, said = self.status()
        self.assertEqual(status, 1, said)
        self.assertEqual(re.findall(r"frame (\d) failed: .*VELOUR", said), ["1", "2", "3"], said)
        self.assertEqual(self.pictures(), [])

        number, _ = self._submit("--threads", "1", "--memory", "700M")
        self.slurm.wait_until_empty()
        self.assertEqual(self._job(number)["JobState"], "COMPLETED")
        self.assertEqual(self.status(), (0, "3 of 3 frames done, 0 failed, 0 left\n"))

        kept = {frame: self.picture(frame).stat().st_mtime_ns for frame in (1, 3)}
        half = self.picture(2).read_bytes()
        self.picture(2).write_bytes(half[: len(half) // 2])
        number, said = self._submit("--threads", "1", "--memory", "700M")
        self.assertIn("2 of 3 frames done", said)
        self.assertEqual(self._job(number)["ArrayTaskId"], "1")
        self.slurm.wait_until_empty()
        self.assertEqual(self.status()[0], 0)
        self.assertEqual({frame: self.picture(frame).stat().st_mtime_ns for frame in (1, 3)}, kept)
        self.assertEqual(self._submit()[0], None)  # nothing is left

    def test_what_waits_is_not_submitted_again(self):
        number, _ = self._submit("--sbatch=--hold", "--tasks", "2")
        self.assertEqual(self._job(number)["ArrayTaskId"], "0-1")
        _, said = self._submit(status=1)
        self.assertIn(f"Slurm's job {number} still renders this", said)
        _, said = self._submit("--frames", "2", status=1)
        self.assertIn(f"Slurm's job {number} still renders this", said)
        self.assertIn("not done yet: 1-3", self.status()[1])  # the job is the one that waits
        self.slurm.run("scancel", number)
        self.slurm.wait_until_empty()
        self.assertIsNotNone(self._submit("--sbatch=--hold")[0])

    def test_what_slurm_refuses(self):
        _, said = self._submit("--memory", "9T", status=1)
        self.assertIn("sbatch says:", said)
        self.assertIn("Memory", said)
