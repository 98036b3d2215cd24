"""A time-of-flight renderer; see docs/python.md."""

from . import sampling  # noqa: F401
from ._native import *  # noqa: F401, F403
from ._native import __version__  # noqa: F401
