"""Hard cases: each must end with closed balances, be refused before it starts, or be detected."""

from fem_impact.stress.run import Row, run_case, run_cases
from fem_impact.stress.scenes import CASES, Case

__all__ = ["CASES", "Case", "Row", "run_case", "run_cases"]
