import os
from collections import defaultdict

import pytest
from hypothesis import HealthCheck, settings

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


FEW, EVERY = 4, 4  # cases of a test that all run in every run; of more, one in four
WHOLE = {"literature"}  # folders of which every case runs: each published number


@pytest.hookimpl(tryfirst=True)  # before pytest selects by marks
def pytest_collection_modifyitems(items):
    """Mark as `more` the cases of a test beyond a sample; a case that is named on the command line runs."""
    tests = defaultdict(list)
    for item in items:
        tests[item.nodeid.partition("[")[0]].append(item)
    for name, cases in tests.items():
        is_sampled = (
            len(cases) > FEW and name.split("/")[1] not in WHOLE and "browser" not in cases[0].keywords
        )
        for i, case in enumerate(cases):
            if is_sampled and i % EVERY:
                case.add_marker(pytest.mark.more)
