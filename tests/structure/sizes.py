#!/usr/bin/python3
"""Files of src/ and tungsten/ have up to 600 lines, functions up to 80. Exits with 1 and names every one that has more; --longest N lists
the longest of either instead."""

import re
import sys
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[2]
MOST_LINES, MOST_FUNCTION = 600, 80

# What may hold braces, quotes and semicolons without being code.
NOT_CODE = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'', re.DOTALL)
DIRECTIVE = re.compile(r"^[ \t]*#(?:\\\n|[^\n])*", re.MULTILINE)
DIGITS = re.compile(r"(?<=\d)'(?=\d)")


def blank(match):
    return re.sub(r"[^\n]", " ", match.group())


def functions(text):
    """(first line, last line, heading) of what has a body at the level of namespaces and classes."""
    code = DIRECTIVE.sub(blank, NOT_CODE.sub(blank, DIGITS.sub(" ", text)))
    scopes, begin = [], 0  # per open brace: where its function's heading begins, True in a namespace or class, else None
    for brace in re.finditer(r"[{};]", code):
        at = brace.start()
        outside = all(scope is True for scope in scopes)
        if brace.group() == "{":
            heading = code[begin:at]
            if outside and re.search(r"\b(namespace|class|struct|union|enum|extern)\b[^()=]*$", heading):
                scopes.append(True)
            else:
                scopes.append(begin if outside else None)
        elif brace.group() == "}" and scopes:
            opened = scopes.pop()
            if type(opened) is int:
                start = opened + len(code[opened:]) - len(code[opened:].lstrip())
                yield code.count("\n", 0, start) + 1, code.count("\n", 0, at) + 1, text[start:].split("{")[0].split("\n")[0]
        if all(scope is True for scope in scopes):
            begin = at + 1


def sizes():
    """Lists of (lines, name) of files and of functions, longest first."""
    files, found = [], []
    for folder in ("src", "tungsten"):
        for path in sorted((PROJECT / folder).rglob("*")):
            if path.suffix not in {".h", ".cpp"}:
                continue
            name, text = path.relative_to(PROJECT), path.read_text()
            files.append((text.count("\n"), str(name)))
            found += [(last - first + 1, f"{name}:{first}: {heading.strip()}") for first, last, heading in functions(text)]
    return sorted(files, reverse=True), sorted(found, reverse=True)


def check_itself():
    """A scan that finds nothing would pass for ever."""
    sample = "namespace a {\nstruct B {\n  int f() const { return 1; }\n};\nint g(int x)\n{\n  if (x) {\n  }\n  return '{';\n}\n}\n"
    assert [(first, last) for first, last, _ in functions(sample)] == [(3, 3), (5, 10)], list(functions(sample))


check_itself()
of_files, of_functions = sizes()
if sys.argv[1:2] == ["--longest"]:
    for lines, name in of_files[:int(sys.argv[2])] + of_functions[:int(sys.argv[2])]:
        print(f"{lines:5} {name}")
    sys.exit()
assert len(of_files) > 300 and len(of_functions) > 1500, "the scan finds too little"
long = [f"{name}: {lines} lines, at most {MOST_LINES}" for lines, name in of_files if lines > MOST_LINES]
long += [f"{name}: {lines} lines, at most {MOST_FUNCTION}" for lines, name in of_functions if lines > MOST_FUNCTION]
print("\n".join(long))
sys.exit(bool(long))
