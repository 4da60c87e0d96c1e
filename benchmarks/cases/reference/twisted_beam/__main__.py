"""Write benchmarks/cases/data/second_method.toml."""

from benchmarks.cases.reference.twisted_beam.cases import main

if __name__ == "__main__":
    main()
