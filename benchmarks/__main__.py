"""All figures that the README quotes, in one run: `python -m benchmarks`."""

from benchmarks.measured_page import main

# Imported in a module of its own, so that the processes it starts can import it, too.
if __name__ == "__main__":
    main()
