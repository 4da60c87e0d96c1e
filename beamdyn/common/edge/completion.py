"""The command that lets a shell complete commands and options."""

from __future__ import annotations

from typing import Literal

from cyclopts import App

from beamdyn.common.edge.program import examples

Shell = Literal["bash", "zsh", "fish"]


def add_completion(app: App) -> None:
    """Give a program's command line the command `completion`.

    Parameters
    ----------
    app : App
        The command line.
    """
    name = app.name[0]

    @app.command(help_epilogue=examples(f"{name} completion bash"))
    def completion(shell: Shell, /) -> None:
        """Print the script by which a shell completes commands and options at the Tab key.

        Where it goes: ~/.local/share/bash-completion/completions (bash), a folder of fpath (zsh) or
        ~/.config/fish/completions (fish).

        Parameters
        ----------
        shell
            The shell.
        """
        print(app.generate_completion(shell=shell), end="")
