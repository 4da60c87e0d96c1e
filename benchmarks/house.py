"""Size and complexity of the code: what runs for an answer, parses sentences, is imported late.

Run: python -m benchmarks.house            (½ minute; --list prints what the rows of prose and circles count)

What is counted, of the packages beamdyn and brakes alone:

- modules run by a command: those of which anything but the module's own body runs (functions, bodies of
  classes, comprehensions), from the start of the command in a fresh process to its end (`sys.setprofile`);
- named functions of one warm `natural_modes`: functions and methods entered by a second call, on another
  scene of the same kind; comprehensions, lambdas, and what `dataclass` generates do not count;
- substring tests on sentences: `a in b` with a text or a constant a, `b.startswith(a)` and the like, where b
  is called or made from something called warning, sentence, message, note, remark, advice, refusal, said or
  error (also b of `for b in result.warnings`);
- regular expressions on prose: those written in the code, but for the modules of `READERS`, which read what
  people and other programs write, and those applied at once to what is called a name, label, place, field or
  number;
- imports inside functions: import statements, and calls of `import_module`;
- circles: groups of modules that import each other, late imports and `import_module("...")` included;
- module names used more than once in a package, but for the fixed pattern of its rooms: a brake has its name
  in each of brakes' answers, config, drawings and machines;
- code lines: lines that are neither blank nor comment nor docstring.
"""

from __future__ import annotations

import ast
import re
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from functools import cache
from pathlib import Path
from types import CodeType, FrameType

import numpy as np

from benchmarks.rows import Row, show

ROOT = Path(__file__).parents[1]
PACKAGES = ("beamdyn", "brakes")
COMMANDS = (
    (("beamdyn", "modes", "examples/tyre_harvester.toml"), "75"),
    (("brakes", "caliper", "v-brake"), "60"),
)
PATTERN = {("brakes", room) for room in ("answers", "config", "drawings", "machines")}
BENT = (  # modules that compute large deflections
    *("equations/beam_in_space/*.py", "modes/equilibria.py", "modes/modal/equilibrium.py"),
    *("modes/modal/continuation.py", "transient/elastica_*.py", "transient/beam_in_space_system.py"),
)
BODIES = {"<module>", "<lambda>", "<listcomp>", "<setcomp>", "<dictcomp>", "<genexpr>"}
PROSE = re.compile(r"warning|sentence|message|note(?!d)|remark|advice|refusal|said|error")
NAMED = re.compile(r"(name|label|place|field|number)\b")  # names of variables that hold no sentences
TESTS = {"startswith", "endswith", "find", "count", "index"}
PATTERNS = {"compile", "match", "fullmatch", "search", "sub", "split", "findall", "finditer"}
# Modules whose patterns read what a person or another program wrote: options, entries of forms, files.
READERS = {
    "beamdyn/analyses/about_loads.py",
    "beamdyn/analyses/about_linear_models.py",
    "beamdyn/analyses/about_data.py",
    "beamdyn/analyses/values.py",
    "beamdyn/app/scene_form.py",
    "beamdyn/analyses/about_campbell.py",
    "beamdyn/common/screens/examples.py",
    "beamdyn/common/screens/form_entries.py",
    "beamdyn/common/screens/open_document.py",
    "beamdyn/common/screens/server.py",
    "beamdyn/common/drawing/text_width.py",
    "beamdyn/common/edge/toml_columns.py",
    "beamdyn/common/edge/data_text.py",
    "beamdyn/common/edge/rendering.py",
    "beamdyn/common/edge/units.py",
    "beamdyn/common/edge/varied_inputs.py",
    "beamdyn/common/parallel/tasks.py",
    "beamdyn/common/inputs/described.py",
    "beamdyn/common/spreading/tolerances.py",
    "beamdyn/files/decks/blade.py",
    "beamdyn/files/measured_curve_files.py",
    "beamdyn/files/measured_data.py",
    "beamdyn/files/program_tables.py",
    "beamdyn/files/scenes.py",
    "beamdyn/common/plots/campbell.py",
    "beamdyn/scene/numbers.py",
    "brakes/answers/finding.py",
}
PROBE = "import sys; from benchmarks.house import probe; probe(sys.argv[1:])"

Function = ast.FunctionDef | ast.AsyncFunctionDef


# What runs --------------------------------------------------------------------------------------------


class Profile:
    """A function for `sys.setprofile` that records the functions of both packages that are called."""

    def __init__(self) -> None:
        self.entered: set[CodeType] = set()

    def __call__(self, frame: FrameType, event: str, arg: object) -> None:
        if event == "call":
            self.entered.add(frame.f_code)

    def functions(self) -> set[tuple[str, str, int]]:
        """List file, name and line of each function or comprehension that was entered."""
        ours = [str(ROOT / package) for package in PACKAGES]
        return {
            (code.co_filename, code.co_name, code.co_firstlineno)
            for code in self.entered
            if code.co_filename.startswith(tuple(ours)) and code.co_name != "<module>"
        }


