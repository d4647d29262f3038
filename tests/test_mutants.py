"""Every fault of the list is noticed by its test, and the documentation shows the list."""

from pathlib import Path

import pytest
from mutants import MUTANTS, ROOT, survives, table


@pytest.mark.slow
@pytest.mark.parametrize("mutant", MUTANTS, ids=lambda m: m.fault.replace(" ", "-"))
def test_a_fault_is_noticed(mutant, tmp_path):
    assert survives(mutant, tmp_path) == ""


@pytest.mark.parametrize("mutant", MUTANTS, ids=lambda m: m.fault.replace(" ", "-"))
def test_a_fault_can_still_be_made_and_its_test_is_there(mutant):
    assert (ROOT / mutant.file).read_text(encoding="utf-8").count(mutant.old) == 1
    path, _, name = mutant.test.partition("::")
    assert f"def {name}(" in (ROOT / path).read_text(encoding="utf-8")


def test_the_page_lists_the_faults():
    assert table() in (Path(ROOT) / "docs" / "evidence" / "faults.md").read_text(encoding="utf-8")
