"""The interactive programs as servers: where they listen, and what they say when they cannot."""

import socket
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

import beamdyn.cli
import brakes.cli
from beamdyn.common.screens.app_command import MISSING
from tests.app.serving import free_port, listens_to, start, stop

COMMANDS = {"beamdyn": beamdyn.cli.main, "brakes": brakes.cli.main}
needs_server = pytest.mark.skipif(find_spec("nicegui") is None, reason=MISSING)
needs_proc = pytest.mark.skipif(not Path("/proc/net/tcp").exists(), reason="sockets are read from /proc")


def listeners(program, *options, folder):
    port = free_port()
    process = start(port, program, *options, folder=folder)
    try:
        return port, listens_to(process)
    finally:
        stop(process)


@needs_server
@needs_proc
@pytest.mark.parametrize("program", COMMANDS)
def test_only_this_computer_is_listened_to(program, tmp_path):
    port, found = listeners(program, folder=tmp_path)
    assert found == {("127.0.0.1", port)}
    assert [*tmp_path.iterdir()] == []  # nor does it write where it was started


@needs_server
@needs_proc
def test_others_are_listened_to_when_asked(tmp_path):
    port, found = listeners("brakes", "--host", "0.0.0.0", folder=tmp_path)
    assert found == {("0.0.0.0", port)}


@pytest.fixture(params=COMMANDS)
def said(request, capsys):
    """What a program says on standard error that does not start: a function of its options."""

    def run(*options):
        assert COMMANDS[request.param](["app", "--no-browser", *options]) == 2
        return capsys.readouterr().err

    return run


@needs_server
def test_port_that_is_taken(said):
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))
        other.listen()
        port = other.getsockname()[1]
        sentence = said("--port", str(port))
    assert f"--port = {port}" in sentence
    assert "give another --port" in sentence


@pytest.mark.parametrize("port", ["0", "-1", "65536"])
def test_port_that_is_none(said, port):
    assert f"--port = {port}: give a port from 1 to 65535" in said("--port", port)


def test_port_that_is_no_number(said):
    assert "--port" in (sentence := said("--port", "http")) and "whole number" in sentence


@needs_server
def test_address_that_is_not_of_this_computer(said):
    sentence = said("--host", "192.0.2.1", "--port", str(free_port()))  # of RFC 5737: nobody's
    assert "--host = 192.0.2.1" in sentence
    assert "leave --host out" in sentence


@needs_server
@pytest.mark.parametrize("host", ["", "  "])
def test_host_that_is_blank(said, host):
    sentence = said("--host", host, "--port", str(free_port()))
    assert f'--host = "{host}": it is blank' in sentence
    assert "such as 127.0.0.1, or leave --host out" in sentence


@needs_server
@pytest.mark.parametrize("host", ["no-such-host.invalid", "http://localhost", "a..b", "x" * 300])
def test_host_without_an_address(said, host):
    sentence = said("--host", host, "--port", str(free_port()))
    assert f'--host = "{host}": no address is known for it' in sentence
    assert "such as 127.0.0.1, or leave --host out" in sentence


def test_without_nicegui_it_says_what_to_install(said, monkeypatch):
    monkeypatch.setitem(sys.modules, "nicegui", None)
    monkeypatch.delitem(sys.modules, "beamdyn.common.screens.server", raising=False)
    assert MISSING in said("--port", str(free_port()))
