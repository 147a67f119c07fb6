"""velour-check: trouble with one file stops nothing, and is said in a sentence."""

import unittest

import bpy

from support.check_folder import CheckFolderTest


class Trouble(CheckFolderTest):
    def test_trouble_stops_nothing(self):
        self.save("shot")
        self.update()
        whole = (self.shots / "shot.blend").read_bytes()
        self.save("a_lonely")
        (self.shots / "b_text.blend").write_text("no scene at all\n")
        (self.shots / "c_half.blend").write_bytes(whole[: len(whole) // 2])
        self.scene.render.resolution_x = 50
        self.save("d_wide")
        self.scene.render.resolution_x = 48
        text = bpy.data.texts.new("crash.py")
        text.write("import os, signal\nos.kill(os.getpid(), signal.SIGKILL)\n")
        text.use_module = True
        self.save("e_crash")
        bpy.data.texts.remove(text)
        self.scene.camera = None
        self.save("f_blind")
        self.references("b_text", "c_half", "d_wide", "e_crash", "f_blind")
        status, said, outcomes = self.check("--scripts")
        self.assertEqual(status, 1, said)
        self.assertEqual([name for name, o in outcomes.items() if o["passed"]], ["shot"], said)
        for name, words in _TROUBLE.items():
            for word in words:
                self.assertIn(word, outcomes[name]["sentence"])

    def test_wrong_usage(self):
        for arguments, word, expected in (
            (["--seeds", 1], "--seeds", 2),
            (["--frame", 3], "--update", 2),
            ([], "no .blend", 1),
            ([self.folder / "nothing"], "neither", 1),
        ):
            with self.subTest(arguments):
                if word == "neither":
                    self.save("shot")
                status, said, outcomes = self.check(*arguments)
                self.assertEqual((status, outcomes), (expected, {}), said)
                self.assertIn(word, said)

    def test_strange_folder_is_left_alone(self):
        self.save("shot")
        mine = self.folder / "pictures"
        mine.mkdir()
        (mine / "holiday.png").write_bytes(b"")
        status, said, _ = self.check("--update", "--output", mine)
        self.assertEqual(status, 1)
        self.assertIn("name another --output", said)
        self.assertTrue((mine / "holiday.png").is_file())


_TROUBLE = {
    "a_lonely": ("a_lonely.blend", "no reference", "--update"),
    "b_text": ("b_text.blend", "cannot be opened", "save it again"),
    "c_half": ("c_half.blend", "cannot be opened"),
    "d_wide": ("d_wide.exr", "48 x 32", "50 x 32", "--update"),
    "e_crash": ("e_crash.blend", "Blender crashed"),
    "f_blind": ("f_blind.blend", "amera"),
}


if __name__ == "__main__":
    unittest.main()
