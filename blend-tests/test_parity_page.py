"""scripts/parity: a page of where Velour and Cycles differ in anybody's files."""

import bpy

from support import process, scenes
from support.check_folder import ROOT, CheckFolderTest


class ParityPage(CheckFolderTest):
    def test_what_is_alike_and_what_is_not(self):
        self.save("alike")
        self._mix_toon()
        inside = self.shots / "more"
        inside.mkdir()
        self.save("more/toon")
        bpy.data.objects.remove(self.scene.camera)
        self.save("blind")
        status, said, outcomes = self.check(
            *("--samples", 32, "--width", 48, "--output", self.shots / "velour-check")
        )
        self.assertEqual(status, 1, said)
        self.assertEqual(
            {name: o["passed"] for name, o in outcomes.items()},
            {
                "alike, direct light": True,
                "alike, 4 bounces": True,
                "more/toon, direct light": False,
                "more/toon, 4 bounces": False,
                "blind": False,
            },
            said,
        )
        self.assertEqual(next(iter(outcomes)), "blind")  # what was not even rendered
        self.assertIn("Cycles: it has no camera; give its scene one.", outcomes["blind"]["sentence"])
        page = (self.shots / "velour-check/index.html").read_text()
        self.assertIn("(Toon BSDF) is not supported; rendered gray.", page)
        self.assertIn("<figcaption>Cycles</figcaption>", page)

    def command(self, *arguments):
        return [ROOT / "scripts/parity", self.shots, "--blender", bpy.app.binary_path, *map(str, arguments)]

    def test_no_files(self):
        done = process.run(self.command("--output", self.shots))
        self.assertEqual(done.returncode, 1)
        self.assertIn("holds no .blend file; name a folder that does.", done.stdout + (done.stderr or ""))

    def _mix_toon(self):
        material = scenes.diffuse_material(name="Toon")
        tree = material.node_tree
        toon = tree.nodes.new("ShaderNodeBsdfToon")
        tree.links.new(toon.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
        for obj in self.scene.objects:
            if obj.type == "MESH":
                obj.data.materials.clear()
                obj.data.materials.append(material)
