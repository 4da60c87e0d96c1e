"""What goes into and out of the interactive programs in a real browser: files, pictures, tables, sweeps."""

import csv
import xml.etree.ElementTree as ET

import pytest

from tests.app.browsing import drawing, field, go, kept, redrawn, shown
from tests.app.serving import IN_BROWSER, NO_PLAYWRIGHT, PATIENCE, free_port, start, stop

sync_api = pytest.importorskip("playwright.sync_api", reason=NO_PLAYWRIGHT)
expect = sync_api.expect
expect.set_options(timeout=1e3 * PATIENCE)
pytestmark = IN_BROWSER


def downloaded(page, action, file):
    """A file that an action hands over."""
    with page.expect_download() as handed:
        action()
    handed.value.save_as(file)
    return file


def from_menu(page, entry):
    page.get_by_role("button", name="File").click()
    page.get_by_text(entry, exact=True).click()


def give(page, file):
    """Choose a file in the dialog that opens one."""
    from_menu(page, "Open a file")
    page.locator("input[type=file]").set_input_files(file)


def test_save_open_and_report(page, tmp_path):
    wheelbase = field(page, "wheelbase, L")
    wheelbase.fill("2.0 m")
    kept(page, "2.0 m")
    file = downloaded(page, lambda: from_menu(page, "Save as TOML"), tmp_path / "mine.toml")
    saved = file.read_text(encoding="utf-8")
    assert 'wheelbase = "2.0 m"' in saved
    file.write_text(saved.replace("2.0 m", "2.1 m"), encoding="utf-8")
    give(page, file)
    expect(wheelbase).to_have_value("2.1 m")
    report = downloaded(page, lambda: from_menu(page, "Report as HTML"), tmp_path / "report.html")
    assert report.read_text(encoding="utf-8").count("data:image/svg+xml") >= 3


@pytest.mark.parametrize("program, name", [("brakes", "Internal forces"), ("beamdyn", "Frequencies")])
def test_pictures_and_table_of_a_screen(opened, tmp_path, program, name):
    page = opened(program)
    go(page, name)

    def get(kind):
        button = page.get_by_role("button", name=f"download {name} as {kind}")
        return downloaded(page, button.click, tmp_path / kind)

    assert ET.parse(get("SVG")).getroot().tag == "{http://www.w3.org/2000/svg}svg"
    picture = get("PNG").read_bytes()
    assert picture.startswith(b"\x89PNG\r\n\x1a\n") and picture.rstrip().endswith(b"IEND\xaeB`\x82")
    with get("CSV").open(newline="") as file:
        rows = [*csv.reader(file)]
    assert len(rows) > 10
    assert {len(row) for row in rows} == {len(rows[0])}


def test_sweep_is_drawn_and_handed_over(page, tmp_path):
    page.get_by_role("button", name="Sweep an input").click()
    page.get_by_role("button", name="Sweep", exact=True).click()
    chart = page.get_by_role("img", name="distance [m] over speed [km/h]; distance")
    expect(chart.locator("svg path").first).to_be_attached()
    button = page.get_by_role("button", name="Sweep as CSV")
    file = downloaded(page, button.click, tmp_path / "sweep.csv")
    with file.open(newline="") as opened_file:
        rows = [[float(cell) for cell in row] for row in [*csv.reader(opened_file)][1:]]
    assert len(rows) == 21
    assert [row[0] for row in rows] == pytest.approx(range(10, 31), rel=1e-12)
    assert rows == sorted(rows, key=lambda row: row[1])  # the faster, the farther


# Hostile files ------------------------------------------------------------------------------------------

SCRIPT = "<img src=x onerror=alert(1)><script>alert(1)</script>"
REFUSED = {
    "path.toml": (b"[truck]\nfile = '/etc/passwd'\n", "truck.file"),
    "include.toml": (b"include = '../../secrets.toml'\n[truck]\n", "include"),
    "script.toml": (f"[truck]\nempty_mass = '{SCRIPT}'\n".encode(), SCRIPT),
    "key.toml": (b"[truck]\n'\"><script>alert(1)</script>' = 1\n", '"><script>alert(1)</script>'),
    "python.toml": (b"__import__('os').system('touch here')\n", "python.toml"),
    "binary.toml": (bytes(range(256)) * 8, "not text in UTF-8"),
    "large.toml": (b"# large\n" * 37_500, "larger than 200000 bytes"),
    f"{SCRIPT.replace('/', '')}.toml": (b"[truck]\n", "missing"),
}


@pytest.fixture(scope="module")
def visited(shared, tmp_path_factory):
    """The page of a program that was started in an empty folder, and that folder."""
    folder, port = tmp_path_factory.mktemp("served"), free_port()
    process = start(port, folder=folder)
    yield shared(at=f"http://127.0.0.1:{port}/"), folder
    stop(process)


@pytest.mark.parametrize("name", REFUSED)
def test_hostile_file_is_refused_in_words(visited, tmp_path, name):
    page, folder = visited
    before = drawing(page)
    content, sentence = REFUSED[name]
    file = tmp_path / name
    file.write_bytes(content)
    give(page, file)
    expect(page.locator(".q-dialog .mistake")).to_contain_text(sentence)
    assert page.locator(".q-dialog script, .q-dialog img[src=x]").count() == 0
    page.get_by_role("button", name="Close").click()
    expect(page.locator(".q-dialog")).to_have_count(0)
    assert drawing(page) == before
    assert [*folder.iterdir()] == []


def test_markup_in_a_design_stays_text(visited, tmp_path):
    page, folder = visited
    file = tmp_path / "caliper.toml"
    file.write_text(f'caliper = "v-brake"\ntitle = "{SCRIPT}"\n[run]\nfinger = "40 N"\n', encoding="utf-8")
    before = drawing(page)
    give(page, file)
    page.wait_for_selector(".board[data-words^='Caliper']")
    redrawn(page, before)
    expect(field(page, "title")).to_have_value(SCRIPT)
    expect(shown(page, SCRIPT)).to_be_visible()
    assert page.locator("img[src=x]").count() == 0
    assert [*folder.iterdir()] == []
