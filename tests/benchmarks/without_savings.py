"""The default run beside the one without savings: errors, and processor times in one session.

    python tests/benchmarks/without_savings.py OUT [SET ...]

Without savings no small elements are made heavier and the finest cells fill the zone that may yield. Both run
in turn, three times, each in a process of its own; what lies in OUT is not run again. The setting is put into
the stored costs (``fem_impact/plan/data/summary.json``) with its error against the stored limits; its time is
that of the stored default run, which was measured with all other settings on one machine, times the ratio of
the medians of this session. Page and figure of the costs are written anew from the stored costs, under the
page's own record of the runs behind it.
"""

import json
import shutil
import sys
from dataclasses import asdict, replace
from pathlib import Path
from statistics import median

from fem_impact.commands.page import machine, version
from fem_impact.cost.judge import Judged, cpu_seconds, front, judge
from fem_impact.cost.limits import Truth
from fem_impact.cost.measure import CostStudy, _compile
from fem_impact.cost.quantities import QUANTITIES, TARGETED
from fem_impact.cost.settings import DEFAULT, FULL, ladder
from fem_impact.jobs.executors import LocalProcesses
from fem_impact.jobs.job import compute, read_outcome
from fem_impact.outcome.record import utc_now
from fem_impact.scene.read import read_dict
from fem_impact.scene.shipped import load
from fem_impact.study.cost_report import FIGURE, paper_report
from fem_impact.study.document import Request, publish
from fem_impact.tables.table import Table

ROOT = Path(__file__).parents[2]
SUMMARY = ROOT / "fem_impact" / "plan" / "data" / "summary.json"
PAGE, TITLE = ROOT / "docs" / "evidence" / "cost.md", "## Without savings"
SETS, TIMES = ("t5b", "t6-17", "t3-machined"), 3
HEAD = (
    "set",
    "default run, s",
    "without savings, s",
    "ratio",
    *(f"change of {name}, %" for name in TARGETED),
)


def outcomes(name, out):
    """Return the outcomes of both settings, each run ``TIMES`` times in turn."""
    jobs = {s.name: s.runs[0][0] for s in ladder(load(name)) if s.name in (DEFAULT, FULL)}
    found = {setting: [] for setting in jobs}
    with LocalProcesses(1, reuse=False) as process:
        _compile(load(name), process)
        for turn in range(TIMES):
            for setting, job in jobs.items():
                path = out / f"{name}-{setting.replace(' ', '-')}-{turn}.json"
                if not path.exists():
                    path.write_text(process.submit(compute, job).result().outcome, "utf-8")
                found[setting].append(read_outcome(job, path.read_text("utf-8")))
    return found


def with_full(name, cost, runs):
    """Return the costs with the setting without savings, and its row of the table."""
    times = {setting: median(map(cpu_seconds, found)) for setting, found in runs.items()}
    ratio = times[FULL] / times[DEFAULT]
    setting = next(one for one in ladder(load(name)) if one.name == FULL)
    default = next(one for one in cost.settings if one.name == DEFAULT)
    seconds = {key: getattr(default, key) * ratio for key in ("wall_s", "cpu_s", "two_cores_s")}
    full = replace(judge(setting, [runs[FULL][:1]], cost.truth), **seconds)
    changes = [
        f"{100 * (full.value[key] - default.value[key]) / cost.truth[key].scale:+.2f}" for key in TARGETED
    ]
    row = (name, f"{times[DEFAULT]:.2f}", f"{times[FULL]:.2f}", f"{ratio:.2f}", *changes)
    others = [one for one in cost.settings if one.name != FULL]
    return replace(cost, settings=sorted([*others, full], key=lambda one: one.cpu_s)), row


def stored_cost(stored):
    """Return the costs of a scene as they are stored, without their runs."""
    truth = {
        key: Truth(one["limit"], one["order"], one["uncertainty"], one["scale"], one["scatter"])
        for key, one in stored["quantities"].items()
    }
    settings = [Judged(**one) for one in stored["settings"]]
    return CostStudy(read_dict(stored["scene"]), truth, settings, stored["failures"], {})


def with_fronts(cost):
    """Return the costs with the quantities on whose front each setting lies."""
    fronts = {q.name: {one.name for one in front(cost.settings, [q.name])} for q in QUANTITIES}
    marked = [
        replace(one, front=[name for name, members in fronts.items() if one.name in members])
        for one in cost.settings
    ]
    return replace(cost, settings=marked)


def write_page(costs, rows, out, commit):
    """Write the page of the costs: its own first lines, the report, and the table of this session."""
    head = PAGE.read_text("utf-8").split("\n\n")[:3]
    text = publish(paper_report(costs), Request(out / "page"), {}).text.split("\n\n", 2)[2]
    shutil.copyfile(out / "page" / "figures" / f"{FIGURE}.svg", PAGE.with_suffix("") / f"{FIGURE}.svg")
    body = text.strip().replace(f"](figures/{FIGURE}.png)", f"]({PAGE.stem}/{FIGURE}.svg)")
    made = (
        f"Made by `python tests/benchmarks/without_savings.py` on {utc_now()[:10]}, {machine()}, "
        f"{commit}. "
        f"Medians of the processor time of {TIMES} runs in turn in one session, on cores that others "
        "kept busy. Above, the time of this setting is that of the default run there times the ratio."
    )
    table = Table.of(HEAD, rows).markdown()
    PAGE.write_text("\n\n".join([*head, body, TITLE, made, table.strip()]) + "\n", "utf-8")


def main(out, *names):
    """Run, put the setting into the stored costs, and write their page."""
    out, commit = Path(out), version()
    out.mkdir(parents=True, exist_ok=True)
    summary = json.loads(SUMMARY.read_text("utf-8"))
    costs, rows = {name: stored_cost(one) for name, one in summary["scenes"].items()}, []
    for name in names or SETS:
        costs[name], row = with_full(name, costs[name], outcomes(name, out))
        rows.append(row)
    for name, cost in costs.items():
        costs[name] = with_fronts(cost)
        summary["scenes"][name]["settings"] = [asdict(one) for one in costs[name].settings]
    SUMMARY.write_text(json.dumps(summary, indent=1, allow_nan=False) + "\n", "utf-8")
    write_page(costs, rows, out, commit)


if __name__ == "__main__":
    main(*sys.argv[1:])
