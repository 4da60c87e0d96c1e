"""Lists of a mechanism's parts: a toggle clamp from nothing, names that follow, what is missing."""

import tomllib
from pathlib import Path

import numpy as np
import pytest

from beamdyn.common.screens.form_entries import tables_of
from beamdyn.common.screens.lists import gone_with
from beamdyn.common.screens.open_document import OpenDocument
from brakes.app.mechanism_lists import add, advice, covers, empty, groups, put, remove
from brakes.app.program import BRAKES, MECHANISM

SCREEN = MECHANISM.screens[0]
CLAMP = (Path(__file__).parents[2] / "examples" / "calipers" / "toggle-clamp.toml").read_text("utf-8")

BLOCK = (Path(__file__).parents[2] / "examples" / "block_brake.toml").read_text("utf-8")
OWN = (Path(__file__).parents[2] / "examples" / "calipers" / "own-caliper.toml").read_text("utf-8")


def item(entries, name):
    return next(one for group in groups(entries) for one in group.items if one.name == name)


def tables(entries):
    return tables_of(entries, MECHANISM.inputs(entries))


def write(entries, name, /, **values):
    """Type values into the cells of an item, its name last."""
    for key, text in sorted(values.items(), key=lambda pair: pair[0] == "name"):
        entries = put(entries, item(entries, name), key, text)
    return entries


def built():
    """The toggle clamp of the examples, built by adding and choosing alone; advice at each step."""
    said = []
    entries = empty(MECHANISM.base_entries)
    said.append(advice(entries))
    entries = write(entries, "body 1", name="handle")
    entries = write(add(entries, "body"), "body 1", name="arm")
    for name in ("C", "D", "E", "grip"):
        made = add(entries, "point")
        (new,) = set(tables(made)["points"]) - set(tables(entries)["points"])
        entries = write(made, new, name=name) if new != name else made
    there = {"A": (0, -40), "B": (0, 0), "C": (20, 20), "D": (40, 54.64101615137754), "E": (60, -40)}
    for name, (x, y) in {**there, "grip": (80, 12)}.items():
        entries = write(entries, name, x=f"{x}", y=f"{y} mm")
    entries = write(add(entries, "pin"), "pin 1", body="arm", at="A")
    said.append(advice(entries))
    entries = write(add(entries, "pin"), "pin 2", body="arm", other="handle", at="B")
    entries = write(add(entries, "bar"), "bar 1", name="CD", body="handle", at="C", to="D")
    said.append(advice(entries))
    entries = write(add(entries, "force"), "force 1", body="handle", at="grip", name="hand")
    said.append(advice(entries))
    entries = write(add(entries, "force"), "force 1", body="arm", at="E", direction="90", name="work")
    said.append(advice(entries))
    entries = write(entries, "stroke", driver="hand", travel="14")
    said.append(advice(entries))
    return entries, said


def solved(entries):
    work = OpenDocument(MECHANISM)
    work.show(entries)
    assert work.solve(SCREEN), work.mistakes
    return work.answered[SCREEN.name].answer


def test_a_toggle_clamp_is_built_from_nothing():
    entries, _ = built()
    work = OpenDocument(MECHANISM)
    work.open(CLAMP, "clamp.toml")
    work.put("run.points", "")
    one, other = solved(entries), solved(work.entries)
    np.testing.assert_allclose(one.over.amplitudes["work"], other.over.amplitudes["work"], rtol=1e-12)
    assert not SCREEN.notes(one)


def test_a_coordinate_keeps_the_other_that_was_typed_before():
    """A field of the page is made once: what it knows of the point is older than what was typed beside it."""
    entries = empty(MECHANISM.base_entries)
    made = item(entries, "B")
    entries = put(put(entries, made, "x", "7"), made, "y", "9")
    assert tables(entries)["points"]["B"] == ["7 mm", "9 mm"]


def test_a_point_that_is_added_lies_on_no_other():
    """The third point of a mechanism from nothing lay on the second, which could not be dragged."""
    entries = empty(MECHANISM.base_entries)
    for _ in range(12):
        entries = add(entries, "point")
        places = [tuple(at) for at in tables(entries)["points"].values()]
        assert len(set(places)) == len(places)


