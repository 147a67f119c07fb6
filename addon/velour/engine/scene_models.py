"""Whether a material with a scene model gets it in this frame: decided from this frame alone."""

import contextlib

from ..export import ExportError
from ..export.camera import final_view
from ..export.scene_models import served


def choose_models(native_scene, reduced, view, camera, depsgraph, notes, check_break, strict):
    """Gives each material of `reduced` its scene model if the frame allows it. `camera`: that of `view`.

    Notes the share of its usage that the scene model was not fitted for; `strict`: raises ExportError if that
    is too much. Returns {material name: stamp text}.
    """
    if not reduced:
        return {}
    stamps = {}
    with _seen_whole(native_scene, view, camera, depsgraph) as whole:
        found = served(native_scene, reduced, whole, depsgraph, check_break)
    refused = next((each for each in found if not each.is_inside), None) if strict else None
    if refused:
        for entry in reduced:
            entry.model.close()
        raise ExportError(f"{refused.refusal} Or leave out --velour-strict-usage.")
    for entry, each in zip(reduced, found, strict=True):
        if each.is_inside:
            native_scene.set_model_material(entry.number, entry.model, entry.neighbors)
        entry.model.close()
        notes.add(each.sentence)
        stamps[entry.name] = (
            f"{each.share:.2%} of its scene usage is outside its scene model's range; {each.words}"
        )
    native_scene.commit()  # a model may have another VOTF than the one that it replaces
    return stamps


@contextlib.contextmanager
def _seen_whole(native_scene, view, camera, depsgraph):
    """Sets the camera to the whole view, without the render border: parts of a picture, which may be rendered
    one by one, must get the same models."""
    whole = final_view(depsgraph, whole=True, camera=camera)
    if not depsgraph.scene_eval.render.use_border:
        yield whole
        return
    whole.add_to(native_scene)
    native_scene.commit()
    yield whole
    view.add_to(native_scene)
    native_scene.commit()
