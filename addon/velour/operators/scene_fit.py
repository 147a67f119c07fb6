"""The steps of a fit for a scene, for the operator that takes them at once or one at a time."""

import bpy

from ..export import ExportError, Notes, export_scene, visitor
from ..export.camera import final_view
from ..export.files import measurement_info, read_btf, read_measurement, read_model
from ..export.nodes import velour_node
from ..export.observe import observe
from ..native import Btf, Observation, compress_job, fit_job
from . import measured
from .job_target import JobTarget
from .sharing import other_scenes

ENGINE = "VELOUR"


class SharedMaterialError(ExportError):
    """Another scene uses the material, too."""


class SceneFit:
    """Observes frame after frame, then fits. Holds names and a mark: undo may replace any datablock."""

    def __init__(self, material, scene, current_frame=False, shared=False):
        _refuse_unfit(material)
        if not any(layer.use for layer in scene.view_layers):
            raise ExportError(f"Scene '{scene.name}': no view layer renders; switch one on.")
        others = [] if shared else other_scenes(material, scene)
        if others:
            raise SharedMaterialError(
                f"Material '{material.name}' is also used by {_scenes(others)}, for which the model would not"
                " be fitted. Make the material single-user, or fit it even if shared (shared=True)."
            )
        self.material_name, self.scene_name = material.name, scene.name
        self._target = JobTarget(material, velour_node(material))
        self.frames = [scene.frame_current] if current_frame else frame_range(scene)
        self._measurement = _read_measurement(material)
        self.observation = Observation.of_nothing()
        self.done = 0  # frames

    def close(self):
        self._measurement.close()
        self.observation.close()

    def observe_next(self):
        """Adds what the next frame shows; False when there is none left."""
        if self.done == len(self.frames):
            return False
        visitor.visit_frame(self._scene(), self.frames[self.done], self._visit, ENGINE)
        self.done += 1
        return True

    def fit(self, threads):
        """The job, started."""
        if self.observation.info()["hits"] == 0:
            raise ExportError(
                f"Material '{self.material_name}' is not seen in {self._range()} of scene"
                f" '{self.scene_name}'; nothing tells what its model is needed for."
            )
        _material, node = self._material()
        with read_model(node.image, f"Material '{self.material_name}'") as full:
            if full.info()["source"]["sha256"] != self._measurement.info()["sha256"]:
                raise ExportError(
                    f"Material '{self.material_name}': the full model is not of this measurement; press Fit."
                )
            if isinstance(self._measurement, Btf):
                job = compress_job(
                    self._measurement, for_scene=self.observation, full_model=full, threads=threads
                )
            else:
                job = self._fit_job(full, node.velour, threads)
            return job.start()

    def _fit_job(self, full, settings, threads):
        if full.info()["model"] != "parametric" and "shell" in full.info():
            raise ExportError(
                f"Material '{self.material_name}': only a parametric model hands its outline (VOTF) on to a"
                " model for the scene; fit one, and add the outline to it."
            )
        # A model of another kind is no measure of a parametric one: without one the fit makes it first.
        measure = {"full_model": full} if full.info()["model"] == "parametric" else {}
        return fit_job(
            self._measurement,
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
        """Puts the model beside the full one, in a new image, and switches it on."""
        material, node = self._target.find()
        name = material.name if material else self.material_name
        image = measured.packed_model(model.bytes(), f"{name} for {self.scene_name}")
        if node is None:
            image.use_fake_user = True
            raise ExportError(
                f"Material '{name}' is gone; its model for the scene is kept as image '{image.name}'."
            )
        node.velour.scene_model, node.velour.use_scene_model = image, True

    def _material(self):
        """The material and its node, whatever it is called now."""
        material, node = self._target.find()
        if velour_node(material) is None:
            raise ExportError(f"Material '{self.material_name}' is gone, or is not measured any more.")
        self.material_name = material.name
        return material, node

    def _scene(self):
        scene = bpy.data.scenes.get(self.scene_name)
        if scene is None:
            raise ExportError(f"Scene '{self.scene_name}' is gone.")
        return scene

    def _visit(self, engine, depsgraph):
        """One view layer of one frame."""
        notes = Notes()  # said by renders
        view = final_view(depsgraph, notes, whole=True)
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
        raise ExportError(f"{owner}: no measurement is chosen; use File > Import > Measured Material.")
    if node.image is None:
        raise ExportError(f"{owner}: it has no full model yet; press Fit first.")
    if material.library is not None:
        raise ExportError(f"{owner} is linked from a library, where nothing can be kept; make it local.")


def _read_measurement(material):
    owner = f"Material '{material.name}'"
    image = velour_node(material).velour.measurement
    if measurement_info(image, owner)["kind"] == "btf":
        return read_btf(image, owner)
    measurement = read_measurement(image, owner)
    if not measurement.info()["isotropic"]:
        measurement.close()
        raise ExportError(
            f"{owner}: the measurement is anisotropic, and of a scene's views only the angle from the normal"
            " is known, not the direction around it; use the full model."
        )
    return measurement


def _scenes(names):
    quoted = [f"'{name}'" for name in names]
    return f"scene {quoted[0]}" if len(names) == 1 else f"scenes {', '.join(quoted)}"
