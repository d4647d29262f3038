"""Parameters of docstrings that say what they are in place of their type, which the signature has."""

import re

ENTRY = re.compile(r"(\*{0,2}[\w*, ]+?) : (.+)")
SECTIONS = ("Parameters", "Attributes")


def describe(app, what, name, obj, options, lines):
    """Turn ``name : words`` into a name and its description; a type with sentences below it stays one."""
    inside, found = False, []
    for at, line in enumerate(lines):
        following = lines[at + 1] if at + 1 < len(lines) else ""
        if line and not line.strip("-"):
            inside = lines[at - 1] in SECTIONS
        entry = ENTRY.fullmatch(line) if inside else None
        sentences = re.match(" {4} *[A-Z]", following)
        if entry and " " in entry[2] and not sentences:
            found += [entry[1], f"    {entry[2]}"]
        else:
            found.append(line)
    lines[:] = found


def setup(app):
    """Let docstrings be read before Napoleon reads them."""
    app.connect("autodoc-process-docstring", describe, priority=400)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
