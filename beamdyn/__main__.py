"""Run the command line of beamdyn by ``python -m beamdyn``."""

import sys

from beamdyn.cli import main

if __name__ == "__main__":
    sys.exit(main())
