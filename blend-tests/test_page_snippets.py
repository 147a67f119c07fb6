"""The blocks of README and docs, but for the guide (test_guide): each runs, or NOT_RUN says why it does not.

They run as they stand, on small inputs. What a verb makes large by itself is made small by options that stand
behind those of the page.
"""

import shutil
import unittest

import bpy
import numpy as np

from support import guide, inputs, level, scenes
from support.snippets import ROOT, SnippetTest

PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
# Blocks that no test here runs, by page and first words, and why.
NOT_RUN = {
    ("README.md", "scripts/demo"): "installs and builds for minutes; the second is what runs this test",
    ("results/chart.md", "scripts/figures"): "takes hours, and Mitsuba",
    ("reference/farm.md", "scripts/farm shot.blend"): "needs Slurm; test_farm_slurm has one of its own",
    (
        "reference/farm.md",
        "BLENDER_USER_SCRIPTS=",
    ): "needs Slurm and a site's folder; test_farm_nodes has such a folder",
    ("reference/farm.md", "curl"): "needs a Flamenco manager; addon/tests/test_farm_jobs.py runs its script",
    ("reference/farm.md", "#!/bin/bash"): "needs Slurm; test_farm_slurm submits it",
    ("engine/regression.md", "scripts/parity"): "test_parity_page runs it",
    ("engine/packaging.md", "scripts/package"): "builds; scripts/test and addon/tests/test_package.py run it",
}
SMALL = """#!/bin/sh
case $1 in
  capture) set -- "$@" --texels 8 --views 16 --lights 16 --samples 1 ;;
  votf) set -- "$@" --texels 16 --check-views 4 ;;
  observe) set -- "$@" --size 32x24 ;;
  render) set -- "$@" --size 32x24 --spp 8 ;;
esac
exec %s "$@" --quiet
"""


def _name(page):
    """The path of a page below docs; two folders have a farm.md."""
    return str(page.relative_to(ROOT / "docs")) if (ROOT / "docs") in page.parents else page.name


def _blocks(page):
    return [(language, text) for language, text in guide.snippets(page) if language in ("sh", "python")]


def _reason(page, text):
    return next(
        (why for (name, first), why in NOT_RUN.items() if name == page and text.startswith(first)), ""
    )


class PageSnippets(SnippetTest):
    def setUp(self):
        super().setUp()
        (self.folder / "scripts").mkdir()
        for name in ("velour-check", "farm"):
            (self.folder / "scripts" / name).symlink_to(ROOT / "scripts" / name)
        small = self.folder / "scripts/velour"
        small.write_text(SMALL % (ROOT / "scripts/velour"))
        small.chmod(0o755)

    def _runnable(self, name):
        page = next(page for page in PAGES if _name(page) == name)
        return [text for _language, text in _blocks(page) if not _reason(name, text)]

    def _inputs(self, *meshes):
        shutil.copy(inputs.glossy_measurement(), self.folder / "paint.binary")
        sky = self.folder / "sky.exr"
        inputs.native().images.write(sky, np.ones((4, 8, 3), np.float32))
        for name in ("sky.hdr", "hall.hdr"):  # formats are recognized by content
            shutil.copy(sky, self.folder / name)
        for name in meshes:
            (self.folder / name).write_text(inputs.SQUARE)

    def _has(self, *names):
        for name in names:
            self.assertGreater((self.folder / name).stat().st_size, 0, name)

    def _shot(self, path, frames=(1, 1)):
        scene = scenes.use_engine(samples=64, size=16)
        scene.frame_start, scene.frame_end = frames
        scenes.add_camera(ortho_scale=1.2)
        scenes.set_world()
        scenes.add_sphere(scenes.measured_material(inputs.model_bytes(inputs.glossy_measurement())))
        bpy.ops.wm.save_as_mainfile(filepath=str(path))

    def test_readme(self):
        self._inputs("bunny.obj")
        for text in self._runnable("README.md"):
            self.run_shell(text)
        self._has("bunny.exr", "weave.velour")

    @unittest.skipUnless(level.LONG, level.REASON)
    def test_for_scene(self):
        self._inputs("table.obj", "far.obj")
        self.run_shell("scripts/velour capture weave --sides one -o weave")
        brdf, btf = self._runnable("engine/scene_usage.md")
        for text, model in ((brdf, "paint.hall.velour"), (btf, "weave.far.velour")):
            self.run_shell(text)
            self._has(model, "frame.exr")
            (self.folder / "frame.exr").unlink()

    @unittest.skipUnless(level.LONG, level.REASON)
    def test_votf(self):
        self._inputs("sphere.obj")
        of_geometry, of_data = self._runnable("engine/votf.md")
        self.run_shell(of_geometry)
        self._has("sphere.exr")
        (self.folder / "net.btf").rename(self.folder / "net.capture")
        (self.folder / "net_votf.velour").unlink()
        self.run_shell(of_data)
        self._has("net_votf.velour")

    @unittest.skipUnless(level.LONG, level.REASON)
    def test_regression(self):
        (self.folder / "shots").mkdir()
        self._shot(self.folder / "shots/paint.blend")
        first, in_ci = self._runnable("engine/regression.md")
        self.run_shell(first)
        self._has("shots/paint.exr", "shots/paint.passes.npz")
        self.run_shell(in_ci)
        self.assertIn('name="paint"', (self.folder / "report.xml").read_text())

    def test_farm(self):
        self._shot(self.folder / "shot.blend", frames=(12, 12))
        part, frame = self._runnable("reference/farm.md")
        self.run_shell(part)
        self.assertTrue(list((self.folder / "films").rglob("*.exr")))
        self.run_shell("scripts/farm shot.blend --no-submit")
        self.run_shell(frame)
        self._has("frames/shot_0012.exr")

    def test_operators(self):
        (place,) = self._runnable("reference/operators.md")
        (self.folder / "weave.velour").write_bytes(inputs.weave_model())
        before = (
            f"import bpy\nbpy.ops.mesh.primitive_plane_add()\nbpy.context.object.name = 'Vase'\n"
            f"bpy.ops.velour.load_material(filepath={str(self.folder / 'weave.velour')!r})\n"
            "material = bpy.context.object.active_material\n"
        )
        self.run_python(before + place)

    def test_no_block_is_left_out(self):
        """Each has a language, and runs in a test of its page or has a reason; no reason is left over."""
        run = {
            "README.md",
            "engine/scene_usage.md",
            "engine/votf.md",
            "engine/regression.md",
            "reference/farm.md",
            "reference/operators.md",
        }
        found, reasons = set(), set()
        for page in set(PAGES) - set(guide.PAGES):
            for language, text in guide.snippets(page):
                self.assertIn(language, {"sh", "python", "text"}, f"{page}: {text}")
            for _language, text in _blocks(page):
                why = _reason(_name(page), text)
                reasons.add(why)
                if not why:
                    found.add(_name(page))
        self.assertEqual(found, run)
        self.assertEqual(reasons - {""}, set(NOT_RUN.values()))
