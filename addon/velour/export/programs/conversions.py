"""Conversion of values between types of sockets, as Cycles converts them."""

from itertools import pairwise

from ..color import luminance_weights
from ..plugs import followed, is_passed_through, types_between

_NUMBERS = ("VALUE", "INT", "BOOLEAN")
_EQUAL = (1.0 / 3.0,) * 3


def is_number(kind):
    """Whether sockets of this type hold one number."""
    return kind in _NUMBERS


def converted(draft, value, types):
    """The Value of a socket of the first type after conversion to each type in turn."""
    for given, asked in pairwise(types):
        if is_number(given) == is_number(asked):
            continue
        if value.first < 0:
            value = draft.constant(_converted(draft.constants_of(value), given, asked))
        elif is_number(given):
            value = draft.joined(value, value, value)
        else:
            value = draft.vector_math("dot_product", value, draft.vector(_weights(given)))[1]
    return value


def _converted(numbers, given, asked):
    """Like converted(), for one or three numbers."""
    if is_number(given) == is_number(asked):
        return numbers
    if is_number(given):
        return numbers * 3
    return (sum(float(w) * c for w, c in zip(_weights(given), numbers, strict=True)),)


def _weights(kind):
    return luminance_weights() if kind == "RGBA" else _EQUAL


def luminance_of(draft, color):
    return draft.vector_math("dot_product", color, draft.vector(luminance_weights()))[1]


def own_numbers(plug):
    """Tuple of one or three numbers: the value of an input that no node feeds, or that of a Value or RGB node
    that feeds it, as its type."""
    source = followed(plug)
    types = types_between(plug) if source else [plug.socket.type]
    numbers = numbers_of((source or plug).socket)
    for given, asked in pairwise(types):
        numbers = _converted(numbers, given, asked)
    return numbers


def numbers_of(socket):
    """Tuple of one or three numbers: a socket's own value."""
    value = getattr(socket, "default_value", 0.0)
    numbers = tuple(map(float, value[:3])) if hasattr(value, "__len__") else (float(value),)
    is_zero = not socket.is_output and is_passed_through(socket.node)
    return (0.0,) * len(numbers) if is_zero else numbers
