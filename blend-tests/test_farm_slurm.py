"""A real Slurm: what is left is submitted, what failed is told, memory and threads are asked for."""

import re
import unittest

import numpy as np

from support import guide, inputs, process, slurm
from support.blender import BlenderTest
from support.farm import ROOT, FarmTest


class SlurmTest(BlenderTest):
    def setUp(self):
        super().setUp()
        self.slurm = slurm.Slurm()
        self.addCleanup(self.slurm.stop)

    def job(self, number):
        """What Slurm knows of it: of the array's first element that it names."""
        return dict(re.findall(r"(\S+?)=(\S*)", self.slurm.run("scontrol", "-o", "show", "job", number)))


@unittest.skipIf(slurm.why_not(), slurm.why_not())
class FarmSlurm(SlurmTest, FarmTest):
    def _submit(self, *arguments, status=0):
        """The number of Slurm's job, or None."""
        done = self.farm(self.blend, *arguments, environment=self.slurm.environment)
        self.assertEqual(done.returncode, status, done.stdout)
        found = re.search(r"Slurm's job (\d+);", done.stdout)
        return (found and found[1]), done.stdout

    def test_failed_frames_are_told_and_rendered_again(self):
        empty = self.folder / "empty"
        empty.mkdir()
        # Nodes that have no Velour, in the first attempt.
        without = f"--sbatch=--export=ALL,BLENDER_USER_SCRIPTS={empty}"
        number, _ = self._submit("--threads", "1", "--memory", "700M", without)
        job = self.job(number)
        self.assertEqual((job["NumCPUs"], job["MinMemoryNode"]), ("1", "700M"))
        self.slurm.wait_until_empty()
        self.assertEqual(self.job(number)["JobState"], "FAILED")
        status, said = self.status()
        self.assertEqual(status, 1, said)
        node = self.slurm.run("sinfo", "-h", "-N", "-o", "%N").strip()
        self.assertEqual(
            re.findall(rf"frame (\d) failed: .*VELOUR.* Node: {node}", said), ["1", "2", "3"], said
        )
        self.assertEqual(self.pictures(), [])

        number, _ = self._submit("--threads", "1", "--memory", "700M")
        self.slurm.wait_until_empty()
        self.assertEqual(self.job(number)["JobState"], "COMPLETED")
        self.assertEqual(self.status(), (0, "3 of 3 frames done, 0 failed, 0 left\n"))

        kept = {frame: self.picture(frame).stat().st_mtime_ns for frame in (1, 3)}
        half = self.picture(2).read_bytes()
        self.picture(2).write_bytes(half[: len(half) // 2])
        number, said = self._submit("--threads", "1", "--memory", "700M")
        self.assertIn("2 of 3 frames done", said)
        self.assertEqual(self.job(number)["ArrayTaskId"], "1")
        self.slurm.wait_until_empty()
        self.assertEqual(self.status()[0], 0)
        self.assertEqual({frame: self.picture(frame).stat().st_mtime_ns for frame in (1, 3)}, kept)
        self.assertEqual(self._submit()[0], None)  # nothing is left

    def _submit_long(self, *options):
        """A job of one frame, which is being rendered."""
        self.job_of("ended", 1500, "--frames", "1")
        again = ("--output", self.output, "--frames", "1", "--threads", "1")
        number, _ = self._submit(*again, *options)
        self.slurm.wait_until(lambda: self.first_sample(1), "no pass is rendered")
        return number, again

    def test_a_frame_that_slurm_ends_goes_on(self):
        """The signal comes as before a time limit: to the batch script alone, which hands it on."""
        number, again = self._submit_long()
        self.slurm.run("scancel", "--signal=TERM", "--batch", f"{number}_0")
        self.slurm.wait_until_empty()
        self.assertEqual(self.job(number)["ExitCode"], "3:0")
        self.assertEqual(self.status(), (3, "not done yet: 1\n0 of 1 frames done, 0 failed, 1 left\n"))
        end = self.film_end(1)
        number, _ = self._submit(*again)
        self.slurm.wait_until_empty()
        self.assertEqual(self.job(number)["ExitCode"], "0:0")
        self.assertEqual(self.status(), (0, "1 of 1 frames done, 0 failed, 0 left\n"))
        self.assertGreaterEqual(self.first_sample(1), end)
        self.assert_like_one_run(0)

    def test_a_frame_that_slurm_puts_back_is_kept(self):
        """As for a more urgent job; it begins the task again after two minutes, which nobody waits for."""
        number, again = self._submit_long("--sbatch=--requeue")
        self.slurm.run("scontrol", "requeue", f"{number}_0")
        self.slurm.wait_until(lambda: self.job(number)["JobState"] == "PENDING", "the task is not put back")
        self.assertGreater(self.film_end(1), 0)
        _, said = self._submit(*again, status=1)
        self.assertIn(f"Slurm's job {number} still renders this", said)

    def test_what_waits_is_not_submitted_again(self):
        number, _ = self._submit("--sbatch=--hold", "--tasks", "2")
        self.assertEqual(self.job(number)["ArrayTaskId"], "0-1")
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


@unittest.skipIf(slurm.why_not(), slurm.why_not())
class StillOnSlurm(SlurmTest):
    """The script of docs/reference/farm.md, of two elements, of one processor each, and a small picture."""

    def setUp(self):
        super().setUp()
        (script,) = (
            t for _, t in guide.snippets(ROOT / "docs/reference/farm.md") if t.startswith("#!/bin/bash")
        )
        few = "--spp 1024 --strategy mis"  # no pilot: the samples begin at once
        for large, small in (("3840x2160", "160x90"), ("--spp 4096", few)):
            self.assertIn(large, script)
            script = script.replace(large, small)
        (self.folder / "still.sh").write_text(script)
        (self.folder / "scripts").mkdir()
        (self.folder / "scripts/velour").symlink_to(ROOT / "scripts/velour")
        (self.folder / "bunny.obj").write_text(inputs.SQUARE)
        (self.folder / "paint.velour").write_bytes(inputs.model_bytes(inputs.glossy_measurement()))
        sky = self.folder / "sky.exr"
        inputs.native().images.write(sky, np.ones((4, 8, 3), np.float32))
        sky.rename(self.folder / "sky.hdr")  # formats are recognized by content

    def _submit(self, elements):
        options = ("--parsable", f"--array={elements}", "--cpus-per-task=1", f"--chdir={self.folder}")
        said = self.slurm.run("sbatch", *options, "--output=%a.txt", self.folder / "still.sh").strip()
        self.assertTrue(said.isdigit(), said)
        return said

    def _begun(self, element):
        log = self.folder / f"{element}.txt"
        return log.is_file() and "Rendering samples" in log.read_text()

    def _velour(self, *arguments):
        done = process.run(["env", "-C", self.folder, "scripts/velour", *arguments, "--quiet"])
        self.assertEqual(done.returncode, 0, done.stdout)

    def test_an_element_that_is_ended_goes_on(self):
        number = self._submit("0-1")
        self.slurm.wait_until(lambda: self._begun(1), "nothing is rendered")
        self.slurm.run("scancel", "--signal=TERM", f"{number}_1")
        self.slurm.wait_until_empty()
        said = (self.folder / "1.txt").read_text()
        self.assertRegex(said, r"1\.unfinished\.exr has samples 512:\d+\. Run the same command again")
        self.assertEqual(self.job(f"{number}_1")["ExitCode"], "3:0")
        self.assertEqual(
            sorted(path.name for path in self.folder.glob("parts/*")), ["0.exr", "1.unfinished.exr"]
        )
        number = self._submit("1")
        self.slurm.wait_until_empty()
        self.assertEqual(self.job(number)["ExitCode"], "0:0")
        self._velour("merge", "parts/0.exr", "parts/1.exr", "-o", "bunny.exr")
        scene = ("--mesh", "bunny.obj", "--material", "paint.velour", "--world", "sky.hdr")
        self._velour("render", *scene, "--size", "160x90", "--spp", 1024, "-o", "whole.exr")
        read = inputs.native().images.read
        merged, whole = read(self.folder / "bunny.exr"), read(self.folder / "whole.exr")
        self.assertLess(np.abs(merged - whole).max() / whole.max(), 1e-6)
