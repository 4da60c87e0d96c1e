"""All figures that the README quotes, in one run.  Run: python -m benchmarks"""

from benchmarks.page import main

if __name__ == "__main__":  # the processes that it starts find what they run in a module of its own
    main()
