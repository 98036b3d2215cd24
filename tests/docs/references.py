#!/usr/bin/env python3
"""What the documents and the comments refer to exists: sections and equations of documents, links, headings, paths.

    references.py PROJECT

Comments cite a document as "docs/NAME.md, section 10.5" ("sections 3 to 6", "sections 2.2 and 5") or "docs/NAME.md, eq. 4".
Documents cite each other's sections behind a link, "[method](method.md), section 10", and their own as "section 10".
"""

import re
import subprocess
import sys
from pathlib import Path

SOURCES = {".h", ".cpp", ".py", ".cmake", ".sh"}
#: What a path in text starts with; others are names of the user's own.
TOP_FOLDERS = ("src", "tungsten", "tests", "benchmarks", "docs", "data", "scripts", ".ci")
NUMBER = r"\d+(?:\.\d+)*"
SECTIONS = rf"sections? ({NUMBER})(?:(?:, {NUMBER})*(?: to | and )({NUMBER}))?"
CITED = re.compile(rf"(?<![\w/.-])([\w./-]*\w\.md)`?, +(?:{SECTIONS}|eq\. (\d+))")
ANY_CITATION = re.compile(rf"\b(?:{SECTIONS}|eq\. (\d+))")
LINK = re.compile(r"\]\(([^)\s]+)\)")
PATH = re.compile(rf"(?<![\w/.*{{}}$-])((?:{'|'.join(map(re.escape, TOP_FOLDERS))})/[\w./*{{}},-]*\w)")
DOCUMENT = re.compile(r"(?<![\w/.*-])([\w./-]*\w\.md)\b")


