"""How many cores there are to use, and how many of them are idle."""

import os

from fem_impact.cores import cores, idle_cores


def test_idle_cores_are_those_that_nobody_keeps_busy(monkeypatch):
    monkeypatch.setattr(os, "getloadavg", lambda: (0.75, 9.0, 9.0))
    assert idle_cores() == cores() - 0.75


def test_without_a_load_one_core_counts_as_idle(monkeypatch):
    monkeypatch.delattr(os, "getloadavg")
    assert idle_cores() == 1.0
