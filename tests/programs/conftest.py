"""Fixtures of the tests that run programs."""

import pathlib
import tempfile

import pytest

from programs import ROOT, Runner


def pytest_addoption(parser):
    parser.addoption("--programs", default=ROOT / "build" / "release" / "miniapps", help="folder of the programs")


def pytest_configure(config):
    config.addinivalue_line("markers", "rest: a test that ./test leaves to ./test --all and ./test --room")


@pytest.fixture
def run(request):
    """Runs programs; an empty folder of its own has the files of the test."""
    with tempfile.TemporaryDirectory() as folder:
        yield Runner(pathlib.Path(folder).resolve(), pathlib.Path(request.config.getoption("--programs")).resolve())
