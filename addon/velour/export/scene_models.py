"""Whether scene models are valid in a frame, judged by its scene usage without rendering."""

from typing import NamedTuple

from ..core import domain
from .observe import observe


class Served(NamedTuple):
    """A material with a scene model, in one frame and view layer."""

    name: str
    image: str  # name of the scene model's image
    frame: int
    share: float  # share of its scene usage that the model was not fitted to
    has_full: bool  # False: there is no full model to fall back to

    @property
    def is_inside(self):
        return domain.inside(self.share)

    @property
    def words(self):
        """The part of the message that says how it is rendered."""
        if self.is_inside:
            return "rendered with the scene model"
        more = f"that is more than {domain.LARGEST_SHARE:.1%}"
        if self.has_full:
            return f"{more}: rendered with the full model"
        return f"{more}, but the full model is missing: rendered with the scene model, which may be wrong"

    @property
    def remedy(self):
        if self.is_inside:
            return ""
        if self.has_full:
            return "To use the smaller model here as well, press Fit for This Scene again."
        return "Restore the full model, or fit the material again."

    @property
    def sentence(self):
        return f"{self._said}; {self.words}. {self.remedy}".rstrip()

    @property
    def refusal(self):
        """The sentence where scene models must cover the frame."""
        return f"{self._said}. Press Fit for This Scene again, or disable the scene model."

    @property
    def _said(self):
        return (
            f"Material '{self.name}', frame {self.frame}: {self.share:.2%} of its scene usage is outside its"
            " scene model's range"
        )


def served(native_scene, reduced, view, depsgraph, check_break=lambda: None):
    """A Served for each of `reduced` in a committed scene with its full models, seen through `view`."""
    frame = depsgraph.scene_eval.frame_current
    found = []
    for entry in reduced:
        with observe(native_scene, entry.number, view, depsgraph, check_break) as seen:
            share = entry.model.out_of_domain(seen)
        found.append(Served(entry.name, entry.image, frame, share, entry.has_full))
    return found
