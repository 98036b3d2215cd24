#!/usr/bin/python3
"""All walks through the scene are the loop of src/transport/Walk.h: what another one would need is called in few places of src/.

  sampleFlight, sampleBsdf   draw the next step by the scene's own distributions, which is what steps are for.
  regionBeyond               follows a way into the region behind a surface.
  geometry->intersect        traces a ray to the next surface; in a loop only where no light is followed.

The places that have a good reason are named below with it. Exits with 1 and names file and line of every other one, and what is named below
but is no longer there."""

import re
import sys
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[2]

STEPS = "steps of walks"
PLACES = {
    "sampleFlight": {"src/transport/PlainSteps.h": STEPS},
    "sampleBsdf": {"src/transport/Walk.h": STEPS},
    "regionBeyond": {
        "src/transport/Walk.h": STEPS,
        "src/path/StepsToEmitter.cpp": "the region that a guided surface scatters back into, before a direction is drawn",
        "src/transport/Vertex.cpp": "the region of a connection",
        "src/transport/EscapeModels.cpp": "what lies behind the boundary of a body, on a straight way",
        "src/photon/primitives/sliced/SliceBuilder.cpp": "the medium on the side where a surface starts a chain of flights",
        "src/photon/light/RecordImportance.cpp": "what lies behind what lets light pass, on a straight way",
    },
    "geometry->intersect": {
        "src/transport/PlainSteps.h": STEPS,
        "src/path/StepsToEmitter.cpp": STEPS,
        "src/photon/light/StepsToCamera.cpp": STEPS,
        "src/path/PathVisitor.cpp": "the first way, which is given, of a walk that is aimed through a wall",
        "src/path/techniques/LightVertices.cpp": "a single step, from a light to the first surface",
        "src/path/techniques/GlossyLightVertices.cpp": "a single step, from there to the next surface",
        "src/path/techniques/RefractiveConnections.cpp": "its loop",
        "src/transport/EscapeModels.cpp": "its loops",
        "src/photon/PhotonSettings.cpp": "its loop",
        "src/photon/light/RecordImportance.cpp": "its loop",
    },
}
#: How many geometry->intersect have a loop around them, and what it does.
IN_LOOPS = {
    "src/path/techniques/RefractiveConnections.cpp": (1, "indexTowards: refractive indices along a straight line"),
    "src/transport/EscapeModels.cpp": (2, "findBoundary, addOuterDepth: the boundary of a body on a straight line, and the layers behind it"),
    "src/photon/light/RecordImportance.cpp": (1, "segmentToCamera: what a straight line passes"),
    "src/photon/PhotonSettings.cpp": (1, "depthOf: single rays, all over the image"),
}

# What may hold braces, quotes and semicolons without being code.
NOT_CODE = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'', re.DOTALL)
DIGITS = re.compile(r"(?<=\d)'(?=\d)")
PAIRS = {"(": ")", "{": "}", "[": "]"}
HEAD = re.compile(r"(for|while|switch|if(?:\s+constexpr)?)\s*(?=\()")


def code_of(text):
    """The text with blanks for comments and strings, so that what is left keeps its line."""
    return NOT_CODE.sub(lambda match: re.sub(r"[^\n]", " ", match.group()), DIGITS.sub(" ", text))


def calls(code, name):
    """Where a function is called; a dot will do for an arrow in its name."""
    pattern = r"\s*".join(r"(?:->|\.)" if part == "->" else part for part in re.split("(->)", name))
    return [match.start() for match in re.finditer(rf"\b{pattern}\s*\(", code)]


def bracket_end(code, at):
    """Behind the bracket that closes the one at this place."""
    depth = 0
    for place in range(at, len(code)):
        depth += (code[place] in PAIRS) - (code[place] in PAIRS.values())
        if depth == 0:
            return place + 1
    return len(code)


def statement_end(code, at):
    """Behind the statement that starts here."""
    at += len(code[at:]) - len(code[at:].lstrip())
    if code.startswith("{", at):
        return bracket_end(code, at)
    if head := HEAD.match(code, at):
        end = statement_end(code, bracket_end(code, head.end()))
        other = re.compile(r"\s*else\b").match(code, end)
        return statement_end(code, other.end()) if head[1].startswith("if") and other else end
    while at < len(code) and code[at] != ";":
        at = bracket_end(code, at) if code[at] in PAIRS else at + 1
    return at + 1


def loops(code):
    """(begin, end) of every for, while and do."""
    for match in re.finditer(r"\b(?:(?:for|while)\s*(?=\()|do\b)", code):
        yield match.start(), statement_end(code, match.end() if match.group() == "do" else match.start())


def offences(name, text):
    """Of one file."""
    code = code_of(text)
    line = lambda place: code.count("\n", 0, place) + 1
    found = []
    for called, places in PLACES.items():
        there = calls(code, called)
        if name not in places:
            found += [f"{name}:{line(place)}: {called} is for steps of walks (src/transport/Walk.h)" for place in there]
        elif not there:
            found.append(f"{name}: {called} is no longer called: take it off the list")
    spans = list(loops(code))
    looping = [place for place in calls(code, "geometry->intersect") if any(begin < place < end for begin, end in spans)]
    allowed, _ = IN_LOOPS.get(name, (0, ""))
    if len(looping) > allowed:
        found += [f"{name}:{line(place)}: rays in a loop: a walk is steps and a visitor of src/transport/Walk.h" for place in looping]
    if len(looping) < allowed:
        found.append(f"{name}: only {len(looping)} of {allowed} rays are in loops: correct the list")
    return found


def check_itself():
    """A scan that finds nothing would pass for ever."""
    single = "src/path/techniques/LightVertices.cpp"
    for loop in ("while (alive) {\n  ray = go(scene.geometry->intersect(ray));\n}",
                 "for (;;)\n  if (alive)\n    hit = scene.geometry->intersect(ray);",
                 "while (const auto hit =\n  scene_->geometry->intersect(ray)) go();",
                 "do {\n  scene.geometry.intersect(ray); } while (alive);"):
        found = offences(single, f"void follow() {{\n{loop}\n}}\n")
        assert len(found) == 1 and found[0].startswith(f"{single}:") and "in a loop" in found[0], (loop, found)
    assert not offences(single, "for (int i = 0; i < 3; ++i) count(i);\nhit = scene.geometry->intersect(ray);\n")
    found = offences("src/path/NEW.cpp", "// sampleFlight(medium)\nfloat x = sampleFlight(medium, Infinity, sampler);\n")
    assert len(found) == 1 and found[0].startswith("src/path/NEW.cpp:2: sampleFlight"), found
    assert offences(single, "") == [f"{single}: geometry->intersect is no longer called: take it off the list"]


def main():
    check_itself()
    files = [file for file in sorted((PROJECT / "src").rglob("*")) if file.suffix in {".h", ".cpp"}]
    assert len(files) > 150, "the scan finds too little"
    names = [str(file.relative_to(PROJECT)) for file in files]
    found = [each for name, file in zip(names, files) for each in offences(name, file.read_text())]
    found += [f"{name}: there is no such file: take it off the list" for places in [*PLACES.values(), IN_LOOPS] for name in places if name not in names]
    print("\n".join(found))
    return bool(found)


if __name__ == "__main__":
    sys.exit(main())
