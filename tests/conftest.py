import os

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
