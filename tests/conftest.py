import gc
import os
import sys
from collections import defaultdict
from collections.abc import Callable, Iterator

import pytest
from _pytest.capture import CaptureResult
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

# Set before anything imports matplotlib or numpy. One thread each: BLAS threads of parallel workers collide.
os.environ["MPLBACKEND"] = "Agg"
for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    if "PYTEST_XDIST_WORKER" in os.environ:
        os.environ.setdefault(variable, "1")

# The same examples each time; others are tried by pytest --hypothesis-profile explore.
settings.register_profile(
    "seeded", derandomize=True, deadline=None, suppress_health_check=[HealthCheck.too_slow]
)
settings.register_profile(
    "explore", deadline=None, print_blob=True, suppress_health_check=[HealthCheck.too_slow]
)
settings.load_profile("seeded")


FEW, EVERY = 4, 8  # cases of a test that all run in every run; of more, one in eight
WHOLE = {"literature"}  # folders of which every case runs: each published number


def pytest_addoption(parser):
    parser.addoption(
        "--sample",
        type=int,
        choices=range(EVERY),
        default=0,
        help="which of the samples of tests with many cases",
    )


@pytest.hookimpl(wrapper=True)
def pytest_collection():
    """Look for garbage after collection, and never in what it imported and made: that stays for the run.

    At its first use hypothesis asks the garbage collector what refers to its generator of random numbers, and
    warns if nothing does: that is before the modules are frozen, and no longer seen.
    """
    gc.disable()
    try:
        return (yield)
    finally:
        given(st.none())(lambda _: None)()
        gc.freeze()
        gc.enable()


@pytest.hookimpl(tryfirst=True)  # before pytest selects by marks
def pytest_collection_modifyitems(config, items):
    """Mark as `more` the cases of a test beyond a sample; a case that is named on the command line runs."""
    tests = defaultdict(list)
    for item in items:
        tests[item.nodeid.partition("[")[0]].append(item)
    for name, cases in tests.items():
        is_sampled = (
            len(cases) > FEW and name.split("/")[1] not in WHOLE and "browser" not in cases[0].keywords
        )
        for i, case in enumerate(cases):
            if is_sampled and i % EVERY != config.getoption("sample"):
                case.add_marker(pytest.mark.more)


@pytest.fixture(autouse=True)
def close_figures() -> Iterator[None]:
    """Close figures a test left open: pyplot warns at the 21st, whichever tests a worker happens to run."""
    yield
    if "matplotlib.pyplot" in sys.modules:
        sys.modules["matplotlib.pyplot"].close("all")


Finished = Callable[[int, int], CaptureResult[str]]


@pytest.fixture
def finished(capsys: pytest.CaptureFixture[str]) -> Finished:
    """Return a function that checks the exit code of a command, and returns what it has printed."""

    def finished(code: int, expected: int) -> CaptureResult[str]:
        assert code == expected
        return capsys.readouterr()

    return finished
