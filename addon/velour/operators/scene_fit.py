"""Steps of fitting a scene model, which the operator runs all at once or one at a time."""

from ..core.read_job import ReadJob
from ..export import ExportError, Notes, export_scene, visitor
from ..export.camera import final_view
from ..export.files import StoredFile, absolute_path
from ..export.nodes import velour_node
from ..export.observe import observe
from ..native import Btf, Measurement, Observation, compress_job, fit_job
from . import measured
from .job_target import JobOwner, JobTarget
from .sharing import other_scenes

ENGINE = "VELOUR"


class SharedMaterialError(ExportError):
    """Another scene uses the material, too."""


class SceneFit:
    """Reads the files (begin_reading(), then take()), observes frame after frame, then fits.

    Stores names and marks, since undo may replace any datablock."""

    def __init__(self, material, scene, current_frame=False, shared=False):
        _refuse_unfit(material)
        if not any(layer.use for layer in scene.view_layers):
            raise ExportError(f"Scene '{scene.name}': no view layer is enabled for rendering; enable one.")
        others = [] if shared else other_scenes(material, scene)
        if others:
            raise SharedMaterialError(
                f"Material '{material.name}' is also used by {_scenes(others)}, for which the scene model"
                " would not be fitted. Make the material single-user, or fit it even if shared (shared=True)."
            )
        self.material_name, self.scene_name = material.name, scene.name
        self._target, self._owner = JobTarget(material, velour_node(material)), JobOwner(scene)
        self.frames = [scene.frame_current] if current_frame else frame_range(scene)
        self.reading = self._read = None
        self.observation = Observation.of_nothing()
        self.done = 0  # number of observed frames

    def begin_reading(self):
        """Starts and returns the job that reads the material's current files."""
        material, node = self._material()
        _refuse_unfit(material)
        self._model_before = _identity(node.image)
        self.reading = ReadJob(_reader(material)).start()
        return self.reading

    @property
    def has_read(self):
        return self._read is not None

    def take(self):
        """Takes the job's result: the measurement or BTF, and the full model."""
        self._read = self.reading.result()
        self.reading.close()

    def close(self):
        if self.reading is not None:
            self.reading.close()
        for handle in (*(self._read or ()), self.observation):
            handle.close()

    def observe_next(self):
        """Adds the scene usage of the next frame; False if no frame remains."""
        self._refuse_another_model()
        if self.done == len(self.frames):
            return False
        visitor.visit_frame(self._scene(), self.frames[self.done], self._visit, ENGINE)
        self.done += 1
        return True

    def fit(self, threads):
        """Starts and returns the job of the fit."""
        if self.observation.info()["hits"] == 0:
            raise ExportError(
                f"Material '{self.material_name}' is not visible in {self._range()} of scene"
                f" '{self.scene_name}', so no scene model can be fitted; choose frames that show it."
            )
        self._owner.take()
        node = self._refuse_another_model()
        raw, full = self._read
        if isinstance(raw, Btf):
            return compress_job(raw, for_scene=self.observation, full_model=full, threads=threads).start()
        return self._fit_job(raw, full, node.velour, threads).start()

    def _fit_job(self, measurement, full, settings, threads):
        if full.info()["model"] != "parametric" and "shell" in full.info():
            raise ExportError(
                f"Material '{self.material_name}': only parametric models pass their silhouette (VOTF) on to"
                " the scene model. Fit a parametric model and add the silhouette to it."
            )
        # Only a parametric model can be the reference; without one, the fit makes it first.
        measure = {"full_model": full} if full.info()["model"] == "parametric" else {}
        return fit_job(
            measurement,
            model="parametric",
            for_scene=self.observation,
            **measure,
            tolerance=settings.tolerance,
            max_lobes=settings.max_lobes,
            seed=settings.seed,
            all_data=int(settings.use_all_data),
            limit_albedo=int(settings.use_limit_albedo),
            threads=threads,
        )

    def keep(self, model):
        """Stores the model in a new image beside the full one, and enables it."""
        material, node = self._target.find()
        name = material.name if material else self.material_name
        image = measured.packed_model(model.bytes(), f"{name} for {self.scene_name}")
        if node is None:
            image.use_fake_user = True
            raise ExportError(
                f"Material '{name}' no longer exists; its scene model is kept as image '{image.name}'."
            )
        node.velour.scene_model, node.velour.use_scene_model = image, True

    def _refuse_another_model(self):
        """The node; raises ExportError if its model is not the one that was read."""
        _material, node = self._material()
        if node.image is None or _identity(node.image) != self._model_before:
            raise ExportError(
                f"Material '{self.material_name}': its model was changed meanwhile; press Fit for This Scene"
                " again."
            )
        return node

    def _material(self):
        """The material and its node, even if renamed."""
        material, node = self._target.find()
        if velour_node(material) is None:
            raise ExportError(f"Material '{self.material_name}' no longer exists, or is no longer measured.")
        self.material_name = material.name
        return material, node

    def _scene(self):
        """The scene, even if renamed."""
        scene = self._owner.find()
        if scene is None:
            raise ExportError(f"Scene '{self.scene_name}' no longer exists.")
        self.scene_name = scene.name
        return scene

    def _visit(self, engine, depsgraph):
        """Observes one view layer of one frame."""
        notes = Notes()  # reported by renders instead
        view = final_view(depsgraph, whole=True)
        native_scene, materials, *_ = export_scene(depsgraph, view, notes)
        with native_scene:
            number = materials.find(self._material()[0])
            if number is not None:
                with observe(native_scene, number, view, depsgraph) as seen:
                    self.observation.merge(seen)

    def _range(self):
        first, last = self.frames[0], self.frames[-1]
        return f"frame {first}" if first == last else f"frames {first} to {last}"


def frame_range(scene):
    return list(range(scene.frame_start, scene.frame_end + 1, scene.frame_step))


def _refuse_unfit(material):
    node = velour_node(material)
    owner = f"Material '{material.name}'"
    if node is None or node.velour.measurement is None:
        raise ExportError(f"{owner}: no measurement is chosen; press Open beside Measurement.")
    if node.image is None:
        raise ExportError(f"{owner}: it has no full model yet; press Fit first.")
    measured.refuse_linked(material)


def _identity(image):
    """Cheap key that changes if the model is replaced."""
    return absolute_path(image), image.velour.sha256


def _reader(material):
    """Function that reads the measurement and the full model on the job's thread."""
    node, owner = velour_node(material), f"Material '{material.name}'"
    raw, full = (StoredFile.of(image, owner) for image in (node.velour.measurement, node.image))
    return lambda: _of_one_content(_read_raw(raw), full)


def _read_raw(stored):
    if stored.raw_info()["kind"] == "btf":
        return stored.raw(Btf)
    measurement = stored.raw(Measurement)
    if not measurement.info()["isotropic"]:
        raise ExportError(
            f"{stored.owner}: the measurement is anisotropic, but the scene usage has only the angle of views"
            " to the normal, not their azimuth; use the full model."
        )
    return measurement


def _of_one_content(raw, stored):
    model = stored.model()
    if model.info()["source"]["sha256"] != raw.info()["sha256"]:
        raise ExportError(f"{stored.owner}: the full model was not fitted to this measurement; press Fit.")
    return raw, model


def _scenes(names):
    quoted = [f"'{name}'" for name in names]
    return f"scene {quoted[0]}" if len(names) == 1 else f"scenes {', '.join(quoted)}"
