"""All figures that the README quotes, in one run: `python -m benchmarks`."""

from benchmarks.measured_page import main

# Defined in a separate module, so that the processes that it starts can import it, too.
if __name__ == "__main__":
    main()
