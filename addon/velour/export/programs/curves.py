"""Tables of Blender's ramps and curves, at the places where Cycles reads them."""

_ROWS = 256  # RAMP_TABLE_SIZE of Cycles, which adds one for curves


def ramp_table(ramp):
    """Flat RGBA rows from 0 to 1."""
    return tuple(value for i in range(_ROWS) for value in ramp.evaluate(i / (_ROWS - 1)))


def curve_range(mapping, count):
    """First and last place at which any of the first `count` curves has a point."""
    curves = [mapping.curves[i] for i in range(count)]
    return (
        min(curve.points[0].location[0] for curve in curves),
        max(curve.points[len(curve.points) - 1].location[0] for curve in curves),
    )


def curve_values(mapping, count):
    """Values of a single curve at even places from 0 to 1."""
    mapping.initialize()
    return [mapping.evaluate(mapping.curves[0], i / (count - 1)) for i in range(count)]


def curve_table(mapping, low, high, combined=None):
    """Flat rows of three curves; of one, if there are fewer. `combined`: number of a curve before them."""
    mapping.initialize()
    curves = [mapping.curves[i if len(mapping.curves) > 2 else 0] for i in range(3)]
    found = []
    for i in range(_ROWS + 1):
        place = low + i / _ROWS * (high - low)
        if combined is not None:
            place = mapping.evaluate(mapping.curves[combined], place)
        found += [mapping.evaluate(curve, place) for curve in curves]
    return tuple(found)
