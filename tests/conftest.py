"""Fixtures for all tests."""

import pytest

from fem_impact.commands.main import main


@pytest.fixture
def cli(capsys, tmp_path, monkeypatch):
    """Call the command in an empty directory; return exit code, standard output and standard error."""
    monkeypatch.chdir(tmp_path)

    def call(*words):
        try:
            code = main([str(word) for word in words])
        except SystemExit as stop:
            code = stop.code
        out, err = capsys.readouterr()
        return code, out, err

    return call