class Document:
    """Sections, equations and anchors of one page."""

    def __init__(self, text):
        prose = re.sub(r"^```.*?^```", "", text, flags=re.S | re.M)
        headings = re.findall(r"^#+ +(.*)$", prose, flags=re.M)
        self.sections = {match[1] for heading in headings if (match := re.match(rf"({NUMBER})\.? ", heading))}
        self.equations = set(re.findall(r" \((\d+)\)$", text, flags=re.M))
        self.anchors = {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


class Check:
    def __init__(self, project, files):
        self.project = project
        self.files = files
        self.documents = {name: Document((project / name).read_text()) for name in files if name.endswith(".md")}
        self.problems = []

    def exists(self, name):
        names = self.project.glob(name) if "*" in name else [self.project / name]
        return any(path.exists() for path in names)

    def complain(self, file, what):
        self.problems.append(f"{file}: {what}")

    def citation(self, file, document, match):
        """One citation of sections or an equation."""
        first, last, equation = match[-3:]
        if document is None:
            return self.complain(file, f"'{match[0]}' of no document")
        page = self.documents.get(document)
        if page is None:
            return self.complain(file, f"there is no document {document}")
        for section in filter(None, (first, last)):
            if section not in page.sections:
                self.complain(file, f"{document} has no section {section}")
        if equation and equation not in page.equations:
            self.complain(file, f"{document} has no equation ({equation})")
        return None

    def comments(self, file):
        text = comments_of(self.project / file)
        cited = []
        for match in CITED.finditer(text):
            cited.append(match.span())
            if not match[1].startswith("docs/"):
                self.complain(file, f"'{match[1]}': documents are cited as docs/NAME.md")
            self.citation(file, match[1], (match[0], *match.groups()[1:]))
        for match in ANY_CITATION.finditer(text):
            if not any(start <= match.start() < end for start, end in cited):
                self.citation(file, None, (match[0], *match.groups()))
        self.paths(file, text)

    def page(self, file):
        text = (self.project / file).read_text()
        prose = re.sub(r"^```.*?^```", "", text, flags=re.S | re.M)
        folder = (self.project / file).parent
        for match in LINK.finditer(prose):
            self.link(file, folder, match[1])
        flat = re.sub(r"\s+", " ", prose)
        flat = LINK.sub(lambda link: f" {self.target(folder, link[1])} ", flat)
        flat = re.sub(r" +", " ", flat).replace(" ,", ",")
        cited = []
        for match in CITED.finditer(flat):
            cited.append(match.span())
            own = folder.joinpath(match[1])
            name = match[1] if self.exists(match[1]) or not own.exists() else str(own.resolve().relative_to(self.project))
            self.citation(file, name, (match[0], *match.groups()[1:]))
        for match in ANY_CITATION.finditer(flat):
            if not any(start <= match.start() < end for start, end in cited):
                self.citation(file, file, (match[0], *match.groups()))
        self.paths(file, re.sub(r"\[[^\]]*\]\([^)]*\)", "", text))

    def target(self, folder, link):
        path = (folder / link.split("#")[0]).resolve()
        return str(path.relative_to(self.project)) if path.is_relative_to(self.project) else link

    def link(self, file, folder, link):
        if re.match(r"[a-z]+:", link):
            return
        name, _, anchor = link.partition("#")
        target = self.target(folder, name) if name else file
        if not self.exists(target):
            self.complain(file, f"link to {link}, which does not exist")
        elif anchor and target in self.documents and anchor not in self.documents[target].anchors:
            self.complain(file, f"link to {link}: no such heading")

    def paths(self, file, text):
        for name in {match[1] for match in PATH.finditer(text)} | {match[1] for match in DOCUMENT.finditer(text)}:
            if re.search(r"(^|/)[A-Z]+(?=/|$|\.)", name) and not self.exists(name):
                named = Path(name).name
                if named not in ("README.md", "RESULTS.md", "CMakeLists.txt"):
                    continue  # a placeholder, such as data/scenes/NAME
            for each in braces(name):
                near = [each, *(str(Path(file).parent / up / each) for up in (".", ".."))]
                if not each.startswith("/") and not any(map(self.exists, near)) and not self.made(each):
                    self.complain(file, f"there is no {each}")

    @staticmethod
    def made(name):
        """Reports and pictures that the renderer and its tools write."""
        return Path(name).name in ("report.md", "results.md", "values.md", "table.md") or "/output/" in name


def braces(name):
    """src/{a,b} -> src/a, src/b"""
    match = re.search(r"\{([^{}]*)\}", name)
    if not match:
        return [name.rstrip("{,")]
    return [each for part in match[1].split(",") for each in braces(name[:match.start()] + part + name[match.end():])]


def comments_of(path):
    """The comments (for Python and shell also the strings) of a source file as one line."""
    text = path.read_text()
    if path.suffix in (".h", ".cpp"):
        found = re.findall(r"(?<![:\"])//+<?(.*)$", text, flags=re.M)
        found += [string for string in re.findall(r'"((?:[^"\\\n]|\\.)*)"', text) if ".md" in string]
    else:
        found = [line.strip().lstrip("# ") for line in text.splitlines()]
    return re.sub(r"\s+", " ", " ".join(found))


def main():
    project = Path(sys.argv[1]).resolve()
    listed = subprocess.run(["git", "-C", project, "ls-files", "-co", "--exclude-standard"], capture_output=True, text=True)
    names = listed.stdout.splitlines() if listed.returncode == 0 else [
        str(path) for file in project.rglob("*") if not (path := file.relative_to(project)).parts[0].startswith("build")]
    files = sorted(name for name in names if (project / name).is_file())
    check = Check(project, files)
    if not check.documents:
        sys.exit(f"no documents in {project}")
    for file in files:
        if file.endswith(".md"):
            check.page(file)
        elif file.startswith("docs/") and file.endswith(".csv"):
            check.paths(file, (project / file).read_text())
        elif (Path(file).suffix in SOURCES or Path(file).name == "CMakeLists.txt") and not file.startswith("tests/docs/"):
            check.comments(file)
    print("\n".join(check.problems) or f"{len(files)} files: every reference leads somewhere")
    return 1 if check.problems else 0


if __name__ == "__main__":
    sys.exit(main())
