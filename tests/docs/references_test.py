#!/usr/bin/env python3
"""references.py finds what is wrong, and nothing in what is right."""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

TOOL = Path(__file__).with_name("references.py")
# Of a document that is not there.
MISSING = "docs/" + "format.md"
METHOD = "# Method\n\n## 3. Directions\n\n### 3.1 Lobes\n\n    p = 1 / h      (4)\n"


class References(unittest.TestCase):
    def problems(self, files):
        with tempfile.TemporaryDirectory() as folder:
            for name, text in {"docs/method.md": METHOD, **files}.items():
                path = Path(folder) / name
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text)
            run = subprocess.run([sys.executable, TOOL, folder], capture_output=True, text=True)
            found = run.stdout.splitlines() if run.returncode else []
            self.assertEqual(run.returncode, 1 if found else 0, run.stderr)
            return found

    def expect(self, files, *parts):
        found = self.problems(files)
        self.assertEqual(len(found), len(parts), found)
        for problem, part in zip(found, parts):
            self.assertIn(part, problem)

    def test_what_is_right(self):
        self.expect({
            "src/a.h": "// Lobes (docs/method.md,\n// section 3.1), see docs/method.md, eq. 4 and src/a.h.\n"
                       "/// docs/method.md, sections 3 and 3.1\n",
            "docs/README.md": "[Method](method.md#31-lobes), section 3; [method](method.md), sections 3 to 3.1; `src/{a,a}.h`\n",
            "README.md": "[docs](docs/README.md), data/scenes/NAME, build/report.md, [out](https://example.org/x.md)\n"})

    def test_sections_and_equations_of_comments(self):
        self.expect({"src/a.h": "int x; // docs/method.md, section 7\n"}, "docs/method.md has no section 7")
        self.expect({"src/a.h": "// docs/method.md, sections 3 to\n// 5\n"}, "has no section 5")
        self.expect({"src/a.cpp": "// docs/method.md, eq. 5\n"}, "has no equation (5)")
        self.expect({"src/a.py": f"# {MISSING}, section 3\n"}, f"no document {MISSING}", f"there is no {MISSING}")

    def test_one_form(self):
        self.expect({"src/a.h": "// (method, section 3)\n"}, "'section 3' of no document")
        self.expect({"src/a.h": "// (method.md, section 3)\n"}, "cited as docs/NAME.md", "no document method.md",
                    "there is no method.md")

    def test_documents(self):
        self.expect({"docs/accuracy.md": "# A\n\nSee [method](method.md), section 4.\n"}, "docs/method.md has no section 4")
        self.expect({"docs/accuracy.md": "# A\n\nSee section 3.\n"}, "docs/accuracy.md has no section 3")
        self.expect({"docs/accuracy.md": "[x](b.md)\n"}, "link to b.md")
        self.expect({"docs/accuracy.md": "[x](method.md#lobes)\n"}, "no such heading")
        self.expect({"docs/accuracy.md": "`src/none.h`\n"}, "there is no src/none.h")
        self.expect({"a.md": "[x](../elsewhere.md)\n"}, "link to ../elsewhere.md")


if __name__ == "__main__":
    unittest.main()
