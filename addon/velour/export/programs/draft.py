"""A program under construction."""

from typing import NamedTuple

MOST_OUTPUTS = 16  # SurfaceSite::kMaxComputed
MOST_INSTRUCTIONS = 2048  # nested groups may share nodes many times


class Value(NamedTuple):
    """Registers of a value: 1 or 3. Constants count down from -1, so that none is renumbered later."""

    first: int
    size: int

    def component(self, i):
        return Value(self.first - i if self.first < 0 else self.first + i, 1)


class UvSet(NamedTuple):
    """A UV map in place of its number."""

    coordinates: str  # name; empty: the active render map


class CornerSet(NamedTuple):
    """CornerColors in place of the number of their set."""

    colors: object


class ImageNumber(NamedTuple):
    """A Picture in place of its number; read as a color or as a number."""

    picture: object
    is_color: bool


class Step(NamedTuple):
    operation: str
    choices: tuple  # names, numbers, and the types above
    inputs: tuple  # Values
    output: int
    table: tuple = ()


class Computed(NamedTuple):
    """An output of a material's program, in place of a picture."""

    draft: object
    index: int


class Draft:
    """Steps in the order of evaluation; equal constants and equal steps occur once."""

    def __init__(self):
        self.constants = []
        self.steps = []
        self.outputs = []  # (Value, kind)
        self.registers = 0  # written by steps
        self.relief_maps = []  # UV maps of the tangents of normal maps
        self.width = None  # distance of shifted points in pixels; None: no bump
        self._places = {}
        self._done = {}

    def number(self, value):
        """A constant."""
        return self.constant((float(value),))

    def vector(self, values):
        """A constant of three."""
        return self.constant(tuple(float(v) for v in values[:3]))

    def constant(self, values):
        """A constant of a tuple of one or three numbers."""
        if values not in self._places:
            self._places[values] = -1 - len(self.constants)
            self.constants += values
        return Value(self._places[values], len(values))

    def constants_of(self, value):
        """Tuple of the numbers of a constant Value."""
        return tuple(self.constants[-1 - value.first :][: value.size])

    def step(self, operation, inputs, sizes, choices=(), table=()):
        """Adds a step; the Values of its outputs, of these sizes."""
        key = operation, tuple(inputs), tuple(choices), tuple(table)
        if key not in self._done:
            self._done[key] = self.registers
            self.steps.append(Step(operation, tuple(choices), tuple(inputs), self.registers, tuple(table)))
            self.registers += sum(sizes)
        first, found = self._done[key], []
        for size in sizes:
            found.append(Value(first, size))
            first += size
        return found

    def one(self, operation, inputs, size=1, choices=(), table=()):
        """Like step(), for a single output."""
        return self.step(operation, inputs, (size,), choices, table)[0]

    def source(self, kind, number=0, shift="none"):
        return self.one("source", (), 3, (kind, number, shift))

    def math(self, operation, *values):
        """The result of a Math operation, unclamped. Numbers are constants."""
        values = [v if isinstance(v, Value) else self.number(v) for v in values]
        values += [self.number(0.0)] * (3 - len(values))
        return self.one("math", values, 1, (operation, 0))

    def vector_math(self, operation, *vectors, scale=1.0):
        """Vector and number of a Vector Math operation."""
        vectors = list(vectors) + [self.vector((0, 0, 0))] * (3 - len(vectors))
        scale = scale if isinstance(scale, Value) else self.number(scale)
        return self.step("vector_math", (*vectors, scale), (3, 1), (operation,))

    def joined(self, *numbers):
        """A vector of three numbers."""
        return self.one("combine", numbers, 3, ("rgb",))

    def output(self, value, kind):
        """The Computed of a value; None if there are too many."""
        if (value, kind) not in self.outputs:
            if len(self.outputs) == MOST_OUTPUTS:
                return None
            self.outputs.append((value, kind))
        return Computed(self, self.outputs.index((value, kind)))