def test_at_each_step_advice_says_what_is_missing():
    _, said = built()
    words = (
        "held by the ground",
        "Nothing holds handle",
        "Add a force",
        "without magnitude: 0",
        "To see the mechanism move",
    )
    for sentences, word in zip(said, words, strict=False):
        assert any(word in sentence for sentence in sentences), (word, sentences)
    assert said[-1] == []


@pytest.mark.parametrize("steps", range(4))
def test_each_state_on_the_way_is_drawn_or_explained(steps):
    entries = empty(MECHANISM.base_entries)
    for kind in ("body", "point", "pin", "bar")[:steps]:
        entries = add(entries, kind)
    work = OpenDocument(MECHANISM)
    work.show(entries)
    if work.solve(SCREEN):
        ((drawing,),) = SCREEN.drawings(work.answered[SCREEN.name].answer, 1.0)
        assert {label.text for label in drawing.labels} >= set(tables(entries)["points"])
    else:
        assert any(work.mistakes[SCREEN.name].values())


def test_the_document_stays_the_file():
    entries = MECHANISM.opened(CLAMP, "clamp")
    for group in groups(entries):
        for one in group.items:
            for cell in one.cells:
                if cell.key != "name" and cell.text:
                    assert tables(put(entries, one, cell.key, cell.text)) == tables(entries), (one, cell)
    assert tables(entries) == tomllib.loads(CLAMP)
    assert all(covers(path) for path in entries if path.partition(".")[0] in ("bodies", "points", "pin"))


@pytest.mark.parametrize("old, new", [("handle", "lever"), ("C", "knee"), ("force hand", "fist")])
def test_what_names_a_thing_follows_when_it_is_renamed(old, new):
    entries = MECHANISM.opened(CLAMP, "clamp")
    renamed = put(entries, item(entries, old), "name", new)
    before = solved(entries).over.amplitudes["work"]
    np.testing.assert_allclose(solved(renamed).over.amplitudes["work"], before, rtol=1e-14)
    assert f'"{old.removeprefix("force ")}"' not in str(renamed.values()).replace("'", "")


def test_the_centre_of_a_round_face_is_one_of_the_points():
    entries = MECHANISM.opened(BLOCK, "block")
    axle = item(entries, "axle")
    assert tables(put(entries, axle, "name", "hub"))["contact"][0]["centre"] == "hub"
    assert "contact block" in gone_with(axle, groups(entries), groups(remove(entries, axle)))
    (centre,) = (cell for cell in item(entries, "contact block").cells if cell.key == "centre")
    assert "axle" in centre.options


def test_what_drives_the_stroke_no_longer_does_when_it_is_removed():
    entries = MECHANISM.opened(CLAMP, "clamp")
    assert "driver" not in tables(remove(entries, item(entries, "force hand"))).get("run", {})


@pytest.mark.parametrize(
    "name, along",
    [
        ("handle", ["pin B", "bar CD", "force hand"]),
        ("arm", ["pin A", "pin B", "force work"]),
        ("C", ["bar CD"]),
        ("grip", ["force hand"]),
        ("force work", []),
    ],
)
def test_what_names_a_body_or_point_goes_with_it(name, along):
    entries = MECHANISM.opened(CLAMP, "clamp")
    gone = item(entries, name)
    left = remove(entries, gone)
    assert gone_with(gone, groups(entries), groups(left)) == along
    assert all(name not in part.values() for part in _parts_of(left))
    assert "driver" not in tables(left).get("run", {}) or "force hand" not in along


def _parts_of(entries):
    given = tables(entries)
    return [part for kind in ("pin", "bar", "force") for part in given.get(kind, [])]


@pytest.mark.parametrize(
    "name, left",
    [
        ("rotation lock springs", {"cable": "wire", "pads": ["right pad", "left pad"]}),
        ("force right pad", {"cable": "wire", "pads": ["left pad"], "centring": ["springs"]}),
        ("cable pair wire", {"pads": ["right pad", "left pad"], "centring": ["springs"]}),
        ("right arm", {"pads": ["left pad"]}),
        ("right_pad", {"cable": "wire", "pads": ["left pad"], "centring": ["springs"]}),
    ],
)
def test_what_is_removed_plays_no_role_in_the_caliper(name, left):
    entries = MECHANISM.opened(OWN, "own")
    roles = tables(remove(entries, item(entries, name)))["caliper"]
    assert roles == left | {"lever_ratio": 4, "clearance": "1.25 mm"}


