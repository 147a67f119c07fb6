"""Files that Velour has saved: of every release, of a later one, and those that were saved without it."""

import contextlib
import copy
import io
from pathlib import Path
from unittest import mock

import bpy

from support import blender, inputs, saved_settings, scenes
from support.blender import BlenderTest

SCRIPT = Path(saved_settings.__file__)
_SAVE_AGAIN = "import bpy; bpy.ops.wm.open_mainfile(filepath={0!r}); bpy.ops.wm.save_mainfile()"


def _number(release):
    return inputs.module("native.version").packed(tuple(map(int, release.split("."))))


class SavedFilesTest(BlenderTest):
    def setUp(self):
        super().setUp()
        self.blend = self.folder / "saved.blend"

    def stored(self, table, saved_by):
        """A file with those settings, by a Blender that has no Velour; opened. What Velour says of it."""
        written = self.folder / "table.json"
        saved_settings.write(written, table)
        child = blender.run_blender(
            *("--python-exit-code", 1, "--python", SCRIPT, "--", written, self.blend, saved_by), addons=False
        )
        self.assertEqual(child.returncode, 0, child.stdout)
        return self.opened()

    def opened(self):
        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            bpy.ops.wm.open_mainfile(filepath=str(self.blend))
        return said.getvalue()

    def save(self):
        bpy.ops.wm.save_as_mainfile(filepath=str(self.blend))

    @property
    def this(self):
        return _number(inputs.module("native.version").version_text())

    @property
    def table(self):
        path = saved_settings.RELEASES / f"{inputs.module('native.version').version_text()}.json"
        self.assertTrue(path.is_file(), "run scripts/saved_settings")
        return saved_settings.read(path)


class Releases(SavedFilesTest):
    def test_the_table_of_this_version_is_complete(self):
        """What is not in the table could change its meaning unseen: scripts/saved_settings adds it."""
        saved_settings.add_owners()
        now = saved_settings.described()
        self.assertEqual(saved_settings.differences(now, self.table), [], "run scripts/saved_settings")
        self.assertEqual(
            saved_settings.differences(self.table, now), [], "files of this version lose their meaning"
        )

    def test_files_of_each_release_mean_what_they_meant(self):
        tables = sorted(saved_settings.RELEASES.glob("*.json"))
        self.assertTrue(tables)
        for path in tables:
            with self.subTest(release=path.stem):
                table = saved_settings.read(path)
                self.assertGreater(sum(map(len, table.values())), 70)
                self.assertNotIn("Newer", self.stored(table, _number(path.stem)))
                self.assertEqual(saved_settings.wrong_values(table), [])
                saved_settings.add_owners()
                self.assertEqual(saved_settings.differences(table, saved_settings.described()), [])

    def test_other_meanings_are_seen(self):
        """The control: a number, a name, a default and a type that are not what they were."""
        table = copy.deepcopy(self.table)
        numbers = table["Scene"]["strategy"]["numbers"]
        numbers["SRBF"], numbers["PRODUCT"] = numbers["PRODUCT"], numbers["SRBF"]
        table["Scene"]["sample_count"] = table["Scene"].pop("samples")
        table["ShaderNodeTexImage"]["tolerance"]["default"] = 0.05
        table["Object"]["views"]["type"] = "FLOAT"
        saved_settings.add_owners()
        found = saved_settings.differences(table, saved_settings.described())
        self.assertEqual(len(found), 5, found)
        del table["Scene"]["sample_count"]
        self.stored(table, self.this)
        wrong = " ".join(saved_settings.wrong_values(table))
        self.assertIn("strategy is 'SRBF', stored was 'PRODUCT'", wrong)


class WithoutVelour(SavedFilesTest):
    def test_saving_without_it_loses_nothing(self):
        saved_settings.add_owners()
        saved_settings.set_values(self.table)
        material = scenes.measured_material(inputs.model_bytes(inputs.lambert_measurement()))
        material.use_fake_user = True
        model = bytes(scenes.velour_node(material).image.packed_file.data)
        self.save()
        before = self.blend.read_bytes()
        again = _SAVE_AGAIN.format(str(self.blend))
        child = blender.run_blender("--python-exit-code", 1, "--python-expr", again, addons=False)
        self.assertEqual(child.returncode, 0, child.stdout)
        self.assertNotEqual(self.blend.read_bytes(), before)
        self.opened()
        self.assertEqual(saved_settings.wrong_values(self.table), [])
        node = scenes.velour_node(bpy.data.materials["Paint"])
        self.assertEqual(bytes(node.image.packed_file.data), model)
        self.assertEqual(node.texture.velour.saved_by, self.this)


