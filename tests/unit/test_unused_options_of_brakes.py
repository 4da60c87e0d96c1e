"""Options of the brakes' commands that nothing would use are refused, and no file is missing in silence."""

import pytest

from brakes.cli import main


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (
            ("--free-bodies", "b.png"),
            "--free-bodies = b.png: it shows one design; leave --vary out",
        ),
        (
            ("--animation", "a.gif"),
            "--animation = a.gif: it shows one design; leave --vary out",
        ),
    ],
)
@pytest.mark.parametrize("how", [("--vary", "clearance=1:2:3 mm"), ("--spread", "clearance=+-1%")])
def test_pictures_of_one_design_are_refused_for_many(how, options, said, capsys, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    assert main(["caliper", "v-brake", *how, *options]) == 2
    assert said.replace("--vary", how[0]) in " ".join(capsys.readouterr().err.split())
    assert not [*tmp_path.iterdir()]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("v-brake",), "MECHANISM = v-brake: "),
        (("--plot", "p.png"), "--plot = p.png: "),
        (("--animation", "a.gif"), "--animation = a.gif: "),
        (("--vary", "clearance=1:2:3 mm"), "--vary = clearance=1:2:3 mm: "),
        (("--what", "finger_travel"), "--what = finger_travel: "),
    ],
)
def test_the_list_of_calipers_takes_nothing_else(arguments, said, finished, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    err = " ".join(finished(main(["caliper", "--list", *arguments]), 2).err.split())
    name = said.partition(" ")[0]
    assert f"{said}--list only lists the named calipers; leave out --list or {name}" in err
