"""Every operator, without a window."""

import contextlib
import hashlib
import io
import shutil
import threading
from unittest import mock

import bpy
from mathutils import Vector
from velour import operators
from velour.export import ExportError
from velour.native import Btf, Measurement, library
from velour.operators import measured
from velour.operators.background_job import BackgroundJob
from velour.operators.fit import VELOUR_OT_fit
from velour.operators.job_target import JobOwner, JobTarget
from velour.operators.reads_first import ReadsFirst
from velour.operators.slots import Slot, SlotTarget, slot_along

from support import inputs, scenes
from support.blender import BlenderTest


def _two_sided_cube():
    """Materials Below and Above, the latter on the face that looks up."""
    bpy.ops.mesh.primitive_cube_add()
    cube = bpy.context.object
    for name in ("Below", "Above"):
        cube.data.materials.append(bpy.data.materials.new(name))
    for polygon in cube.data.polygons:
        polygon.material_index = int(polygon.normal.z > 0.5)
    return cube


class Operators(BlenderTest):
    def setUp(self):
        super().setUp()
        self.obj = scenes.add_plane()
        scenes.use_engine()

    @property
    def material(self):
        return self.obj.active_material

    def test_add_material(self):
        self.assertEqual(bpy.ops.velour.add_material(), {"FINISHED"})
        node = scenes.velour_node(self.material)
        self.assertIsNone(node.image)
        bpy.ops.velour.add_material()
        self.assertEqual(len(self.material.node_tree.nodes), 2, "a second call must not add a second node")

    def test_add_material_to_an_existing_one(self):
        self.obj.active_material = bpy.data.materials.new("Plain")
        bpy.ops.velour.add_material()
        self.assertEqual(self.material.name, "Plain")
        self.assertTrue(scenes.velour_node(self.material).texture.velour.enabled)

    def test_load_measurement_and_fit(self):
        path = inputs.glossy_measurement()
        bpy.ops.velour.load_material(filepath=str(path), fit=False)
        node = scenes.velour_node(self.material)
        self.assertEqual(bpy.path.abspath(node.velour.measurement.filepath), str(path))
        self.assertEqual(len(node.velour.measurement.velour.sha256), 64)
        self.assertIsNone(node.velour.measurement.packed_file)
        self.assertEqual(bpy.ops.velour.fit(tolerance=0.1, max_lobes=3, kernel="GAUSSIAN"), {"FINISHED"})
        node = scenes.velour_node(self.material)
        self.assert_close(node.velour.tolerance, 0.1, 1e-6)
        self.assertEqual(node.velour.max_lobes, 3)
        self._check_model(node.image)

    def test_fit_reads_the_measurement_in_a_job(self):
        """However large it is, the window stays usable. A content that has changed is fitted as it is."""
        path = self.folder / "paint.exr"
        path.write_bytes(inputs.glossy_measurement().read_bytes())
        bpy.ops.velour.load_material(filepath=str(path), fit=False)
        measurement = scenes.velour_node(self.material).velour.measurement
        measurement.velour.sha256 = "0" * 64
        with mock.patch.object(Measurement, "load", side_effect=AssertionError("read at once")):
            self.assertEqual(bpy.ops.velour.fit(tolerance=0.1, max_lobes=3), {"FINISHED"})
        self.assertEqual(measurement.velour.sha256, hashlib.sha256(path.read_bytes()).hexdigest())
        path.write_bytes(b"no measurement")
        with self.assertRaisesRegex(RuntimeError, f"Material '{self.material.name}': .*paint.exr"):
            bpy.ops.velour.fit()

    def test_fit_of_each_kind_of_model(self):
        bpy.ops.velour.load_material(filepath=str(inputs.glossy_measurement()), fit=False)
        self.assertEqual(scenes.velour_node(self.material).velour.model, "PARAMETRIC")
        kernels = {"SCATTERED": "abel-poisson", "PARAMETRIC": "gaussian"}  # the latter has no other
        scenes.velour_node(self.material).velour.kernel = "ABEL_POISSON"
        for model, kernel in kernels.items():
            self.assertEqual(bpy.ops.velour.fit(model=model, tolerance=0.1, max_lobes=3), {"FINISHED"})
            node = scenes.velour_node(self.material)
            self.assertEqual((node.velour.model, node.velour.kernel), (model, "ABEL_POISSON"))
            info = self._info(node.image)
            self.assertEqual((info["model"], info["kernel"]), (model.lower(), kernel))
            self.assertIsNotNone(info["order"]["chosen"])

    def test_fit_of_a_reciprocal_model_that_gives_no_more_than_it_gets(self):
        bpy.ops.velour.load_material(filepath=str(inputs.glossy_measurement()), fit=False)
        settings = scenes.velour_node(self.material).velour
        settings.use_limit_albedo = settings.use_symmetric = True
        self.assertEqual(bpy.ops.velour.fit(tolerance=0.1), {"FINISHED"})
        info = self._info(scenes.velour_node(self.material).image)
        self.assertTrue(info["symmetric"])
        self.assertLess(info["reciprocity"], 1e-4)
        self.assertLessEqual(info["albedo_max"], 1)

    def test_fit_keeps_the_model_before(self):
        bpy.ops.velour.load_material(filepath=str(inputs.lambert_measurement()), fit=False)
        bpy.ops.velour.fit(tolerance=0.1, max_lobes=3)
        first = scenes.velour_node(self.material).image
        data, name = bytes(first.packed_file.data), first.name
        bpy.ops.velour.fit(tolerance=0.1, max_lobes=4)
        second = scenes.velour_node(self.material).image
        self.assertNotEqual(second.name, name)
        self.assertEqual(bytes(bpy.data.images[name].packed_file.data), data)

    def test_fit_by_name(self):
        bpy.ops.velour.load_material(filepath=str(inputs.glossy_measurement()), fit=False)
        name = self.material.name
        self.obj.active_material = None
        bpy.ops.velour.fit(material=name, tolerance=0.1, max_lobes=3)
        self._check_model(scenes.velour_node(bpy.data.materials[name]).image)

    def test_load_model_packed_and_linked(self):
        data = inputs.model_bytes(inputs.lambert_measurement())
        path = self.folder / "paint.velour"
        path.write_bytes(data)
        bpy.ops.velour.load_material(filepath=str(path))
        image = scenes.velour_node(self.material).image
        self.assertEqual(bytes(image.packed_file.data), data)
        bpy.ops.velour.load_material(filepath=str(path), pack=False)
        image = scenes.velour_node(self.material).image
        self.assertIsNone(image.packed_file)
        self.assertEqual(bpy.path.abspath(image.filepath), str(path))

    def test_load_several(self):
        names = [inputs.lambert_measurement().name, inputs.glossy_measurement().name]
        folder = str(inputs.glossy_measurement().parent)
        bpy.ops.velour.load_material(directory=folder, files=[{"name": name} for name in names], fit=False)
        stems = {name.removesuffix(".binary") for name in names}
        self.assertTrue(stems <= {material.name for material in bpy.data.materials})
        self.assertIn(self.material.name, stems)

    def test_load_reads_beside_the_window(self):
        """The same without a window, where the operator waits for it: no file is read by the main thread."""
        threads, read = set(), library.file_info

        def noted(path):
            threads.add(threading.current_thread())
            return read(path)

        with mock.patch.object(library, "file_info", noted):
            bpy.ops.velour.load_material(filepath=str(inputs.lambert_measurement()), fit=False)
        self.assertEqual(len(threads), 1)
        self.assertNotIn(threading.main_thread(), threads)

    def test_a_btf_is_opened_beside_the_window(self):
        """By a job that says what is wrong with it."""
        path, threads = self.folder / "cloth.btf", set()
        path.write_bytes(b"no BTF")

        def noted(*arguments, load=Btf.load):
            threads.add(threading.current_thread())
            return load(*arguments)

        with (
            mock.patch.object(Btf, "load", noted),
            self.assertRaisesRegex(RuntimeError, "cloth.btf: is not a BTF"),
        ):
            bpy.ops.velour.compress_btf(filepath=str(path))
        self.assertEqual(len(threads), 1)
        self.assertNotIn(threading.main_thread(), threads)

    def test_load_into_a_named_slot(self):
        cube, path = _two_sided_cube(), inputs.lambert_measurement()
        with bpy.context.temp_override(object=self.obj, active_object=self.obj):
            bpy.ops.velour.load_material(filepath=str(path), fit=False, object=cube.name, slot=1)
        self.assertEqual(cube.material_slots[0].material.name, "Below")
        self.assertIsNotNone(scenes.velour_node(cube.material_slots[1].material).velour.measurement)
        self.assertIsNone(self.material)

    def test_load_without_a_slot_keeps_the_material(self):
        bpy.ops.velour.load_material(filepath=str(inputs.lambert_measurement()), fit=False, assign=False)
        self.assertIsNone(self.material)
        self.assertTrue(bpy.data.materials[inputs.lambert_measurement().stem].use_fake_user)

    def test_load_where_nothing_takes_a_material_says_so(self):
        path, said = inputs.lambert_measurement(), io.StringIO()
        bpy.ops.object.light_add(type="POINT")
        name = bpy.context.object.name
        with contextlib.redirect_stdout(said):
            bpy.ops.velour.load_material(filepath=str(path), fit=False)
        self.assertTrue(bpy.data.materials[path.stem].use_fake_user)
        sentence = f"Object '{name}' cannot have materials; material '{path.stem}' is kept without an object"
        self.assertIn(sentence, said.getvalue())
        bpy.context.view_layer.objects.active = None
        with contextlib.redirect_stdout(said):
            bpy.ops.velour.load_material(filepath=str(path), fit=False)
        self.assertIn("There is no active object; material", said.getvalue())

    def test_a_slot_is_that_of_the_face_that_is_met(self):
        cube = _two_sided_cube()
        cube.modifiers.new("Array", "ARRAY").relative_offset_displace = (3, 0, 0)
        bpy.context.view_layer.update()
        for x in (0, 6):  # the second is made by the modifier
            found = [
                slot_along(bpy.context, Vector((x, 0, side * 9)), Vector((0, 0, -side))) for side in (1, -1)
            ]
            self.assertEqual(found, [(cube.name, 1), (cube.name, 0)])
        self.assertIsNone(slot_along(bpy.context, Vector((50, 0, 9)), Vector((0, 0, -1))))

    def _refused(self, *words, operator=bpy.ops.velour.load_material, **arguments):
        """The sentences, all in one report."""
        with self.assertRaises(RuntimeError) as caught:
            operator(**arguments)
        for word in words:
            self.assertIn(word, str(caught.exception))
        return str(caught.exception)

    def test_files_that_are_none_are_no_matter_to_the_others(self):
        """They are named in one report, and leave nothing behind."""
        folder, good = self.folder, inputs.lambert_measurement()
        shutil.copy(good, folder / "good.binary")
        (folder / "noise.bsdf").write_bytes(bytes(range(256)) * 40)
        names = ("noise.bsdf", "good.binary", "nothing.binary")
        said = self._refused(
            "2 of 3 files were not imported.",
            "noise.bsdf",
            "nothing.binary",
            directory=str(folder),
            files=[{"name": name} for name in names],
            fit=False,
        )
        self.assertNotIn("good", said)
        self.assertEqual(self.material.name, "good")
        self.assertEqual({material.name for material in bpy.data.materials}, {"good"})

    def test_files_that_are_all_none_leave_nothing_behind(self):
        names = ("one.binary", "two.velour")
        said = self._refused(
            *names, directory=str(self.folder), files=[{"name": name} for name in names], fit=False
        )
        self.assertNotIn("left out", said)
        self.assertEqual(len(bpy.data.materials), 0)
        self.assertFalse(self.obj.velour.is_property_set("jobs"))

    def test_an_import_that_makes_no_material_tells_of_none(self):
        bpy.context.view_layer.objects.active = None
        for name, is_told in (("nothing.binary", False), ("good.binary", True)):
            shutil.copy(inputs.lambert_measurement(), self.folder / "good.binary")
            said = io.StringIO()
            with contextlib.redirect_stdout(said), contextlib.suppress(RuntimeError):
                bpy.ops.velour.load_material(filepath=str(self.folder / name), fit=False)
            self.assertEqual("is kept without an object" in said.getvalue(), is_told, said.getvalue())

    def test_a_folder_without_a_btf_is_no_choice_in_a_file_browser(self):
        (self.folder / "holiday.png").write_bytes(b"")
        with self.assertRaisesRegex(ExportError, "No file is chosen in .*choose a measurement"):
            measured.refuse_folder(str(self.folder))
        (self.folder / "btf.json").write_text("{}")
        measured.refuse_folder(str(self.folder))
        measured.refuse_folder(str(self.folder / "nothing.binary"))

    def test_a_fit_that_fails_is_no_matter_to_the_others(self):
        """Without a window they are made one after the other, and one report names those that failed."""
        for name in ("a.binary", "b.binary", "c.binary"):
            shutil.copy(inputs.lambert_measurement(), self.folder / name)
        begin = VELOUR_OT_fit._begin

        def fails(operator, context):
            if operator.material != "b":
                raise ExportError(f"Material '{operator.material}': cannot be fitted.")
            begin(operator, context)

        files = [{"name": f"{name}.binary"} for name in "abc"]
        with mock.patch.object(VELOUR_OT_fit, "_begin", fails):
            self._refused("'a': cannot", "'c': cannot", directory=str(self.folder), files=files)
        self.assertIsNone(scenes.velour_node(bpy.data.materials["a"]).image)
        self._check_model(scenes.velour_node(bpy.data.materials["b"]).image)

    def test_save_model(self):
        bpy.ops.velour.load_material(filepath=str(inputs.lambert_measurement()), fit=False)
        bpy.ops.velour.fit(tolerance=0.1, max_lobes=3)
        path = self.folder / "saved.velour"
        bpy.ops.velour.save_model(filepath=str(path))
        self.assertEqual(path.read_bytes(), bytes(scenes.velour_node(self.material).image.packed_file.data))

    def test_accept_file(self):
        data = inputs.model_bytes(inputs.lambert_measurement())
        path = self.folder / "paint.velour"
        path.write_bytes(data)
        bpy.ops.velour.load_material(filepath=str(path), pack=False)
        image = scenes.velour_node(self.material).image
        before = image.velour.sha256
        path.write_bytes(inputs.model_bytes(inputs.glossy_measurement()))
        self.assertEqual(bpy.ops.velour.accept_file(), {"FINISHED"})
        self.assertNotEqual(image.velour.sha256, before)

    def test_accept_file_beside_one_that_is_missing(self):
        path = self.folder / "paint.velour"
        path.write_bytes(inputs.model_bytes(inputs.lambert_measurement()))
        bpy.ops.velour.load_material(filepath=str(path), pack=False)
        node = scenes.velour_node(self.material)
        bpy.ops.velour.open_measurement(filepath=str(inputs.lambert_measurement()))
        node.velour.measurement.filepath_raw = str(self.folder / "gone.binary")
        before, missing = node.image.velour.sha256, node.velour.measurement.velour.sha256
        path.write_bytes(inputs.model_bytes(inputs.glossy_measurement()))
        self.assertEqual(bpy.ops.velour.accept_file(), {"FINISHED"})
        self.assertNotEqual(node.image.velour.sha256, before)
        self.assertEqual(node.velour.measurement.velour.sha256, missing)

    def test_the_material_shown_is_the_active_one(self):
        """One that is pinned in its tab is on no object."""
        bpy.ops.velour.add_material()
        pinned = bpy.data.materials.new("Pinned")
        with bpy.context.temp_override(object=None, material=pinned):
            bpy.ops.velour.add_material()
            bpy.ops.velour.open_measurement(filepath=str(inputs.lambert_measurement()))
            bpy.ops.velour.fit(tolerance=0.1, max_lobes=3)
        self._check_model(scenes.velour_node(pinned).image)
        self.assertIsNone(scenes.velour_node(self.material).image)

    def test_cancel_without_a_fit(self):
        self.assertEqual(bpy.ops.velour.cancel_fit(), {"FINISHED"})

    def _check_model(self, image):
        self.assertEqual(image.source, "FILE")
        self.assertGreater(self._info(image)["lobes"], 0)

    def _info(self, image):
        with inputs.native().Model.from_bytes(image.packed_file.data, image.name) as model:
            return model.info()


