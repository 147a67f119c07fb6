"""Makes the library's program of a draft."""

from ...native import Instruction, Output, Program
from ..image_nodes import Coordinates
from .draft import CornerSet, ImageNumber, Step, UvSet


def sources_of_draft(draft):
    """Coordinates and CornerColors that the program of a Draft reads."""
    named = [choice for step in draft.steps for choice in step.choices]
    maps = [Coordinates(each.coordinates) for each in named if isinstance(each, UvSet)]
    return [*maps, *(each.colors for each in named if isinstance(each, CornerSet))]


def finished(draft, maps, colors, texture):
    """The Program of a Draft.

    maps: UvMaps. colors: CornerColors by set. texture: makes the Texture of a Picture, of colors or numbers.
    """
    steps = [_with_set(draft, step, colors) for step in draft.steps]
    images, numbers = [], {}
    for step in steps:
        for choice in step.choices:
            if isinstance(choice, ImageNumber) and choice not in numbers:
                numbers[choice] = len(images)
                images.append(texture(choice.picture, choice.is_color))

    def number(choice):
        if isinstance(choice, UvSet):
            return maps.number(choice.coordinates)
        if isinstance(choice, CornerSet):
            return colors.index(choice.colors)
        return numbers[choice] if isinstance(choice, ImageNumber) else choice

    constants = len(draft.constants)

    def register(first):
        return -1 - first if first < 0 else constants + first

    instructions = [
        Instruction(
            step.operation,
            tuple(map(number, step.choices)),
            tuple(register(value.first) for value in step.inputs),
            constants + step.output,
            step.table,
        )
        for step in steps
    ]
    outputs = [Output(register(value.first), kind) for value, kind in draft.outputs]
    return Program.new(
        constants + draft.registers, draft.constants, instructions, outputs, images, draft.width or 1.0
    )


def _with_set(draft, step, colors):
    """The Step, or a constant in place of an attribute that has no set."""
    missing = [
        each.colors for each in step.choices if isinstance(each, CornerSet) and each.colors not in colors
    ]
    if not missing:
        return step
    return Step("combine", ("rgb",), (draft.number(missing[0].otherwise),) * 3, step.output)