def probe(arguments: Sequence[str]) -> None:
    """Run a command in this process, and print to standard error the modules whose functions have run."""
    import atexit

    package, *rest = arguments
    sys.argv = [package, *rest]
    profile = Profile()

    def report() -> None:
        sys.setprofile(None)
        files = {file for file, _, _ in profile.functions()}
        print(f"modules run: {' '.join(sorted(files))}", file=sys.stderr)

    atexit.register(report)
    sys.setprofile(profile)
    main = __import__(f"{package}.cli", fromlist=["main"]).main
    sys.exit(main())


def modules_run(command: Sequence[str]) -> list[str]:
    """List the files of the modules that a command runs."""
    done = subprocess.run(
        [sys.executable, "-c", PROBE, *command], cwd=ROOT, capture_output=True, text=True, check=True
    )
    (line,) = (line for line in done.stderr.splitlines() if line.startswith("modules run: "))
    return line.split()[2:]


def functions_of_modes() -> set[tuple[str, str, int]]:
    """List file, name and line of each named function that a second call of `natural_modes` enters."""
    import beamdyn as bd

    beam = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    first, second = (bd.Scene(beam, bd.Mount(radius)) for radius in (0.215, 0.216))
    bd.natural_modes(first, 50.0, 3)
    profile = Profile()
    sys.setprofile(profile)
    bd.natural_modes(second, 50.0, 3)
    sys.setprofile(None)
    return {each for each in profile.functions() if each[1] not in BODIES}


# What the source code contains ------------------------------------------------------------------------


@cache
def _tree(path: Path) -> ast.Module:
    return ast.parse(path.read_text(encoding="utf-8"))


def sources() -> list[Path]:
    """List all modules of both packages."""
    return sorted(path for package in PACKAGES for path in (ROOT / package).rglob("*.py"))


def _is_prose(node: ast.AST, made_of: dict[str, ast.expr]) -> bool:
    """Return whether an expression has a name typical of sentences, or is made from one."""
    # The attribute of an error is a key, not a sentence.
    if isinstance(node, ast.Attribute) and node.attr == "field":
        return False
    names = {n.id for n in ast.walk(node) if isinstance(n, ast.Name)}
    called = names | {n.attr for n in ast.walk(node) if isinstance(n, ast.Attribute)}
    called |= {
        n.attr
        for name in names & made_of.keys()
        for n in ast.walk(made_of[name])
        if isinstance(n, ast.Attribute)
    }
    return isinstance(node, (ast.Name, ast.Attribute, ast.JoinedStr, ast.Call)) and any(
        map(PROSE.search, called)
    )


def sentence_tests(tree: ast.Module) -> Iterator[ast.expr]:
    """Yield tests of whether something occurs in a sentence."""
    for function in (node for node in ast.walk(tree) if isinstance(node, Function)):
        loops = (n for n in ast.walk(function) if isinstance(n, (ast.For, ast.comprehension)))
        made_of = {loop.target.id: loop.iter for loop in loops if isinstance(loop.target, ast.Name)}
        for node in ast.walk(function):
            if isinstance(node, ast.Compare) and isinstance(node.ops[0], (ast.In, ast.NotIn)):
                text = isinstance(node.left, ast.Constant) and isinstance(node.left.value, str)
                constant = isinstance(node.left, ast.Name) and node.left.id.isupper()
                if (text or constant) and _is_prose(node.comparators[0], made_of):
                    yield node
            elif isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
                tested = node.func.attr in TESTS and bool(node.args)
                if tested and _is_prose(node.func.value, made_of):
                    yield node


