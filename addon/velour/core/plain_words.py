"""The library's warnings in an artist's words: what they mean for the picture, and what to do.

Engineers read the library's own sentences, on the command line and in the model's file.
"""

from __future__ import annotations

import re

_NUMBER = r"(\d+(?:\.\d+)?(?:e[-+]?\d+)?)"
_BRIGHT = rf"albedo {_NUMBER} at view [\d./-]+ degrees: "


def _share(part: str, whole: str) -> str:
    share = int(part) / int(whole)
    return f"{share:.0%}" if share >= 0.01 else "less than 1%"


def _percent(value: str) -> str:
    return f"{float(value):.0%}"


def _at(angles: str) -> str:
    return ", ".join(f"{angle}\N{DEGREE SIGN}" for angle in angles.split(", "))


# (Pattern of the library's sentence, function from its groups to the artist's sentence)
_SENTENCES = (
    (
        r"(\d+) of (\d+) entries are invalid and were left out",
        lambda bad, all_: (
            f"The measurement has holes: {_share(bad, all_)} of it is invalid and was left out, so the model"
            " is a guess there. If it looks wrong, use a more complete measurement."
        ),
    ),
    (
        r"the measurement has (\d+) samples: what lies between",
        lambda count: (
            f"The measurement is sparse: between its {count} samples, the model is a guess. Check it with"
            " Render from Measurement, or use a denser measurement."
        ),
    ),
    (
        rf"the surface is anisotropic: .* differ by a factor of {_NUMBER} \(median\)",
        lambda factor: (
            "The surface is anisotropic, like brushed metal: rotating it in its plane changes it by a factor"
            f" of {factor}. The model is isotropic, a mean over the rotation. Use a tabulated measurement"
            " with azimuths for an anisotropic model."
        ),
    ),
    (
        r"the measurement's own noise exceeds the tolerance",
        lambda: (
            "The noise of the measurement exceeds Max Error, so a smaller error is meaningless. A larger Max"
            " Error gives a smaller model of the same quality."
        ),
    ),
    (
        r"views? ([\d, ]+) degrees: the highlight, or a lobe of the model, is narrower",
        lambda angles: (
            f"The highlight at {_at(angles)} is so sharp that its error was measured with closer directions."
            " No action is needed."
        ),
    ),
    (
        rf"views? ([\d, ]+) degrees: the measurement covers as little as {_NUMBER} of the light",
        lambda angles, share: (
            f"At view angles of {_at(angles)} the measurement covers as little as {_percent(share)} of the"
            " light directions; for the others, the model is a guess. Check it with Render from Measurement."
        ),
    ),
    (
        r"no reported view is covered: the error is not known",
        lambda: (
            "The error of the model is not known: the measurement covers none of the views at which errors"
            " are reported. Check the model with Render from Measurement."
        ),
    ),
    (
        r"the model is black: the measurement is darker",
        lambda: (
            "The model is black: the measurement is too dark to be fitted. Check that it is the right file."
        ),
    ),
    (
        r"the measurement is black at every view",
        lambda: "The measurement is black. Check that it is the right file.",
    ),
    (
        rf"albedo at most {_NUMBER} at every view, darker than",
        lambda most: (
            f"The material reflects at most {float(most):.2%} of the light, less than soot. Check that it is"
            " the right file, or raise Exposure."
        ),
    ),
    (
        _BRIGHT + "the measurement reflects more light there than arrives, far more",
        lambda albedo: (
            f"The measurement reflects {float(albedo):.2g} times the light it receives, far more than"
            " measurement errors explain. Check that it is the right file, or lower Exposure."
        ),
    ),
    (
        _BRIGHT + "the measurement reflects more light there than arrives",
        lambda albedo: (
            f"The measurement reflects up to {float(albedo):.3g} times the light it receives. Enable Limit"
            " Albedo and fit again, or lower Exposure."
        ),
    ),
    (
        _BRIGHT + "the model reflects more light there than arrives",
        lambda albedo: (
            f"The model reflects up to {float(albedo):.3g} times the light it receives, but the measurement"
            " does not. Raise Max Lobes or enable Limit Albedo, and fit again."
        ),
    ),
    (
        rf"the measurement is not reciprocal: .* changes it by {_NUMBER}",
        lambda change: (
            f"The measurement changes by {_percent(change)} when light and camera are exchanged, which no"
            " real surface does, and so does the model. Renders with Velour are correct regardless. For other"
            " programs, enable Reciprocal and fit again."
        ),
    ),
    (
        rf"the model is not reciprocal: .* changes it by {_NUMBER}",
        lambda change: (
            f"The model changes by {_percent(change)} when light and camera are exchanged. Renders with"
            " Velour are correct regardless. For other programs, enable Reciprocal and fit again."
        ),
    ),
    (
        r"(\d+) of (\d+) sampled views are outside the measurement",
        lambda out, all_: (
            f"The measurement lacks {_share(out, all_)} of the view angles, so the model is a guess there."
            " Use a more complete measurement, or avoid these angles."
        ),
    ),
    (
        r"(\d+) of (\d+) fitted values have a negative channel",
        lambda out, all_: (
            f"In {_share(out, all_)} of the measurement, colors are too saturated for the color space; the"
            " model uses the nearest colors. No action is needed."
        ),
    ),
    (
        r"the bound of (\d+) bytes leaves (\d+) views and (\d+) lobes",
        lambda most, *_left: (
            f"The model was reduced to {most} bytes, which makes it coarser. Allow a larger size for a better"
            " model."
        ),
    ),
    (
        r"the scene needs all of the full model",
        lambda: (
            "This scene needs the full model: no smaller model gives images of the same quality. The full"
            " model is rendered; no action is needed."
        ),
    ),
    (
        r"of clustered tensors the finest levels were left out",
        lambda: (
            "Only detail that is too fine for this scene was left out. For a smaller scene model, create the"
            " material with Method SRBF or SVD, which are also fitted to the views of the scene."
        ),
    ),
    (
        r"the scene resolves the finest texels",
        lambda: (
            "This scene shows the finest detail of the material, so it needs the full model. From farther"
            " away, or in a smaller image, a smaller model would suffice."
        ),
    ),
    (
        r"(\d+) entries of the BTF are not finite",
        lambda count: (
            f"{count} values of the capture are invalid and were replaced by the mean of their image. If"
            " spots are visible, capture it again."
        ),
    ),
    (
        r"within the memory allowed lobes are chosen by .*; (.+) would leave them all",
        lambda memory: (
            f"There was not enough memory for the best material; {memory} would suffice. Use fewer Texels or"
            " close other programs, and create the material again."
        ),
    ),
    (
        rf"the tolerance of {_NUMBER} is not met: the error is {_NUMBER} with (\d+) bytes; (.*)",
        lambda asked, error, size, more: (
            f"The model exceeds Max Error ({asked}): its error is {error} at {int(size) / 1e6:.3g} MB."
            f" {_size_remedy(more)}"
        ),
    ),
    (
        r"(\d+) of (\d+) vertical lines meet a sheet",
        lambda *_lines: (
            "Part of the structure has no thickness and was made about one texel thick. Add a Solidify"
            " modifier, or raise Texels."
        ),
    ),
)


def _size_remedy(more: str) -> str:
    enough = re.match(r"about (\d+) bytes would do", more)
    if enough:
        return f"Raise Max Size to {int(enough[1]) / 1e6:.3g} MB."
    error = re.search(rf"a tolerance of {_NUMBER}", more)
    return f"Raise Max Error to {error[1] if error else 'a larger value'}, or try another Method."


def plain(warning: str) -> str:
    """The library's `warning` in an artist's words; unchanged if no pattern matches."""
    for pattern, sentence in _SENTENCES:
        match = re.match(pattern, warning)
        if match:
            return sentence(*match.groups())
    return warning
