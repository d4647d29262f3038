"""Report of the random scenes at the end of a session."""

import pytest
from census import told

CASES = pytest.StashKey[list]()


def pytest_configure(config):
    config.stash[CASES] = []


@pytest.fixture
def cases(request):
    """All random scenes of the session that have run so far."""
    return request.config.stash[CASES]


def pytest_terminal_summary(terminalreporter, config):
    cases = config.stash.get(CASES, [])
    if cases:
        terminalreporter.section(f"{len(cases)} random scenes")
        terminalreporter.write_line(told(cases))
