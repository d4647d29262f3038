import pytest
import result_maker


@pytest.fixture(scope="session")
def result(tmp_path_factory):
    """A whole result directory with a few frames of fields (read only)."""
    return result_maker.write_result(tmp_path_factory.mktemp("result"), frames=4, along=18)


@pytest.fixture
def record():
    """Values of a whole, valid outcome, free to be changed."""
    return result_maker.values()
