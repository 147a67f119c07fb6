"""What the export of a scene says of it."""

import bpy

from support import inputs, scenes
from support.blender import BlenderTest


def export_notes(**options):
    """What the export of the current scene says."""
    export, depsgraph = inputs.module("export"), bpy.context.evaluated_depsgraph_get()
    notes, view = export.Notes(), inputs.module("export.camera").final_view(depsgraph)
    export.export_scene(depsgraph, view, notes, **options)[0].close()
    return list(notes)


class NotesTest(BlenderTest):
    """A scene with a camera and a world, to which tests add what they ask about."""

    def setUp(self):
        super().setUp()
        scenes.use_engine(samples=8, size=8)
        scenes.add_camera()
        scenes.set_world()

    def notes(self):
        return export_notes()

    def assert_said(self, *words):
        notes = self.notes()
        self.assertTrue(any(all(word in note for word in words) for note in notes), notes)