class Options(BlenderTest):
    def test_none_that_waits_is_done_again(self):
        """Adjust Last Operation and Repeat Last would wait in the window. One step of undo is no matter.

        Apply Material has a number to adjust, and waits only for the description of a model.
        """
        waiting = [each for each in operators.CLASSES if issubclass(each, (BackgroundJob, ReadsFirst))]
        self.assertIn(VELOUR_OT_fit, waiting)
        names = [each.__name__ for each in waiting if "REGISTER" in getattr(each, "bl_options", ())]
        self.assertEqual(names, ["VELOUR_OT_apply_material"])
        own = {
            "fit",
            "fit_for_scene",
            "approximate",
            "add_votf",
            "compress_btf",
            "load_material",
            "mark_asset",
        }
        undone = {each.bl_idname for each in waiting if "UNDO" in getattr(each, "bl_options", ())}
        self.assertEqual(own - {name.removeprefix("velour.") for name in undone}, set())


class Slots(BlenderTest):
    """Where a material goes that is ready later than it was asked for."""

    def setUp(self):
        super().setUp()
        self.cube, self.said = _two_sided_cube(), []
        self.cube.active_material_index = 1
        self.target = SlotTarget(bpy.context)

    def _put(self):
        material = bpy.data.materials.new("New")
        self.target.put(material, lambda kind, sentence: self.said.append((kind, sentence)))
        return material

    def _check_cube(self):
        """The new material is in its second slot, and nothing is left of the mark."""
        material = self._put()
        self.assertEqual([slot.material.name for slot in self.cube.material_slots], ["Below", material.name])
        self.assertFalse(self.cube.velour.is_property_set("jobs"))
        self.assertEqual(self.said, [])

    def test_whatever_is_selected_meanwhile(self):
        other = scenes.add_plane()
        self.cube.active_material_index = 0
        self.assertEqual(bpy.context.object, other)
        self._check_cube()
        self.assertIsNone(other.active_material)

    def test_whatever_it_is_called_meanwhile(self):
        namesake, name = scenes.add_plane(), self.cube.name
        self.cube.name = "Renamed"
        namesake.name = name
        self.assertEqual(namesake.name, name)
        self._check_cube()
        self.assertIsNone(namesake.active_material)

    def test_a_copy_is_another_one(self):
        copy = self.cube.copy()
        copy.data, copy.name = self.cube.data.copy(), "A copy"  # comes first by name
        bpy.context.collection.objects.link(copy)
        self._check_cube()
        self.assertEqual(copy.material_slots[1].material.name, "Above")
        self.assertFalse(copy.velour.is_property_set("jobs"))

    def test_another_one_in_its_place(self):
        name = self.cube.name
        bpy.data.objects.remove(self.cube)
        other = scenes.add_plane()
        other.name = name
        material = self._put()
        self.assertIsNone(other.active_material)
        self.assertTrue(material.use_fake_user)
        ((kind, sentence),) = self.said
        self.assertEqual(kind, {"WARNING"})
        self.assertIn(f"Slot 2 of object '{name}' no longer exists; material 'New'", sentence)

    def test_a_slot_that_is_gone(self):
        self.cube.data.materials.pop(index=1)
        self.assertTrue(self._put().use_fake_user)
        self.assertEqual([slot.material.name for slot in self.cube.material_slots], ["Below"])

    def test_several_that_wait_for_one_object(self):
        first, self.target = self.target, SlotTarget(bpy.context, Slot(self.cube.name, 0))
        self.cube.name = "Renamed"
        self.assertEqual(first.take(), (self.cube, 1))
        self.assertEqual(self.target.take(), (self.cube, 0))
        self.assertFalse(self.cube.velour.is_property_set("jobs"))

    def test_an_undo_takes_the_mark_away(self):
        self.cube.velour.property_unset("jobs")
        self._check_cube()

    def test_a_collection(self):
        """The tile of a capture."""
        collection = bpy.data.collections.new("Tile")
        owner = JobOwner(collection)
        collection.name = "Renamed"
        bpy.data.collections.new("Tile")
        self.assertEqual(owner.take(), collection)

    def test_several_that_wait_for_one_material(self):
        material = scenes.measured_material(b"", "Paint")
        node = scenes.velour_node(material)
        targets = [JobTarget(material, node) for _ in range(2)]
        material.name, node.group.name = "Renamed", "Other"
        scenes.measured_material(b"", "Paint")
        for target in targets:
            self.assertEqual(target.find(), (material, node))


