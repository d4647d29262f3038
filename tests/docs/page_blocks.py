"""README and the pages of docs/ as text, and their code blocks."""

import re
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")
PAGES = {
    str(path.relative_to(ROOT)): path.read_text(encoding="utf-8")
    for path in (ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md")))
    if "_build" not in path.parts
}
_FENCE = re.compile(r"(?:<!-- ([^\n]*) -->\n)?^```(\w+)\n(.*?)\n```", re.DOTALL | re.MULTILINE)


@dataclass(frozen=True)
class Block:
    """A code block: its page, the comment right before it, its language and text."""

    page: str
    marker: str
    language: str
    text: str

    def __str__(self):
        """Name the block in the list of tests."""
        return f"{self.page}:{self.marker or self.text.splitlines()[0]}"


BLOCKS = [
    Block(page, *(part or "" for part in found))
    for page, text in PAGES.items()
    for found in _FENCE.findall(text)
]


def marked(marker, page="README.md"):
    """Return the text of the one block of a page with a marker."""
    (text,) = (block.text for block in BLOCKS if (block.page, block.marker) == (page, marker))
    return text


def blocks(language, *markers):
    """Return all blocks of a language, or those with one of some markers."""
    return [b for b in BLOCKS if b.language == language and (not markers or b.marker in markers)]


def without_code(text):
    """Return a page without its blocks."""
    return re.sub(r"^```.*?^```", "", text, flags=re.DOTALL | re.MULTILINE)
