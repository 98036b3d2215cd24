"""A time-of-flight renderer; see docs/python.md."""

import sys

from ._native import *  # noqa: F401, F403
from ._native import __version__, sampling

sys.modules[__name__ + ".sampling"] = sampling  # so that `import darts_tungsten.sampling` finds it
