#!/usr/bin/python3
"""How much the sampling decides by rules: constants that were tuned, switches of the library, reasons that plans give. Prints the figures,
and exits with 1 where one is above its cap; what deletes some lowers the cap with them.

  constants   lines of `inline constexpr` in the Tuning.h of paths, photon maps and what they share
  switches    booleans of darts::Settings
  reasons     what plans return with a reason: `{on, "why"}`, or an obstacle in words"""

import re
import sys
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[2]

TUNING = ["src/path/Tuning.h", "src/photon/Tuning.h", "src/transport/Tuning.h"]
PLANS = ["src/path/PathPlan.cpp", "src/photon/PhotonPlan.cpp", "src/photon/primitives/sliced/Slices.cpp",
         "src/transport/GuidancePlan.cpp"]
#: Today's figures, and what they are to come down to.
CAPS = {"constants": 38, "switches": 2, "reasons": 30}
GOALS = {"constants": 40, "switches": 2, "reasons": 30}

REASONED = re.compile(r'return\s+(?:\{\s*(?:true|false|on|any)\s*,|")')


def lines(path, pattern):
    return len(re.findall(pattern, (PROJECT / path).read_text(), re.MULTILINE))


def settings():
    text = (PROJECT / "src/darts/Settings.h").read_text()
    return re.search(r"^struct Settings \{$.*?^\};$", text, re.MULTILINE | re.DOTALL).group()


def figures():
    return {"constants": sum(lines(path, r"^inline constexpr\b") for path in TUNING),
            "switches": len(re.findall(r"^ {4}bool \w+", settings(), re.MULTILINE)),
            "reasons": sum(len(REASONED.findall((PROJECT / path).read_text())) for path in PLANS)}


def check_itself():
    """A scan that finds nothing would pass for ever."""
    sample = 'return {false, "so"};\nreturn {\n  on, x};\nreturn "why";\nreturn {};\nreturn plan;\nreturn {gate, 1};'
    assert len(REASONED.findall(sample)) == 3, REASONED.findall(sample)


check_itself()
failed = False
for name, found in figures().items():
    over = found > CAPS[name]
    failed = failed or over
    print(f"{name:10}{found:4}, at most {CAPS[name]}" + (f": {found - CAPS[name]} too many" if over else "") + f" (goal {GOALS[name]})")
sys.exit(failed)
