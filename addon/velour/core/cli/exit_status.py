"""Exit statuses of verbs."""

DONE, FAILED, UNFINISHED, INTERRUPTED = 0, 1, 3, 130


class UnfinishedError(Exception):
    """The message says how far the render got, and where its samples are."""
