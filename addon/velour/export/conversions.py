"""Conversion of values between types of sockets, as Cycles converts them."""

from itertools import pairwise

import bpy
import numpy as np

from .color import luminance_weights
from .plugs import INLINES, followed, is_passed_through, is_within_tree, types_between

_NUMBERS = ("VALUE", "INT", "BOOLEAN")
_EQUAL = (1.0 / 3.0,) * 3
# What sockets of groups for truth values make of numbers; no property reveals it.
_BOOLEANS = "true" if INLINES else "whole" if bpy.app.version >= (4, 0) else "lost"


def is_number(kind):
    """Whether sockets of this type hold one number."""
    return kind in _NUMBERS


def converted(draft, value, types):
    """The Value of a socket of the first type after conversion to each type in turn."""
    for given, asked in pairwise(types):
        if value.first < 0:
            value = draft.constant(_converted(draft.constants_of(value), given, asked))
            continue
        if is_number(given) and not is_number(asked):
            value = draft.joined(value, value, value)
        elif is_number(asked) and not is_number(given):
            value = draft.vector_math("dot_product", value, draft.vector(_weights(given)))[1]
        if asked == "INT" or (asked == "BOOLEAN" and _BOOLEANS == "whole"):
            value = draft.math("trunc", value)
        elif asked == "BOOLEAN":
            value = draft.math("greater_than", value, 0.0) if _BOOLEANS == "true" else draft.number(0.0)
    return value


def _converted(numbers, given, asked):
    """Like converted(), for one or three numbers."""
    if is_number(given) and not is_number(asked):
        return numbers * 3
    if is_number(asked) and not is_number(given):
        numbers = (sum(float(w) * c for w, c in zip(_weights(given), numbers, strict=True)),)
    if asked == "INT" or (asked == "BOOLEAN" and _BOOLEANS == "whole"):
        return (float(np.trunc(numbers[0])),)
    if asked == "BOOLEAN":
        return (float(_BOOLEANS == "true" and numbers[0] > 0.0),)
    return numbers


def _weights(kind):
    return luminance_weights() if kind == "RGBA" else _EQUAL


def luminance_of(draft, color):
    return draft.vector_math("dot_product", color, draft.vector(luminance_weights()))[1]


def own_numbers(plug):
    """Tuple of one or three numbers: the value of an input that no node feeds, or that of a Value or RGB node
    that feeds it, as its type."""
    source = followed(plug) or plug
    if source == plug:
        return numbers_of(plug.socket)
    if not source.socket.is_output and is_passed_through(source.node):
        own = numbers_of(plug.socket)
        return own if INLINES and is_within_tree(plug) else (0.0,) * len(own)
    numbers = numbers_of(source.socket)
    for given, asked in pairwise(types_between(plug)):
        numbers = _converted(numbers, given, asked)
    return numbers


def numbers_of(socket):
    """Tuple of one or three numbers: a socket's own value."""
    value = getattr(socket, "default_value", 0.0)
    return tuple(map(float, value[:3])) if hasattr(value, "__len__") else (float(value),)
