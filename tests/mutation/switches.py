"""Rewrites sources so that one build holds all planted faults: the smallest expression E around a fault becomes
(plantedFault(N) ? (E with the fault) : (E)), or the statements around it an if with both; PLANTED_FAULT=N chooses one at run time."""

import re

# What may hold brackets, commas and semicolons without being code.
NOT_CODE = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'', re.DOTALL)
DIGITS = re.compile(r"(?<=\d)'(?=\d)")
# What ends an expression on its left or right, besides brackets; a lone = or +=, no comparison.
BORDER = re.compile(r"[;,]|(?<![=!<>])(?:[-+*/%|&^]|<<|>>)?=(?!=)|\breturn\b|\belse\b")
TOKEN = re.compile(r"\w+(?:\.\w+)*|\s+|.", re.DOTALL)
BRACKETS = {")": "(", "]": "[", "}": "{"}

HEADER = """#pragma once
#include <cstdlib>

namespace planted {
inline int chosen()
{
  const char* text = std::getenv("PLANTED_FAULT");
  return text ? std::atoi(text) : -1;
}
inline const int Fault = chosen();
} // namespace planted

inline bool plantedFault(int number) { return planted::Fault == number; }
"""


class Unswitchable(ValueError):
    """A fault that no expression and no statement holds; its text says why."""


def code_of(text):
    """The text at the same places, with comments and directives blanked, and of strings and characters nothing but that they are there."""
    def blank(match):
        return re.sub(r"[^\n]", " " if match.group().lstrip()[0] in "/#" else "x", match.group())

    return re.sub(r"(?m)^[ \t]*#(?:\\\n|[^\n])*", blank, NOT_CODE.sub(blank, DIGITS.sub("x", text)))


def groups_of(code):
    """(place of the opening bracket, place of the closing one), inner groups before outer ones."""
    opened, found = [], []
    for at, sign in enumerate(code):
        if sign in "([{":
            opened.append(at)
        elif sign in BRACKETS:
            if not opened or code[opened[-1]] != BRACKETS[sign]:
                raise Unswitchable("brackets do not match")
            found.append((opened.pop(), at))
    return found


def difference(good, bad):
    """How much of both, in whole tokens, is the same at the beginning and at the end."""
    one, other = TOKEN.findall(good), TOKEN.findall(bad)
    before = 0
    while before < min(len(one), len(other)) and one[before] == other[before]:
        before += 1
    after = 0
    while after < min(len(one), len(other)) - before and one[-1 - after] == other[-1 - after]:
        after += 1
    return sum(map(len, one[:before])), sum(map(len, one[len(one) - after:]))


def controls(code, close):
    """Whether the bracket closed here holds the condition of an if, for, while or switch."""
    depth = 0
    for at in range(close, -1, -1):
        depth += (code[at] == ")") - (code[at] == "(")
        if depth == 0:
            return re.search(r"\b(if|for|while|switch|constexpr)\s*$", code[:at]) is not None
    return False


def borders(code, groups, group):
    """Places in this group, in none inside it, where an expression or a statement begins or ends: (end of the left, begin of the right, sign)."""
    first, last = group
    flat = list(code[first + 1:last])
    found = []
    for open_, close in reversed(groups):  # outer ones before inner ones
        if not first < open_ < close < last or flat[open_ - first - 1] == "\0":
            continue
        flat[open_ - first - 1:close - first] = "\0" * (close - open_ + 1)
        if code[close] == "}" and code[first] == "{":
            found.append((close + 1, close + 1, "}"))
        elif code[close] == ")" and controls(code, close):
            found.append((close + 1, close + 1, ")"))
    flat = "".join(flat)
    found += [(match.start() + first + 1, match.end() + first + 1, match.group()) for match in BORDER.finditer(flat)]
    return sorted(found)


def around(text, begin, end):
    """The smallest range around [begin, end) that is an expression or whole statements: (first, last, whether it is statements)."""
    code = code_of(text)
    groups = groups_of(code)
    holding = [group for group in groups if group[0] < begin and end <= group[1]]
    for group in holding:
        marks = borders(code, groups, group)
        inside = [mark for mark in marks if begin < mark[1] and mark[0] < end]
        left = max([mark[1] for mark in marks if mark[1] <= begin], default=group[0] + 1)
        right = min([mark[0] for mark in marks if mark[0] >= end], default=group[1])
        signs = {sign for _, sign in [(0, mark[2]) for mark in marks if mark[1] == left or mark[0] == right]}
        block = code[group[0]] == "{" and any(sign in ";})" or sign == "else" for sign in signs | {mark[2] for mark in inside})
        if not inside and not (block and statement_begins(code, group, marks, left)):
            return trimmed(code, left, right) + (False,)
        if block:
            starts = [mark[1] for mark in marks if mark[2] in ";})" or mark[2] == "else"]
            left = max([start for start in starts if start <= begin], default=group[0] + 1)
            right = min([mark[1] for mark in marks if mark[2] in ";}" and mark[1] >= end], default=group[1])
            return trimmed(code, left, right) + (True,)
    raise Unswitchable("outside every function")


def statement_begins(code, group, marks, left):
    """Whether what begins here is a statement of its own rather than the right side of = or return."""
    return left == group[0] + 1 or any(mark[1] == left and (mark[2] in ";})" or mark[2] == "else") for mark in marks)


def trimmed(code, first, last):
    while first < last and code[first].isspace():
        first += 1
    while last > first and code[last - 1].isspace():
        last -= 1
    return first, last


def switched(text, faults):
    """The text with a switch for each of (number, good, bad)."""
    ranges = []
    for number, good, bad in faults:
        if text.count(good) != 1:
            raise Unswitchable(f"'{good}' is there {text.count(good)} times")
        at = text.index(good)
        before, after = difference(good, bad)
        first, last, whole = around(text, at + before, at + len(good) - after)
        ranges.append([first, last, whole, [(number, at, good, bad)]])
    merged = []
    for one in sorted(ranges, key=lambda range_: range_[:2]):
        if merged and one[0] < merged[-1][1]:
            merged[-1][1] = max(merged[-1][1], one[1])
            merged[-1][2] |= one[2]
            merged[-1][3] += one[3]
        else:
            merged.append(one)
    for first, last, whole, planted in reversed(merged):
        text = text[:first] + choice(text, first, last, whole, planted) + text[last:]
    return text


def choice(text, first, last, whole, planted):
    good = text[first:last]
    result = f"{{ {good} }}" if whole else f"({good})"
    for number, at, old, new in planted:
        before, after = difference(old, new)
        bad = text[first:at + before] + new[before:len(new) - after] + text[at + len(old) - after:last]
        if whole:
            result = f"if (plantedFault({number})) {{ {bad} }} else {result}"
        else:
            result = f"(plantedFault({number}) ? ({bad}) : {result})"
    return result
