"""Which model a material that has one for the scene gets in this frame: decided from this frame alone."""

import contextlib

from ..core import domain
from ..export.camera import final_view
from ..export.observe import observe


def choose_models(native_scene, reduced, view, depsgraph, notes, check_break):
    """Gives each material of `reduced` its model for the scene where the frame allows.

    Notes how much of what is seen of it is new to that model. Returns {material name: stamp text}.
    """
    if not reduced:
        return {}
    stamps, frame = {}, depsgraph.scene_eval.frame_current
    with _seen_whole(native_scene, view, depsgraph, notes) as whole:
        shares = [_share_outside(native_scene, entry, whole, depsgraph, check_break) for entry in reduced]
    for entry, share in zip(reduced, shares, strict=True):
        inside = domain.inside(share)
        if inside:
            native_scene.set_model_material(entry.number, entry.model, entry.neighbors)
        entry.model.close()
        words = _words(inside, entry.has_full)
        notes.add(
            f"Material '{entry.name}', frame {frame}: {share:.2%} of what is seen of it is outside of"
            f" what its model for the scene was fitted to; {words}."
        )
        stamps[entry.name] = f"{share:.2%} outside of its model's domain; {words}"
    native_scene.commit()  # a model may have another outline than the one that it replaces
    return stamps


def _share_outside(native_scene, entry, view, depsgraph, check_break):
    with observe(native_scene, entry.number, view, depsgraph, check_break) as seen:
        return entry.model.out_of_domain(seen)


def _words(inside, has_full):
    if inside:
        return "rendered with that model"
    more = f"that is more than {domain.LARGEST_SHARE:.1%}"
    if has_full:
        return f"{more}: rendered with the full model"
    return (
        f"{more}, but the full model is missing: rendered with that model,"
        " which may be wrong; fit the material, or put the full model back"
    )


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
