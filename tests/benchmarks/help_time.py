"""Measure the CPU time of ``fem-impact --help`` (aim: below 0.3 s) and of a refused scene."""

import resource
import statistics
import subprocess
import sys

REPEATS = 10


def cpu_seconds(*words: str) -> float:
    """Return user and system time of one call of the command, in s."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([sys.executable, "-m", "fem_impact", *words], capture_output=True, check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


for line in (["--help"], ["scenes"], ["run", "no-such-scene"]):
    times = [cpu_seconds(*line) for _ in range(REPEATS)]
    print(f"fem-impact {' '.join(line):<20} {statistics.median(times):.3f} s CPU (worst {max(times):.3f})")
