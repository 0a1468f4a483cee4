"""Tables of ``docs/performance.md``, each between two comments that name it."""

import re
from pathlib import Path

PAGE = Path(__file__).parents[1] / "docs" / "performance.md"


def table(head, rows):
    """Return a Markdown table."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(str(cell) for cell in line) + " |" for line in lines)


def fill(parts, page=PAGE):
    """Put every part between its comments.

    Raises
    ------
    KeyError
        The page has no such place.
    """
    text = page.read_text(encoding="utf-8")
    for name, content in parts.items():
        place = re.compile(rf"(<!-- {name} -->\n).*?(\n<!-- /{name} -->)", re.DOTALL)
        if not place.search(text):
            raise KeyError(f"{page.name} has no place for {name!r}")
        text = place.sub(lambda found, content=content: found[1] + content + found[2], text)
    page.write_text(text, encoding="utf-8")
