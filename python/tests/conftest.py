import os
import pathlib
import signal
import warnings

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("MPLBACKEND", "Agg")

import pytest

import cattaneo

# A shell that starts tests in the background has them ignore Ctrl-C, which some of them send to themselves.
signal.signal(signal.SIGINT, signal.default_int_handler)

ROOT = pathlib.Path(__file__).resolve().parents[2]


def pytest_configure(config):
    config.addinivalue_line("markers", "rest: a test that ./test leaves to ./test --all and ./test --room")


@pytest.fixture
def root():
    """The repository, whose problems, decks and pages tests read."""
    return ROOT


@pytest.fixture(autouse=True)
def outcomes_are_errors():
    """A march that does not converge fails a test, unless the test expects the warning."""
    with warnings.catch_warnings():
        warnings.simplefilter("error", cattaneo.OutcomeWarning)
        yield
