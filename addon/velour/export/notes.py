"""Messages of an export to the user."""


class ExportError(RuntimeError):
    """The scene cannot be rendered as it is. One sentence: owner, file, remedy."""


def listed(words):
    """'a', 'a and b', 'a, b and c'."""
    return " and ".join((", ".join(words[:-1]), words[-1])) if len(words) > 1 else words[0]


class Notes:
    """Sentences on what is ignored or approximated, in the order found, each once."""

    def __init__(self):
        self._sentences = {}
        self._said = 0

    def add(self, sentence):
        self._sentences[sentence] = None

    def __iter__(self):
        return iter(self._sentences)

    def __len__(self):
        return len(self._sentences)

    def unsaid(self):
        """Notes that no earlier call has returned."""
        fresh = list(self)[self._said :]
        self._said = len(self)
        return fresh