class Refusals(BlenderTest):
    """A sentence that names the file or the material, and nothing half done."""

    def _refused(self, words, operator, **arguments):
        with self.assertRaises(RuntimeError) as caught:
            operator(**arguments)
        for word in words:
            self.assertIn(word, str(caught.exception))
        self.assertNotIn("Traceback", str(caught.exception))

    def test_load_missing(self):
        scenes.add_plane()
        self._refused(
            ["nothing.binary"], bpy.ops.velour.load_material, filepath=str(self.folder / "nothing.binary")
        )
        self.assertEqual(len(bpy.data.materials), 0)

    def test_load_foreign(self):
        path = self.folder / "noise.bsdf"
        path.write_bytes(bytes(range(256)) * 40)
        self._refused(["noise.bsdf"], bpy.ops.velour.load_material, filepath=str(path))

    def test_load_truncated(self):
        path = self.folder / "cut.binary"
        path.write_bytes(inputs.lambert_measurement().read_bytes()[:100000])
        self._refused(["cut.binary"], bpy.ops.velour.load_material, filepath=str(path))

    def test_fit_without_material(self):
        self._refused(["There is no active material"], bpy.ops.velour.fit)

    def test_fit_unknown_material(self):
        self._refused(["Nobody"], bpy.ops.velour.fit, material="Nobody")

    def test_fit_without_measurement(self):
        scenes.add_plane()
        bpy.ops.velour.add_material()
        self._refused(["no measurement"], bpy.ops.velour.fit)

    def test_linked_materials(self):
        """What is made of them would be gone with the next look into their file."""
        scenes.add_plane()
        path, model = str(self.folder / "library.blend"), inputs.model_bytes(inputs.lambert_measurement())
        bpy.ops.velour.load_material(filepath=str(inputs.lambert_measurement()), fit=False)
        name = bpy.context.object.active_material.name
        scenes.velour_node(bpy.data.materials[name]).image = measured.packed_model(model, "Model")
        bpy.ops.wm.save_as_mainfile(filepath=path)
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        with bpy.data.libraries.load(path, link=True) as (_source, target):
            target.materials = [name]
        tile = scenes.add_plane().name
        before = scenes.velour_node(bpy.data.materials[name]).image
        words = [f"'{name}' is linked", "make it local"]
        self._refused(words, bpy.ops.velour.fit, material=name, max_lobes=2)
        self._refused(words, bpy.ops.velour.add_votf, material=name, structure=tile, texels=8)
        self._refused(words, bpy.ops.velour.mark_asset, material=name)
        self._refused(words, bpy.ops.velour.accept_file, material=name)
        bpy.context.object.active_material = bpy.data.materials[name]
        self._refused(words, bpy.ops.velour.add_material)
        node = scenes.velour_node(bpy.data.materials[name])
        self.assertEqual((node.image, node.velour.max_lobes, node.velour.structure), (before, 16, None))

    def test_objects_whose_materials_are_linked(self):
        """A linked object, a linked mesh and an override get no material, and a sentence says why."""
        path, measurement = str(self.folder / "library.blend"), str(inputs.lambert_measurement())
        bpy.ops.mesh.primitive_cube_add()
        bpy.context.object.data.materials.append(bpy.data.materials.new("Plain"))
        bpy.ops.wm.save_as_mainfile(filepath=path)
        for kind in ("object", "mesh", "override"):
            bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
            self._link(path, kind)
            bpy.context.view_layer.update()
            said = io.StringIO()
            with self.subTest(kind), contextlib.redirect_stdout(said):
                self.assertEqual(bpy.ops.velour.load_material(filepath=measurement, fit=False), {"FINISHED"})
                self.assertRegex(
                    said.getvalue(), "linked from a library; material .* is kept without an object"
                )
                self.assertEqual(bpy.context.object.active_material.name, "Plain")
                self._refused(["'Plain' is linked"], bpy.ops.velour.add_material)
        slot = bpy.context.object.material_slots[
            0
        ]  # the control: of an override, slots of the object are free
        slot.link = "OBJECT"
        bpy.ops.velour.load_material(filepath=measurement, fit=False)
        self.assertEqual(slot.material, bpy.context.object.active_material)
        self.assertIsNone(slot.material.library)

    def _link(self, path, kind):
        """An active object of a library, of its mesh, or an override of it."""
        with bpy.data.libraries.load(path, link=True) as (source, target):
            if kind == "mesh":
                target.meshes = source.meshes
            else:
                target.objects = source.objects
        obj = target.objects[0] if kind != "mesh" else bpy.data.objects.new("Local", target.meshes[0])
        bpy.context.collection.objects.link(obj)
        if kind == "override":
            obj = obj.override_create(remap_local_usages=True)
        bpy.context.view_layer.objects.active = obj

    def test_a_model_is_not_saved_where_nothing_can_be_written(self):
        scenes.add_plane().active_material = scenes.measured_material(
            inputs.model_bytes(inputs.lambert_measurement())
        )
        path = self.folder / "missing" / "x.velour"
        self._refused([f"{path} cannot be written", "choose"], bpy.ops.velour.save_model, filepath=str(path))

    def test_fit_missing_measurement(self):
        scenes.add_plane()
        bpy.ops.velour.load_material(filepath=str(inputs.lambert_measurement()), fit=False)
        node = scenes.velour_node(bpy.context.object.active_material)
        node.velour.measurement.filepath = str(self.folder / "gone.binary")
        self._refused(["gone.binary", "missing"], bpy.ops.velour.fit)

    def test_save_without_model(self):
        self._refused(["no model"], bpy.ops.velour.save_model, filepath=str(self.folder / "x.velour"))
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_accept_without_material(self):
        self._refused(["no measured material"], bpy.ops.velour.accept_file)
