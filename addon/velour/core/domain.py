"""When a model that was reduced to what scenes show may be used: one rule for all who render."""

LARGEST_SHARE = 1e-3  # of the weight of what a frame shows of a material, outside of its model's domain


def inside(share: float) -> bool:
    """Whether a frame with that share outside may be rendered with the reduced model."""
    return share <= LARGEST_SHARE
