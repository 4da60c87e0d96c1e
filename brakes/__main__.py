"""Run the command line of brakes as ``python -m brakes``."""

import sys

from brakes.cli import main

if __name__ == "__main__":
    sys.exit(main())
