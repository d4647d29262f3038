"""Fixtures for all tests."""

import pytest
import result_maker

from fem_impact.cli.main import main

HEADER = "test,v_n_m_per_s,v_t_m_per_s,V_n_m_per_s,V_t_m_per_s,Omega_rad_per_s"


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


@pytest.fixture(scope="session")
def result(tmp_path_factory):
    """A whole result directory with a few frames of fields (read only)."""
    return result_maker.write_result(tmp_path_factory.mktemp("result"), frames=4, along=18)


@pytest.fixture
def unrendered(monkeypatch):
    """Build figures but write no picture: how they look is the business of tests/figures."""
    monkeypatch.setattr("fem_impact.figures.still.save", lambda drawn, path: path.write_bytes(b"<svg/>"))


@pytest.fixture
def record():
    """Values of a whole, valid outcome, free to be changed."""
    return result_maker.values()


@pytest.fixture
def camera_file(tmp_path):
    """Write a CSV of measured velocities and return its path."""

    def write(*lines, header=HEADER, name="mine.csv"):
        path = tmp_path / name
        path.write_text("\n".join([header, *lines]) + "\n", encoding="utf-8")
        return path

    return write
