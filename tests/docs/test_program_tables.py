"""Tables in the raw pages are those that the program makes now."""

import importlib.util
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
SPEC = importlib.util.spec_from_file_location("program_tables", ROOT / "docs/extensions/program_tables.py")
MODULE = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(MODULE)


def test_every_table_stands_in_a_page():
    pages = "".join(page.read_text("utf-8") for page in MODULE.PAGES)
    assert {name for _, name, _ in MODULE.PLACE.findall(pages)} == set(MODULE.TABLES)


@pytest.mark.parametrize("page", MODULE.PAGES, ids=lambda page: page.name)
def test_the_tables_of_a_page_are_those_of_the_program(page):
    """Else: python docs/extensions/program_tables.py."""
    assert page.read_text("utf-8") == MODULE.filled(page.read_text("utf-8"))
