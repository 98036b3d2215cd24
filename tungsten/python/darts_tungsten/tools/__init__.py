"""What instruments and their evaluation make of a film: SPADs, correlating cameras, times of flight. Numpy alone.

Every function takes `light`, an array whose axis 0 is time (frames, or frames x height x width), and `edges`, the frames + 1
times that its frames lie between, in any unit of time; rates and frequencies are per that unit. docs/python.md has an example.
"""

from .film import per_frame, region
from .phasors import correlation, phase_distance, phasor
from .spad import coates, counts, dead_time_rate, detect, expected_counts, jitter
from .times import mean_time, peak_time, spread

__all__ = ["coates", "correlation", "counts", "dead_time_rate", "detect", "expected_counts", "jitter", "mean_time", "peak_time",
           "per_frame", "phase_distance", "phasor", "region",
           "spread"]
