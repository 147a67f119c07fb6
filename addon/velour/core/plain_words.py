"""The library's warnings in an artist's words: what it means for the picture, and what to do.

Engineers read the library's own sentences: on the command line, and in the file of the model.
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


# What the library's sentence matches, and the sentence that its groups make.
_SENTENCES = (
    (
        r"(\d+) of (\d+) entries are invalid and were left out",
        lambda bad, all_: (
            f"The measurement has holes: {_share(bad, all_)} of it was left out, and what stands"
            " there is a guess. Where it looks wrong take a more complete measurement."
        ),
    ),
    (
        r"the measurement has (\d+) samples: what lies between",
        lambda count: (
            f"The measurement is sparse: what lies between its {count} samples is a guess. Compare by"
            " Render from Measurement; a denser measurement would be safer."
        ),
    ),
    (
        rf"the surface is anisotropic: .* differ by a factor of {_NUMBER} \(median\)",
        lambda factor: (
            f"The surface is brushed or woven: turned in its plane it changes by a factor of {factor}. The"
            " model is the same from all sides, a mean of them. A measurement as a table with azimuths keeps"
            " the difference."
        ),
    ),
    (
        r"the measurement's own noise exceeds the tolerance",
        lambda: (
            "The measurement is noisier than Tolerance asks for: a smaller error would say nothing. A"
            " larger Tolerance gives a smaller model that is as good."
        ),
    ),
    (
        r"views? ([\d, ]+) degrees: the highlight, or a lobe of the model, is narrower",
        lambda angles: (
            f"The highlight is so sharp that its error was measured on finer directions, at"
            f" {_at(angles)}. Nothing needs to be done."
        ),
    ),
    (
        rf"views? ([\d, ]+) degrees: the measurement covers as little as {_NUMBER} of the light",
        lambda angles, share: (
            f"Seen at {_at(angles)} the measurement knows no more than {_percent(share)} of"
            " the directions that light comes from; elsewhere the model is a guess. Compare by Render from"
            " Measurement."
        ),
    ),
    (
        r"no reported view is covered: the error is not known",
        lambda: (
            "How good the model is is not known: the measurement has none of the views that errors are"
            " taken at. Compare by Render from Measurement."
        ),
    ),
    (
        r"the model is black: the measurement is darker",
        lambda: (
            "The model is black: the measurement is darker than what can be fitted. Check that it is the"
            " right file."
        ),
    ),
    (
        r"the measurement is black at every view",
        lambda: "The measurement is black. Check that it is the right file.",
    ),
    (
        rf"albedo at most {_NUMBER} at every view, darker than",
        lambda most: (
            f"The material reflects at most {float(most):.2%} of the light, less than soot does. Check"
            " that it is the right file, or raise Exposure."
        ),
    ),
    (
        _BRIGHT + "the measurement reflects more light there than arrives, far more",
        lambda albedo: (
            f"The measurement reflects {float(albedo):.2g} times the light that falls on it,"
            " far more than can be true. Check that it is the right file, or lower Exposure."
        ),
    ),
    (
        _BRIGHT + "the measurement reflects more light there than arrives",
        lambda albedo: (
            f"The measurement reflects up to {float(albedo):.3g} times the light that falls on"
            " it. Switch on Limit Albedo and fit again, or lower Exposure."
        ),
    ),
    (
        _BRIGHT + "the model reflects more light there than arrives",
        lambda albedo: (
            f"The model reflects up to {float(albedo):.3g} times the light that falls on it,"
            " the measurement does not. Raise Max Lobes, or switch on Limit Albedo, and fit again."
        ),
    ),
    (
        rf"the measurement is not reciprocal: .* changes it by {_NUMBER}",
        lambda change: (
            f"The measurement changes by {_percent(change)} when lamp and camera change places,"
            " which no real surface does; the model follows it. Velour's pictures are right all the same. For"
            " other programs switch on Reciprocal and fit again."
        ),
    ),
    (
        rf"the model is not reciprocal: .* changes it by {_NUMBER}",
        lambda change: (
            f"The model changes by {_percent(change)} when lamp and camera change places. Velour's"
            " pictures are right all the same. For other programs switch on Reciprocal and fit again."
        ),
    ),
    (
        r"(\d+) of (\d+) sampled views are outside the measurement",
        lambda out, all_: (
            f"The measurement lacks {_share(out, all_)} of the angles that a surface is seen at;"
            " what the model shows there is a guess. Take a more complete measurement, or show other angles."
        ),
    ),
    (
        r"(\d+) of (\d+) fitted values have a negative channel",
        lambda out, all_: (
            f"In {_share(out, all_)} of the measurement colours are too pure for the colour space; the"
            " model takes the nearest ones. Nothing needs to be done."
        ),
    ),
    (
        r"the bound of (\d+) bytes leaves (\d+) views and (\d+) lobes",
        lambda most, *_left: (
            f"The model was cut down to {most} bytes and is coarser for it; allow more for a better one."
        ),
    ),
    (
        r"the scene needs all of the full model",
        lambda: (
            "This scene needs the whole model: nothing smaller makes pictures as good. It is rendered with"
            " the full model; there is nothing to be done."
        ),
    ),
    (
        r"of clustered tensors the finest levels were left out",
        lambda: (
            "Only detail too fine for this scene was left out. Make the material with Method SRBF or SVD"
            " and the model is also fitted to the views that the scene shows."
        ),
    ),
    (
        r"the scene resolves the finest texels",
        lambda: (
            "This scene shows the finest detail of the material, so it needs the whole model. From farther"
            " away, or in a smaller picture, a smaller one would do."
        ),
    ),
    (
        r"(\d+) entries of the BTF are not finite",
        lambda count: (
            f"{count} values of the capture are broken and were replaced by their picture's mean."
            " Where spots show, capture it again."
        ),
    ),
    (
        r"within the memory allowed lobes are chosen by .*; (.+) would leave them all",
        lambda memory: (
            f"There was too little memory for the best material; {memory} would do. Use fewer"
            " Texels, or close other programs, and make it again."
        ),
    ),
    (
        rf"the tolerance of {_NUMBER} is not met: the error is {_NUMBER} with (\d+) bytes; (.*)",
        lambda asked, error, size, more: (
            f"Largest Error {asked} is not reached: it is {error} at"
            f" {int(size) / 1e6:.3g} MB. {_size_remedy(more)}"
        ),
    ),
    (
        r"(\d+) of (\d+) vertical lines meet a sheet",
        lambda *_lines: (
            "Part of the structure has no thickness and was made about one texel thick. Give it"
            " some with a Solidify modifier, or raise Texels."
        ),
    ),
)


def _size_remedy(more: str) -> str:
    enough = re.match(r"about (\d+) bytes would do", more)
    if enough:
        return f"Allow {int(enough[1]) / 1e6:.3g} MB in Largest Size."
    error = re.search(rf"a tolerance of {_NUMBER}", more)
    return f"Ask for {error[1] if error else 'a larger one'}, or try another Method."


def plain(warning: str) -> str:
    """The library's `warning` in an artist's words; one that has no such form is left as it is."""
    for pattern, sentence in _SENTENCES:
        match = re.match(pattern, warning)
        if match:
            return sentence(*match.groups())
    return warning
