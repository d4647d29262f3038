"""Work in turns on one process or two."""

from contextlib import closing
from functools import partial
from math import sqrt
from os import getpid
from time import sleep

import pytest

from fem_impact.answers.refine.forecast import Turns, longest_s
from fem_impact.jobs.executors import cores


@pytest.mark.long
@pytest.mark.parametrize("workers", [1, 2])
def test_results_come_in_the_order_of_the_work(workers):
    with closing(Turns()) as turns:
        assert turns([partial(pow, 2, n) for n in range(5)], workers) == [1, 2, 4, 8, 16]


@pytest.mark.long
def test_the_second_worker_is_another_process_which_stays_and_a_new_one_after_a_failure():
    with closing(Turns()) as turns:
        own, other = turns([getpid, getpid], 2)
        assert own != other and turns([getpid, getpid], 2) == [own, other]
        assert turns([getpid, getpid], 1) == [own, own]
        with pytest.raises(ValueError):
            turns([partial(sqrt, -1.0), partial(sleep, 60)], 2)
        assert turns([getpid, getpid], 2)[1] not in (own, other)


def test_a_process_that_another_started_has_one_core():
    with closing(Turns()) as turns:
        assert turns([cores, cores], 2) == [cores(), 1]


def test_the_busier_process_counts():
    assert longest_s([3.0, 1.0, 2.0], 1) == 6.0
    assert longest_s([3.0, 1.0, 2.0], 2) == 5.0
