"""Conversion of values between types of sockets, as Cycles converts them."""

from ..color import luminance_weights

_NUMBERS = ("VALUE", "INT", "BOOLEAN")
_EQUAL = (1.0 / 3.0,) * 3


def is_number(kind):
    """Whether sockets of this type hold one number."""
    return kind in _NUMBERS


def converted(draft, value, given, asked):
    """The Value of a socket of type `given`, as a socket of type `asked`."""
    if is_number(given) == is_number(asked):
        return value
    if is_number(given):
        return draft.joined(value, value, value)
    weights = luminance_weights() if given == "RGBA" else _EQUAL
    return draft.vector_math("dot_product", value, draft.vector(weights))[1]


def luminance_of(draft, color):
    return draft.vector_math("dot_product", color, draft.vector(luminance_weights()))[1]


def own(draft, socket, asked):
    """A socket's own value as a constant of type `asked`."""
    value = getattr(socket, "default_value", 0.0)
    if not hasattr(value, "__len__"):
        constant = draft.number(value)
        return constant if is_number(asked) else draft.vector((value,) * 3)
    if not is_number(asked):
        return draft.vector(value)
    weights = luminance_weights() if socket.type == "RGBA" else _EQUAL
    return draft.number(sum(w * c for w, c in zip(weights, value, strict=False)))
