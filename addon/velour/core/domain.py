"""When a scene model may be used: one rule for all renders."""

LARGEST_SHARE = 1e-3  # share, by weight, of a frame's use of a material that its model was not fitted for


def inside(share: float) -> bool:
    """Whether a frame with this share outside may be rendered with the scene model."""
    return share <= LARGEST_SHARE
