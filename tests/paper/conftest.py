import pytest

from fem_impact.cli import main

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


@pytest.fixture
def camera_file(tmp_path):
    """Write a CSV of tests and return its path."""

    def write(*lines, header=HEADER, name="mine.csv"):
        path = tmp_path / name
        path.write_text("\n".join([header, *lines]) + "\n", encoding="utf-8")
        return path

    return write
