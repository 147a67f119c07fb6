"""The add-on comes and goes without a trace, with or without a library."""

import subprocess
import unittest

import addon_utils
import bpy

from support.blender import ADDON, BlenderTest, enable_addon, run_blender

# Says what the preferences would show, after the add-on has been enabled.
_SHOW_STATE = (
    "import bpy, importlib; state = importlib.import_module('velour.ui.library_state');"
    " print('STATE', state.problem(), 'END'); print('ENGINE', bpy.types.RenderEngine.__subclasses__())"
)


class Registration(BlenderTest):
    def test_twice(self):
        before = self._traces()
        for _ in range(2):
            addon_utils.disable(ADDON)
            self.assertFalse(hasattr(bpy.types.Scene, "velour"))
            self.assertFalse(hasattr(bpy.types.Image, "velour"))
            self.assertFalse(hasattr(bpy.types, "VELOUR_MATERIAL_PT_measured"))
            self.assertEqual(self._panels(), [])
            enable_addon()
            self.assertEqual(self._traces(), before)

    def test_own_panels_come_back(self):
        """They are asked by their engines whether they are shown: those were lost with the add-on once."""
        before = self._shown_for_engine()
        self.assertIn("VELOUR_RENDER_PT_sampling", before)
        addon_utils.disable(ADDON)
        enable_addon()
        self.assertEqual(self._shown_for_engine(), before)

    def test_stock_panels_are_open(self):
        panels = self._panels()
        for name in (
            "RENDER_PT_output",
            "DATA_PT_lens",
            "DATA_PT_camera_dof",
            "DATA_PT_camera_dof_aperture",
            "EEVEE_MATERIAL_PT_context_material",
        ):
            if hasattr(bpy.types, name):
                self.assertIn(name, panels)
        self.assertNotIn("RENDER_PT_freestyle", panels)
        self.assertNotIn("DATA_PT_light", panels)  # nor where a node editor's panel was made of it

    def test_engine_is_listed(self):
        bpy.context.scene.render.engine = "VELOUR"
        self.assertEqual(bpy.context.scene.render.engine, "VELOUR")

    def test_bl_info_agrees_with_manifest(self):
        module = __import__(ADDON)
        with open(module.__file__.replace("__init__.py", "blender_manifest.toml")) as file:
            version = next(line.split('"')[1] for line in file if line.startswith("version"))
        self.assertEqual(".".join(map(str, module.bl_info["version"])), version)

    def _traces(self):
        return sorted(name for name in dir(bpy.types) if "VELOUR" in name.upper()), self._panels()

    @staticmethod
    def _shown_for_engine():
        panels = [p for p in bpy.types.Panel.__subclasses__() if p.__name__.startswith("VELOUR")]
        return sorted(panel.__name__ for panel in panels if "VELOUR" in getattr(panel, "COMPAT_ENGINES", ()))

    @staticmethod
    def _panels():
        return sorted(
            panel.__name__
            for panel in bpy.types.Panel.__subclasses__()
            if "VELOUR" in getattr(panel, "COMPAT_ENGINES", ()) and not panel.__name__.startswith("VELOUR")
        )


class BadLibrary(BlenderTest):
    """One sentence on the console and in the preferences, no traceback, and a render that refuses."""

    def test_missing(self):
        self._refused(self.folder / "nothing.so", "does not exist")

    def test_foreign(self):
        self._refused(self._built("int answer(void) { return 42; }\n"), "is not a Velour library")

    def test_old(self):
        source = "unsigned vlr_version(void) { return 1; }\nunsigned vlr_abi_version(void) { return 0; }\n"
        self._refused(self._built(source), "is version 0.0.1")

    def test_not_a_library(self):
        path = self.folder / "libvelour.so"
        path.write_bytes(b"\x7fELF but not really")
        self._refused(path, "cannot be loaded")

    def test_works_otherwise(self):
        child = run_blender("--python-expr", _SHOW_STATE)
        self.assertIn("STATE  END", child.stdout)

    def _built(self, source):
        path = self.folder / "libvelour.so"
        command = ["gcc", "-shared", "-fPIC", "-x", "c", "-", "-o", str(path)]
        subprocess.run(command, input=source.encode(), check=True)
        return path

    def _refused(self, library, words):
        picture = self.folder / "picture_####"
        child = run_blender(
            *("--python-expr", _SHOW_STATE, "-E", "VELOUR", "-o", picture, "-F", "PNG", "-f", 1),
            environment={"VELOUR_LIBRARY": str(library)},
        )
        self.assertNotIn("Traceback", child.stdout)
        self.assertIn("VelourRenderEngine", child.stdout)
        for shown in (self._line(child.stdout, "Velour: "), self._line(child.stdout, "STATE ")):
            self.assertIn(words, shown)
            self.assertIn(str(library), shown)
        self.assertEqual(child.returncode, 1, child.stdout)
        self.assertEqual(list(self.folder.glob("picture*")), [])

    @staticmethod
    def _line(text, start):
        return next((line for line in text.splitlines() if line.startswith(start)), "")


if __name__ == "__main__":
    unittest.main()