def patterns(tree: ast.Module) -> Iterator[ast.expr]:
    """Yield regular expressions written in a module, except those applied to names and numbers."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
            module = node.func.value
            if isinstance(module, ast.Name) and module.id == "re" and node.func.attr in PATTERNS:
                subject = ast.unparse(node.args[-1])
                if node.func.attr == "compile" or not NAMED.match(subject):
                    yield node


def late_imports(tree: ast.Module) -> int:
    """Count import statements and calls of `import_module` inside functions."""
    inside = {node for f in ast.walk(tree) if isinstance(f, Function) for node in ast.walk(f)}
    statements = sum(isinstance(node, (ast.Import, ast.ImportFrom)) for node in inside)
    return statements + sum(_imports(node) for node in ast.walk(tree))


def _imports(node: ast.AST) -> bool:
    """Return whether a syntax node calls `import_module`."""
    return isinstance(node, ast.Call) and getattr(node.func, "id", "") == "import_module"


def circles() -> list[list[str]]:
    """List groups of modules that import each other, `import_module("...")` included."""
    import grimp
    from scipy.sparse import csr_array
    from scipy.sparse.csgraph import connected_components

    graph = grimp.build_graph(*PACKAGES, cache_dir=None)
    names = sorted(graph.modules)
    arrows = [(a, b) for a in names for b in graph.find_modules_directly_imported_by(a)]
    arrows += [(a, b) for a, b in _dynamic_imports() if b in names]
    imports = np.zeros((len(names), len(names)), dtype=bool)
    imports[[names.index(a) for a, _ in arrows], [names.index(b) for _, b in arrows]] = True
    _, groups = connected_components(csr_array(imports), connection="strong")
    large = [group for group, n in Counter(groups.tolist()).items() if n > 1]
    return [[name for name, g in zip(names, groups, strict=True) if g == group] for group in large]


def _dynamic_imports() -> Iterator[tuple[str, str]]:
    """Yield each module with a module that it imports by `import_module("...")`."""
    for path in sources():
        name = ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")
        for node in ast.walk(_tree(path)):
            if isinstance(node, ast.Call) and _imports(node) and isinstance(node.args[0], ast.Constant):
                yield name, str(node.args[0].value)


def names_used_again() -> list[str]:
    """List names that several modules of a package have, outside rooms with a fixed pattern."""
    rooms = {p: p.relative_to(ROOT).parts for p in sources() if p.stem != "__init__"}
    stems = Counter((parts[0], p.stem) for p, parts in rooms.items() if parts[:2] not in PATTERN)
    return [f"{package}: {stem}" for (package, stem), n in stems.items() if n > 1]


def code_lines(path: Path) -> int:
    """Count lines that are neither blank nor comment nor docstring."""
    documented: set[int] = set()
    for node in ast.walk(_tree(path)):
        if isinstance(
            node, (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)
        ) and ast.get_docstring(node):
            documented.update(range(node.body[0].lineno, (node.body[0].end_lineno or 0) + 1))
    lines = enumerate(path.read_text(encoding="utf-8").split("\n"), 1)
    return sum(i not in documented and bool(line.strip()) and line.strip()[0] != "#" for i, line in lines)


# Rows -------------------------------------------------------------------------------------------------


def count_what_runs() -> Iterator[Row]:
    """Yield the numbers of modules run by two commands, and of functions called for one answer."""
    for command, bound in COMMANDS:
        yield f"modules run by `{' '.join(command)}`", f"{len(modules_run(command))}", bound
    yield "named functions entered by a warm natural_modes", f"{len(functions_of_modes())}", "130"


def count_readings_of_prose() -> Iterator[Row]:
    """Yield the numbers of tests and patterns by which code parses its own sentences."""
    tests = sum(1 for path in sources() for _ in sentence_tests(_tree(path)))
    yield "substring tests on sentences", f"{tests}", "0"
    prose = (path for path in sources() if path.relative_to(ROOT).as_posix() not in READERS)
    yield "regular expressions on prose", f"{sum(1 for path in prose for _ in patterns(_tree(path)))}", "0"


def count_modules() -> Iterator[Row]:
    """Yield counts of late imports, circles, repeated names and code lines."""
    yield "imports inside functions", f"{sum(late_imports(_tree(path)) for path in sources())}", "90"
    yield "circles, `import_module` counted", f"{len(circles())}", "0"
    yield "module names used more than once, but for the pattern of rooms", f"{len(names_used_again())}", "10"
    entries = [entry for entry in (ROOT / "beamdyn").iterdir() if entry.name != "__pycache__"]
    yield "entries directly in beamdyn", f"{len(entries)}", "20"
    bent = sum(code_lines(path) for pattern in BENT for path in (ROOT / "beamdyn").glob(pattern))
    yield "code lines of what computes bent beams", f"{bent}", "1600"
    yield "code lines", f"{sum(map(code_lines, sources()))}", "40000"


def main() -> None:
    if "--list" in sys.argv:  # print the items that the rows count
        for path in sources():
            name = path.relative_to(ROOT).as_posix()
            for node in sentence_tests(_tree(path)):
                print(f"sentence  {name}:{node.lineno}  {ast.unparse(node)}")
            for node in () if name in READERS else patterns(_tree(path)):
                print(f"pattern   {name}:{node.lineno}  {ast.unparse(node)[:80]}")
        print(circles(), names_used_again())
    show("house", count_what_runs, count_readings_of_prose, count_modules)


if __name__ == "__main__":
    main()
