"""The command ``sweep``: one scene with values varied in all combinations."""

import sys
from collections.abc import Mapping
from contextlib import closing, nullcontext, suppress
from itertools import product
from pathlib import Path
from typing import Any

from fem_impact.answers.sweep import FIDELITY, cases_digest
from fem_impact.answers.sweep import sweep as swept
from fem_impact.answers.sweep_results import require_columns
from fem_impact.answers.vary import cases
from fem_impact.cli.parser import Options
from fem_impact.cli.paths import checked_out, told_kept
from fem_impact.cli.scene_options import asked_scene, command_line, read_changes
from fem_impact.cli.terminal import chosen_meter, print_json, print_markdown
from fem_impact.cli.values import read_all
from fem_impact.errors import RunError, SceneError, UsageError
from fem_impact.files.atomic import read_text
from fem_impact.jobs.executors import cores, on_scheduler
from fem_impact.scene.impact import WAYS, the_way
from fem_impact.scene.shipped import alters, bare, moved
from fem_impact.scene.types import Scene


def sweep(options: Options) -> int:
    """Compute all combinations, write table and figures, and print the findings."""
    columns = [name.strip() for name in options.columns.split(",")] if options.columns else []
    require_columns(columns)
    vary = read_all(options.vary, "--vary")
    _refuse_both(read_changes(options.changes), vary)
    scene = asked_scene(options)
    _refuse_altered(scene, read_changes(options.changes), vary)
    every = cases(scene, vary)  # refuses what cannot run before a directory is made
    fidelity, workers = options.fidelity or FIDELITY, options.workers or cores()
    about = cases_digest(every, fidelity)
    out = checked_out(options.out or Path("results") / f"sweep-{scene.id}-{about[:8]}")
    lent = on_scheduler(options.scheduler) if options.scheduler else nullcontext()
    with told_kept(out, options), closing(chosen_meter(options)) as meter, lent as executor:
        line = command_line(options, "sweep", "vary", "fidelity", "columns")
        results = swept(scene, vary, fidelity, out, workers, meter, executor, columns, line)
    if options.json:
        table = results.table()
        names = [column.name for column in table.columns]
        document = {
            "vary": {key: list(values) for key, values in results.vary.items()},
            "rows": [dict(zip(names, row, strict=True)) for row in table.rows],
            "path": str(out),
        }
        print_json(document)
    else:
        print_markdown(read_text(out / "summary.md"), options)
        sys.stdout.write(f"results: {out}\nreport: fem-impact report {out}\n")
    return RunError.exit_code if any(row.outcome is None for row in results) else 0


def _refuse_both(changes: Mapping[str, Any], vary: Mapping[str, Any]) -> None:
    """Refuse a value of ``--set`` that a varied one takes the place of, and an impact stated in two ways."""
    for key, other in product(changes, vary):
        if bare(key) == bare(other) or key.startswith(f"{other}."):
            raise _beside(key, other)
    stated = moved([*changes, *vary])
    if not any(set(way) & stated for way in WAYS):
        return
    try:
        the_way(stated)
    except SceneError as error:
        raise error.under("impact", "--set, --vary") from None


def _refuse_altered(scene: Scene, changes: Mapping[str, Any], vary: Mapping[str, Any]) -> None:
    """Refuse a value of ``--set`` that a varied one alters, as a surface state does a friction."""
    for key, (other, values) in product(changes, vary.items()):
        if other.startswith(f"{key}."):
            continue  # a part of a whole table that is set may be varied
        for value in values:
            with suppress(SceneError):  # a key that no scene has is told with the cases
                if alters(scene, other, value, key):
                    raise _beside(key, other)


def _beside(key: str, varied: str) -> UsageError:
    remedy = "Leave out one of the two."
    return UsageError(f"is given beside --vary {varied}.", key="--set", value=key, remedy=remedy)
