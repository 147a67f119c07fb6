"""Which model a material that has one for the scene gets in this frame: decided from this frame alone."""

import contextlib

from ..export.camera import final_view
from ..export.scene_models import served


def choose_models(native_scene, reduced, view, depsgraph, notes, check_break):
    """Gives each material of `reduced` its model for the scene where the frame allows.

    Notes how much of what is seen of it is new to that model. Returns {material name: stamp text}.
    """
    if not reduced:
        return {}
    stamps = {}
    with _seen_whole(native_scene, view, depsgraph, notes) as whole:
        found = served(native_scene, reduced, whole, depsgraph, check_break)
    for entry, each in zip(reduced, found, strict=True):
        if each.is_inside:
            native_scene.set_model_material(entry.number, entry.model, entry.neighbors)
        entry.model.close()
        notes.add(each.sentence)
        stamps[entry.name] = f"{each.share:.2%} outside of its model's domain; {each.words}"
    native_scene.commit()  # a model may have another outline than the one that it replaces
    return stamps


@contextlib.contextmanager
def _seen_whole(native_scene, view, depsgraph, notes):
    """A render border must not change the choice: the parts of a picture may be rendered one by one."""
    whole = final_view(depsgraph, notes, whole=True)
    if not depsgraph.scene_eval.render.use_border:
        yield whole
        return
    whole.add_to(native_scene)
    native_scene.commit()
    yield whole
    view.add_to(native_scene)
    native_scene.commit()
