#!/usr/bin/env python3
"""Writes the listings of a document that follow a line `<!-- snippet: NAME -->` into FOLDER/NAME.

    extract_snippets.py DOCUMENT FOLDER NAME...

NAMEs are the snippets that there must be, no more and no fewer.
"""

import re
import sys
from pathlib import Path

SNIPPET = re.compile(r"^<!-- snippet: ([\w.]+) -->\n```\w*\n(.*?)^```$", re.S | re.M)


def main():
    document, folder, wanted = Path(sys.argv[1]), Path(sys.argv[2]), sorted(sys.argv[3:])
    snippets = dict(SNIPPET.findall(document.read_text()))
    if sorted(snippets) != wanted:
        sys.exit(f"{document} has the snippets {sorted(snippets)}, expected {wanted}")
    folder.mkdir(parents=True, exist_ok=True)
    for name, code in snippets.items():
        (folder / name).write_text(code)


if __name__ == "__main__":
    main()
