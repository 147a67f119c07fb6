"""How a verb ends."""

DONE, FAILED, UNFINISHED, INTERRUPTED = 0, 1, 3, 130


class UnfinishedError(Exception):
    """One sentence: how far the render came, and where that lies."""