class Stamps(SavedFilesTest):
    def test_what_velour_saves_says_so(self):
        scenes.use_engine()
        material = scenes.measured_material(b"a model, by its looks")
        material.use_fake_user = True
        bpy.data.objects.new("Someone else's", None).use_fake_user = True
        self.save()
        self.opened()
        material = bpy.data.materials["Paint"]
        node = scenes.velour_node(material)
        owners = (bpy.context.scene, node.texture, node.group.node_tree, node.image)
        self.assertEqual([owner.velour.saved_by for owner in owners], [self.this] * 4)
        self.assertFalse(bpy.data.objects["Someone else's"].is_property_set("velour"))

    def test_a_file_of_others_gets_none(self):
        bpy.context.scene.render.engine = "CYCLES"
        self.save()
        self.opened()
        self.assertEqual(bpy.context.scene.velour.saved_by, 0)


class Migrations(SavedFilesTest):
    """Migration from 0.0.9, a release that never existed, whose files counted seeds from one."""

    def setUp(self):
        super().setUp()
        self.calls = []
        migrations = inputs.module("handlers.migrations")
        step = migrations.Step(inputs.module("native.version").VERSION, bpy.types.Scene, self._from_zero)
        patch = mock.patch.object(migrations, "STEPS", [step])
        patch.start()
        self.addCleanup(patch.stop)

    def _from_zero(self, scene):
        self.calls.append(scene.name)
        scene.velour.seed -= 1

    def test_an_older_file_is_brought_up_to_date_once(self):
        self.stored({"Scene": {"seed": {"type": "INT", "saved": 8}}}, 9)
        self.assertEqual((len(self.calls), bpy.context.scene.velour.seed), (1, 7))
        self.save()
        self.opened()
        self.assertEqual((len(self.calls), bpy.context.scene.velour.seed), (1, 7))
        self.assertEqual(bpy.context.scene.velour.saved_by, self.this)

    def test_files_of_this_version_and_unsaved_ones_are_left_alone(self):
        self.stored({"Scene": {"seed": {"type": "INT", "saved": 8}}}, self.this)
        self.assertEqual((self.calls, bpy.context.scene.velour.seed), ([], 8))
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        bpy.context.scene.velour.seed = 5
        self.save()
        self.opened()
        self.assertEqual((self.calls, bpy.context.scene.velour.seed), ([], 5))

    def test_what_is_appended_is_brought_up_to_date_too(self):
        """At once from Blender 4.3 on, before that when the file is saved."""
        self.stored({"Scene": {"seed": {"type": "INT", "saved": 8}}}, 9)
        self.calls.clear()
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        with bpy.data.libraries.load(str(self.blend)) as (_source, target):
            target.scenes = ["Scene"]
        appended = target.scenes[0]
        self.blend = self.folder / "other.blend"
        self.save()
        self.assertEqual((self.calls, appended.velour.seed), ([appended.name], 7))

    def test_a_newer_file_is_told_and_kept(self):
        self.calls.clear()
        later = self.this + 100
        said = self.stored(
            {"Scene": {"seed": {"type": "INT", "saved": 8}, "later": {"type": "INT", "saved": 3}}}, later
        )
        self.assertIn(f"Saved by Velour {inputs.module('native.version').version_text(later)}", said)
        self.assertIn("Update Velour", said)
        self.assertEqual((self.calls, bpy.context.scene.velour.seed), ([], 8))
        self.save()
        self.opened()
        self.assertEqual(bpy.context.scene.velour.saved_by, later)
        self.assertEqual(saved_settings.raw(bpy.context.scene)["velour"]["later"], 3)

    def test_a_newer_patch_is_no_news(self):
        self.assertNotIn(
            "Saved by", self.stored({"Scene": {"seed": {"type": "INT", "saved": 8}}}, self.this + 1)
        )
