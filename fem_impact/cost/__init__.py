"""What accuracy costs in time: the ladder of settings, its errors, and the choice of a setting."""

from fem_impact.cost.achieve import simulate_to_target
from fem_impact.cost.choose import advice, best_within, cheapest
from fem_impact.cost.document import text_table, write_cost
from fem_impact.cost.judge import Judged, front, worst
from fem_impact.cost.limits import Truth
from fem_impact.cost.markdown import summary_markdown
from fem_impact.cost.measure import Cost, judge_stored, measure
from fem_impact.cost.pairs import best_pair, pair_sentence, verdict
from fem_impact.cost.quantities import QUANTITIES, TARGETED, chosen
from fem_impact.cost.settings import FAMILY, Mesh, Setting, ladder, on_mesh
from fem_impact.cost.stored import NEARNESS, Plan, nearest, plan, summarise, summary

__all__ = [
    "FAMILY",
    "NEARNESS",
    "QUANTITIES",
    "TARGETED",
    "Cost",
    "Judged",
    "Mesh",
    "Plan",
    "Setting",
    "Truth",
    "advice",
    "best_pair",
    "best_within",
    "cheapest",
    "chosen",
    "front",
    "judge_stored",
    "ladder",
    "measure",
    "nearest",
    "on_mesh",
    "pair_sentence",
    "plan",
    "simulate_to_target",
    "summarise",
    "summary",
    "summary_markdown",
    "text_table",
    "verdict",
    "worst",
    "write_cost",
]
