"""The page of results: what it says of a run, what is refused, and that the one in docs/ is such a page."""

import re
from pathlib import Path

from fem_impact.cli.main import main
from fem_impact.evidence.problems.problem import HEAD, PROBLEMS, Check, ProblemCost, Verification, page

PAGE = Path(__file__).parents[3] / "docs" / "evidence" / "verification.md"


def found(name, *checks):
    return Verification(name, {}, checks, ProblemCost(30.0, 25.4, 10, 20))


EASY = Check("length", "m", 1.001, 1.0, 0.1)
CLOSE = Check("force", "N", 109.0, 100.0, 0.1)
WRONG = Check("touches", "1", 2, 1, 0.0, "absolute")
SHOWN = Check.shown("law", "1", 1e9, 1.0, "it does not hold here")


def test_a_row_shows_the_check_nearest_to_its_limit():
    text = page([found("a", EASY, CLOSE), found("b", EASY, CLOSE, WRONG, SHOWN)])
    first, _, *rows = text.splitlines()
    told = "4 of 5 checks passed, 1 more are only shown, 1.0 minutes."
    assert first == f"All parameters at their defaults: {told}"
    assert rows[2] == "| `a` | 2 of 2 | force | 109 N | 100 N | +9.0e-02 | 0.1 relative | 25 |"
    assert rows[3] == "| `b` | 2 of 3 | touches | 2 | 1 | +1.0e+00 | 0 absolute | 25 |"


def test_the_command_refuses_what_is_no_page_before_any_work(tmp_path):
    target = tmp_path / "page.md"
    target.write_text("nothing here\n")
    assert main(["verify", "--page", str(target)]) == 2
    assert main(["verify", "modes", "--page", str(target)]) == 2
    assert main(["verify", "--page", str(tmp_path / "page.txt")]) == 2
    assert main(["verify", "--page", str(tmp_path / "none" / "page.md")]) == 4
    assert target.read_text() == "nothing here\n"


def test_the_page_of_the_documentation_has_a_row_for_every_problem_in_the_form_of_the_command():
    line, _, head, rule, *rows = PAGE.read_text(encoding="utf-8").rstrip("\n").split("\n")[6:]
    assert re.fullmatch(
        r"All parameters at their defaults: (\d+) of \1 checks passed, "
        r"\d+ more are only shown, [\d.]+ minutes\.",
        line,
    )
    assert rule.count("---") == len(HEAD)
    assert [cell.strip() for cell in head.strip("|").split("|")] == HEAD
    names = [re.match(r"\| `([\w-]+)` \| (\d+) of \2 \| ", row)[1] for row in rows]
    assert names == list(PROBLEMS)
    assert all(row.count("|") == len(HEAD) + 1 for row in rows)
