"""Makes the library's program of a draft."""

from ...native import Instruction, Output, Program
from ..image_nodes import Coordinates
from .draft import CornerSet, ImageNumber, UvSet


def sources_of_draft(draft):
    """Coordinates and CornerColors that the program of a Draft reads."""
    named = [choice for step in draft.steps for choice in step.choices]
    maps = [Coordinates(each.coordinates) for each in named if isinstance(each, UvSet)]
    return [*maps, *(each.colors for each in named if isinstance(each, CornerSet))]


def finished(draft, maps, colors, texture):
    """The Program of a Draft.

    maps: UvMaps. colors: CornerColors by set. texture: makes the Texture of a Picture, of colors or numbers.
    """
    images, numbers = [], {}
    for step in draft.steps:
        for choice in step.choices:
            if isinstance(choice, ImageNumber) and choice not in numbers:
                numbers[choice] = len(images)
                images.append(texture(choice.picture, choice.is_color))

    def number(choice):
        if isinstance(choice, UvSet):
            return maps.number(choice.coordinates)
        if isinstance(choice, CornerSet):
            return colors.index(choice.colors) if choice.colors in colors else 0
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
        for step in draft.steps
    ]
    outputs = [Output(register(value.first), kind) for value, kind in draft.outputs]
    return Program.new(
        constants + draft.registers, draft.constants, instructions, outputs, images, draft.width
    )
