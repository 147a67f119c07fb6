"""Values that are computed at each point of a surface."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from ctypes import addressof, byref, c_void_p
from typing import NamedTuple

import numpy as np

from . import structs, table
from .arrays import checked, pointer
from .handle import Handle, choice
from .texture import Texture

# Names of the choices of each operation, in order; None: a number.
_CHOICES = {
    "source": (table.SOURCES, None, table.SHIFTS),
    "math": (table.MATH,),
    "vector_math": (table.VECTOR_MATH,),
    "mix_color": (table.BLENDS,),
    "combine": (table.COLOR_MODELS,),
    "separate": (table.COLOR_MODELS,),
    "map_range": (table.RANGES,),
    "map_range_vector": (table.RANGES,),
    "mapping": (table.MAPPINGS,),
    "noise": (None, table.NOISES),
    "voronoi": (None, table.VORONOI_FEATURES, table.METRICS),
    "wave": (None, table.WAVE_AXES, table.WAVE_PROFILES),
    "gradient": (table.GRADIENTS,),
}


class Instruction(NamedTuple):
    """See vlr_instruction. Choices are names or numbers; `table`: floats."""

    operation: str
    choices: tuple
    inputs: tuple
    output: int
    table: object = ()


class Output(NamedTuple):
    """A value that a program returns. kind: color, number, normal."""

    first: int
    kind: str


class Program(Handle):
    """Immutable; its textures replace parameters of materials."""

    _free_name = "vlr_program_free"

    @classmethod
    def new(
        cls,
        registers: int,
        constants: Sequence[float],
        instructions: Sequence[Instruction],
        outputs: Sequence[Output],
        images: Sequence[Texture] = (),
        step: float = 1.0,
    ) -> Program:
        """`constants`: values of the first registers; instructions write the others, each once."""
        values = checked("constants", np.asarray(constants, np.float32), (None,))
        tables = [np.asarray(each.table, np.float32).ravel() for each in instructions]
        starts = np.cumsum([0, *(len(each) for each in tables)])
        floats = np.concatenate([*tables, np.zeros(0, np.float32)])
        converted = (structs.Instruction * len(instructions))()
        for at, each, start, floats_of in zip(converted, instructions, starts, tables, strict=False):
            _fill(at, each, int(start), len(floats_of))
        returned = (structs.ProgramOutput * len(outputs))(
            *(structs.ProgramOutput(each.first, choice("kind", each.kind, table.VALUES)) for each in outputs)
        )
        pictures = (c_void_p * len(images))(*(image.pointer for image in images))
        desc = structs.ProgramDesc(
            registers=registers,
            constant_count=len(values),
            instruction_count=len(instructions),
            table_count=len(floats),
            image_count=len(images),
            output_count=len(outputs),
            step=step,
            constants=values.ctypes.data,
            instructions=addressof(converted),
            tables=floats.ctypes.data,
            images=addressof(pictures),
            outputs=addressof(returned),
        )
        return cls._create("vlr_program_create", byref(desc))

    def texture(self, output: int) -> Texture:
        """An output in place of an image."""
        return Texture._create("vlr_texture_of_program", self.pointer, output)

    def radiance(self, output: int, rays: str, directions: np.ndarray) -> np.ndarray:
        """Radiance [n x 3] of a world in unit directions [n x 3]; rays: others, camera, shadow."""
        directions = checked("directions", directions, (None, 3))
        found = np.empty_like(directions)
        kind = choice("rays", rays, table.WORLD_RAYS)
        self._lib.vlr_program_radiance(
            self.pointer, output, kind, len(directions), pointer(directions), pointer(found)
        )
        return found


def _fill(at: structs.Instruction, given: Instruction, start: int, size: int) -> None:
    at.operation = choice("operation", given.operation, table.OPERATIONS)
    names = _CHOICES.get(given.operation, ())
    for i, value in enumerate(given.choices):
        of = names[i] if i < len(names) else None
        at.choice[i] = int(value) if of is None else choice(f"{given.operation} choice {i}", value, of)
    at.input = (ctypes.c_uint32 * 12)(*given.inputs)
    at.output, at.table, at.table_size = given.output, start if size else 0, size
