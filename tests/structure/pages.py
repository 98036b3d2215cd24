#!/usr/bin/python3
"""Pages stay short enough to be read, and the glossary is of the code as it is: all Markdown files of the project together have at most
MOST_WORDS words, and every name in the first column of the glossary of docs/architecture.md is one of the code's. Tables that a command
makes are CSV files beside their page. `--list` prints the words of every page. Exits with 1 and says what is wrong."""

import re
import subprocess
import sys
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[2]
#: As `wc -w` counts them, bars of tables included. Lower it when pages have become shorter.
MOST_WORDS = 60000
GLOSSARY = "docs/architecture.md"


def pages():
    """Those that are committed, or about to be; without git all but those of builds."""
    listed = subprocess.run(["git", "-C", PROJECT, "ls-files", "-co", "--exclude-standard", "*.md"], capture_output=True, text=True)
    names = listed.stdout.splitlines() if listed.returncode == 0 else [
        str(path) for file in PROJECT.rglob("*.md") if not (path := file.relative_to(PROJECT)).parts[0].startswith("build")]
    return sorted(name for name in names if (PROJECT / name).is_file())


def words(text):
    return len(text.split())


def glossary_names(page):
    """In backticks in the first cells of the table below the heading."""
    part = page.split("\n## Glossary\n")[1].split("\n## ")[0] if "\n## Glossary\n" in page else ""
    return [name for row in re.findall(r"^\| *(`[^|]*)\|", part, re.MULTILINE) for name in re.findall(r"`(\w+)`", row)]


def code():
    """Without comments."""
    files = [file for folder in ("src", "tungsten") for file in sorted((PROJECT / folder).rglob("*")) if file.suffix in (".h", ".cpp")]
    return re.sub(r"//[^\n]*", "", "\n".join(file.read_text() for file in files))


def wrong(counts, page, text):
    """A line for everything that is wrong."""
    total = sum(counts.values())
    if total > MOST_WORDS:
        yield f"{len(counts)} pages have {total} words, at most {MOST_WORDS}; the longest: " + ", ".join(
            f"{name} {count}" for name, count in sorted(counts.items(), key=lambda entry: -entry[1])[:5])
    names = glossary_names(page)
    if not names:
        yield f"{GLOSSARY}: no glossary"
    known = set(re.findall(r"\w+", text))
    for name in names:
        if name not in known:
            yield f"{GLOSSARY}: the glossary has '{name}', the code has not"


def check_itself():
    """What is wrong is found."""
    table = "# A\n\n## Glossary\n\n| in the code | meaning |\n| --- | --- |\n| `Walk`, `Steps` | `none` |\n\n## B\n\n| `Other` | |\n"
    assert glossary_names(table) == ["Walk", "Steps"]
    assert list(wrong({"A": 3}, table, "class Walk; class Steps;")) == []
    assert list(wrong({"A": 3}, table, "class Walk;")) == [f"{GLOSSARY}: the glossary has 'Steps', the code has not"]
    assert f"have {MOST_WORDS + 1} words" in list(wrong({"A": MOST_WORDS, "B": 1}, table, "Walk Steps"))[0]
    assert "no glossary" in list(wrong({}, "# A\n", ""))[0]
    assert words("| a | b\n\nc") == 5


def main():
    check_itself()
    counts = {name: words((PROJECT / name).read_text()) for name in pages()}
    if sys.argv[1:] == ["--list"]:
        print("\n".join(f"{count:6} {name}" for name, count in sorted(counts.items(), key=lambda entry: entry[1])))
        print(f"{sum(counts.values()):6} in all, at most {MOST_WORDS}")
    told = list(wrong(counts, (PROJECT / GLOSSARY).read_text(), code()))
    for line in told:
        print(line)
    return bool(told)


if __name__ == "__main__":
    sys.exit(main())
