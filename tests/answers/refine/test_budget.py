"""Work in turns on one process or two."""

from functools import partial
from os import getpid

import pytest

from fem_impact.answers.refine.forecast import in_turns, longest_s


@pytest.mark.parametrize("workers", [1, 2])
def test_results_come_in_the_order_of_the_work(workers):
    assert in_turns([partial(pow, 2, n) for n in range(5)], workers) == [1, 2, 4, 8, 16]


def test_the_second_worker_is_another_process():
    assert len(set(in_turns([getpid, getpid], 2))) == 2
    assert len(set(in_turns([getpid, getpid], 1))) == 1


def test_the_busier_process_counts():
    assert longest_s([3.0, 1.0, 2.0], 1) == 6.0
    assert longest_s([3.0, 1.0, 2.0], 2) == 5.0