def test_what_has_neither_cable_nor_pads_is_no_caliper():
    entries = MECHANISM.opened(OWN, "own")
    for name in ("left arm", "right arm"):
        entries = remove(entries, item(entries, name))
    assert "caliper" not in tables(entries)


def test_bare_numbers_take_the_unit_shown_and_decimal_commas_are_read():
    entries = MECHANISM.opened(CLAMP, "clamp")
    moved = write(entries, "C", x="18,5")
    assert tables(moved)["points"]["C"][0] == "18.5 mm"
    pushed = write(entries, "force hand", magnitude="250", direction="-80")
    hand = tables(pushed)["force"][0]
    assert hand["magnitude"] == "250 N" and hand["direction"] == "-80 deg"


# On the page --------------------------------------------------------------------------------------------


def press(user, words):
    """Click the first button of these words."""
    found = [
        e for e in user.client.elements.values()
        if e.tag == "q-btn" and words in (e.props.get("aria-label"), getattr(e, "text", None))
    ]  # fmt: skip
    with user.client:
        for listener in list(found[0]._event_listeners.values()):
            if listener.type == "click":
                found[0]._handle_event({"listener_id": listener.id, "args": {}})


def test_buttons_add_and_remove_and_lists_write_into_the_document(simulate, fields):
    async def body(another):
        user = await another()
        page = fields(user)
        page.go("Mechanism")

        press(user, "Start from nothing")
        assert "held by the ground" in page.text()
        press(user, "add pin")
        assert page.field("pin.0.body").value == "body 1"
        with user.client:
            page.field("pin.0.at").set_value("A")
        press(user, "add point")
        assert page.field("points.C.x").value == "40 mm"
        press(user, "remove C")
        with pytest.raises(IndexError):
            page.field("points.C.x")
        press(user, "add force")
        assert "without magnitude" in page.text()

    simulate(BRAKES, body)


def test_what_goes_along_with_a_body_is_said_and_undo_brings_all_back(simulate, fields):
    async def body(another):
        user = await another()
        page = fields(user)
        page.go("Mechanism")
        press(user, "remove handle")
        assert user.notify.messages == [
            "Removed along with handle: pin B, bar CD, force hand. Undo brings all back."
        ]
        with pytest.raises(IndexError):
            page.field("pin.1.body")
        press(user, "Undo (Ctrl-Z)")
        assert (page.field("pin.1.other").value, page.field("bar.0.at").value) == ("handle", "C")
        assert page.field("run.driver").value == "hand"

    simulate(BRAKES, body)


def test_fields_stay_while_names_change_and_things_are_added(simulate, fields):
    """One that were made anew would lose the focus, or what is being typed into it."""

    async def body(another):
        page = fields(await another())
        page.go("Mechanism")
        name, x, other = (page.field(path) for path in ("points.C.name", "points.C.x", "points.D.x"))
        with page.user.client:
            other.set_value("41")  # and not left yet
        page.leave("points.C.name", "corner")
        assert (page.field("points.corner.name"), page.field("points.corner.x")) == (name, x)
        assert "corner" in page.field("bar.0.at").options and page.field("bar.0.at").value == "corner"
        assert other.value == "41"
        page.leave("points.D.x", "41")
        assert other.value == "41 mm"
        page.leave("points.corner.name", "D")  # which there is already
        assert name.value == "corner"

    simulate(BRAKES, body)


def test_a_change_of_a_list_is_solved_once(simulate, fields, monkeypatch):
    async def body(another):
        page = fields(await another())
        page.go("Mechanism")
        solved = []
        of_screen = OpenDocument.attempt
        monkeypatch.setattr(
            OpenDocument, "attempt", lambda *given, **named: solved.append(1) or of_screen(*given, **named)
        )
        page.leave("points.C.x", "21")
        assert solved == [1]

    simulate(BRAKES, body)


def test_what_stands_in_other_fields_stays_when_a_list_is_changed(simulate, fields):
    async def body(another):
        page = fields(await another())
        page.go("Mechanism")
        page.enter("run.friction", "0,2")
        page.leave("pin.0.radius", "8")
        assert page.field("pin.0.radius").value == "8 mm"
        assert page.field("run.friction").value == "0,2"

    simulate(BRAKES, body)
