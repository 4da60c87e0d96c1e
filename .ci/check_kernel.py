"""Fail unless numpy's and scipy's BLAS run under the kernel that OPENBLAS_CORETYPE names."""

import os
import sys

import numpy as np
import scipy.linalg
from threadpoolctl import threadpool_info

ALSO_CALLED = {"Prescott": {"Katmai"}}  # OpenBLAS may report a kernel by an older one's name
wanted = os.environ["OPENBLAS_CORETYPE"]
loaded = {
    each["filepath"]: each.get("architecture") for each in threadpool_info() if each["user_api"] == "blas"
}
print(f"numpy {np.__version__}, scipy {scipy.__version__}: {loaded}")
if not loaded or not {*loaded.values()} <= {wanted} | ALSO_CALLED.get(wanted, set()):
    sys.exit(f"BLAS runs under {sorted(map(str, loaded.values()))}, not under {wanted}")
