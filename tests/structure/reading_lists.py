#!/usr/bin/python3
"""The lists of files to read in docs/architecture.md follow the program, and are short. A list is the numbered lines below a heading
"Files to read: ...". Each line begins with a file and names in it, in backticks, what to read there:

    2. `src/path/PathTarget.cpp`: `TargetChoice`, which point of a light the path aims at.

A file and the header or source of the same name beside it are one. The file exists and defines each name, and, but for the first, at least one of
the names is used in a file of the list that comes before. Exits with 1 and says which lines of the page are wrong, and why."""

import re
import sys
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[2]
PAGE = "docs/architecture.md"
#: How many files each list has at most.
MOST = {"Files to read: from a scene file to an output file": 20, "Files to read: a guided photon": 16, "Files to read: a guided camera path": 13}

LINE = re.compile(r"(\d+)\. `([\w/.]+)`: (.*)")
COMMENT = re.compile(r"//[^\n]*")


def lists(page):
    """By heading: (line of the page, number, file, names)."""
    found, heading = {}, None
    for number, line in enumerate(page.splitlines(), 1):
        if line.startswith("#"):
            heading = line.lstrip("# ")
        elif heading in MOST and re.match(r"\d+\. ", line):
            match = LINE.fullmatch(line)
            assert match, f"{PAGE}:{number}: not '1. `FILE`: `NAME`, ...'"
            found.setdefault(heading, []).append((number, int(match[1]), match[2], re.findall(r"`(\w+)`", match[3])))
    return found


def text_of(name):
    """Without comments, of both files."""
    path = PROJECT / name
    both = [path.with_suffix(suffix) for suffix in (".h", ".cpp")]
    return "".join(COMMENT.sub("", file.read_text()) for file in both if file.exists())


def defines(text, name):
    """A class, a constant, or a function: at the start of a line, behind a type."""
    return re.search(rf"\b(class|struct) {name}\b[^;(]*{{|^extern const \w+ {name}\b|^(?! *return\b) *[\w:<>,&*\[\] ]*[\w>&*\]] [&*]?(\w+(<\w+>)?::)*{name}\(", text, re.MULTILINE)


def wrong(page):
    """A line for everything that is wrong in the lists of a page."""
    found = lists(page)
    for heading in MOST:
        before = ""
        files = found.get(heading, [])
        if not files:
            yield f"{PAGE}: no list below '{heading}'"
        if len(files) > MOST[heading]:
            yield f"{PAGE}: {len(files)} files below '{heading}', at most {MOST[heading]}"
        for place, (line, number, file, names) in enumerate(files, 1):
            told = f"{PAGE}:{line}: {file}"
            if number != place:
                yield f"{told} has number {number} instead of {place}"
            if not (PROJECT / file).exists():
                yield f"{told} does not exist"
                continue
            text = text_of(file)
            for name in names:
                if not defines(text, name):
                    yield f"{told} does not define {name}"
            if place > 1 and not any(re.search(rf"\b{name}\b", before) for name in names):
                yield f"{told}: no file before it uses {' or '.join(names) or 'what it has'}"
            before += text


def check_itself():
    """Lists with something wrong in them are found to be wrong."""
    def told(*lines):
        return list(wrong("".join(f"### {heading}\n\n" + "\n".join(lines) + "\n" for heading in MOST)))[:1]

    first, second = "1. `src/path/PathTracer.cpp`: `renderPass`, all of it.", "2. `src/path/PixelAccumulator.h`: `PixelAccumulator`."
    assert told(first, second) == []
    assert "NOWHERE.h does not exist" in told(first, "2. `src/path/NOWHERE.h`: `PixelAccumulator`.")[0]
    assert "does not define Sink" in told(first, "2. `src/path/PixelAccumulator.h`: `Sink`.")[0]
    assert "does not define pollWithin" in told(first, "2. `src/path/PathTracer.cpp`: `pollWithin`, which it calls.")[0]
    assert "no file before it uses LightTracer" in told(first, "2. `src/path/light/LightTracer.h`: `LightTracer`.")[0]
    assert "no file before it uses Walk" in told("1. `src/path/PixelAccumulator.h`: `PixelAccumulator`.", "2. `src/transport/Walk.h`: `Walk`.")[0]
    assert "no file before it uses what it has" in told(first, "2. `src/path/PixelAccumulator.h`: frames.")[0]
    assert "instead of 2" in told(first, second.replace("2.", "3."))[0]
    assert "at most 20" in told(first, *(f"{i}. `src/path/PixelAccumulator.h`: `PixelAccumulator`." for i in range(2, 28)))[0]
    assert "no list below" in told()[0]


def main():
    check_itself()
    found = list(wrong((PROJECT / PAGE).read_text()))
    print("\n".join(found))
    return bool(found)


if __name__ == "__main__":
    sys.exit(main())
