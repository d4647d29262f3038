import pytest

HEADER = "test,v_n_m_per_s,v_t_m_per_s,V_n_m_per_s,V_t_m_per_s,Omega_rad_per_s"


@pytest.fixture
def camera_file(tmp_path):
    """Write a CSV of tests and return its path."""

    def write(*lines, header=HEADER, name="mine.csv"):
        path = tmp_path / name
        path.write_text("\n".join([header, *lines]) + "\n", encoding="utf-8")
        return path

    return write
