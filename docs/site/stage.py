"""Puts the pages of the site, and the pictures that they show, where mdBook reads them.

    python3 docs/site/stage.py

The pages are those that SUMMARY.md links to, and the long tables in target/tables, which `evidence render` makes. Each keeps its path in the repository, so links between pages need no change. A link
to any other file of the repository leads to the file at `git-repository-url` of book.toml; without such an address only its text
remains.
"""

import os
import re
import shutil
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
HERE = "docs/site"
SOURCE = TOP / "target/site-source"
PICTURES = {".png", ".svg"}

# code, which has no links, or a link or picture: (!, text, target)
LINK = re.compile(r"^```.*?^```$|``.+?``|`[^`]*`|(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^()\s]+)\)", re.DOTALL | re.MULTILINE)


def resolve(folder, target):
    """The path, from the top of the repository, that a link on a page in `folder` leads to; None for other links."""
    if re.match(r"[a-z]+:|#", target):
        return None
    path = os.path.normpath(os.path.join(folder, target.partition("#")[0]))
    if not (TOP / path).exists():
        raise SystemExit(f"a page in `{folder}` links to {target}, which is not there")
    return path


def links(text, rewrite):
    """The text with `rewrite(match)` for every link and picture."""
    return LINK.sub(lambda match: match[0] if match[3] is None else rewrite(match), text)


def rewritten(text, folder, pages, address):
    """The text of a page in `folder` with the links of the site; its pictures are copied."""

    def rewrite(match):
        path = resolve(folder, match[3])
        if path is None:
            # the site needs no network: badges stay out
            return "" if match[1] else match[0]
        if path in pages:
            # mdBook calls README.md index.html
            return f"[{match[2]}]({match[3].replace('README.md', 'index.md')})"
        if match[1] and Path(path).suffix in PICTURES:
            (SOURCE / path).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(TOP / path, SOURCE / path)
            return match[0]
        return f"[{match[2]}]({address}/blob/HEAD/{path})" if address else match[2]

    return links(text, rewrite)


def write(page, text):
    (SOURCE / page).parent.mkdir(parents=True, exist_ok=True)
    (SOURCE / page).write_text(text, "utf-8")


def main():
    shutil.rmtree(SOURCE, ignore_errors=True)
    SOURCE.mkdir(parents=True)
    book = (TOP / HERE / "book.toml").read_text("utf-8")
    address = re.search(r'^git-repository-url = "(.*)"', book, re.MULTILINE)

    pages = []

    def chapter(match):
        pages.append(resolve(HERE, match[3]))
        return f"[{match[2]}]({pages[-1]})"

    summary = links((TOP / HERE / "SUMMARY.md").read_text("utf-8"), chapter)
    tables = sorted((TOP / "target/tables").glob("*.md"))
    if tables:
        summary += "\n# Tables\n\n"
    for table in tables:
        text = table.read_text("utf-8")
        title = text.splitlines()[0].lstrip("# ")
        summary += f"- [{title}](table-{table.name})\n"
        # links of a table are those of a page at the top
        write(f"table-{table.name}", rewritten(text, "", pages, address and address[1]))
    (SOURCE / "SUMMARY.md").write_text(summary, "utf-8")
    for page in pages:
        text = (TOP / page).read_text("utf-8")
        write(page, rewritten(text, os.path.dirname(page), pages, address and address[1]))


main()
