"""Which tests run: all (scripts/test --all), or the short suite. No Blender is needed to import this."""

import os

LONG = bool(os.environ.get("VELOUR_LONG_TESTS"))

REASON = "long: scripts/test --all runs it"
