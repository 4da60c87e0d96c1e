"""Files that are written: tried before, written aside, and put in their place in one step."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path

ASIDE = ".unfinished-"  # begins the name of a file that is still being written


def as_path(name: str, value: object, wanted: str = "a file") -> Path:
    """The path that an argument is.

    Parameters
    ----------
    name : str
        Name of the argument, for the message.
    value : object
        Text or path.
    wanted : str
        Kind of thing that it names.

    Raises
    ------
    InvalidValue
        If it is neither text nor a path.
    """
    if not isinstance(value, str | os.PathLike):
        from beamdyn.common.inputs.checks import InvalidValue  # with numpy, which help does without

        raise InvalidValue(name, value, f"give the name of {wanted}, as text or path")
    return Path(value)


def check_writable(
    path: str | Path,
    suffixes: Sequence[str] = (),
    force: bool = False,
    remedy: str = "choose another name, or overwrite it with force",
) -> Path:
    """Check that a file can be written, by writing an empty one beside it.

    Parameters
    ----------
    path : str or Path
        File to write; a link stands for the file that it points to.
    suffixes : sequence of str
        Suffixes allowed, in lower case, with their dots; "" for a name without one; any if there are none.
    force : bool
        Overwrite a file that exists.
    remedy : str
        What to do about a file that exists.

    Returns
    -------
    Path

    Raises
    ------
    ValueError
        If it is no path, or the suffix is none of those allowed.
    FileExistsError
        If the file exists and `force` is not set.
    FileNotFoundError
        If there is no such folder.
    OSError
        If the path is a folder, or cannot be written for another reason.
    """
    path = as_path("path", path)
    if suffixes and path.suffix.lower() not in suffixes:
        known = ", ".join(filter(None, suffixes))
        raise ValueError(f"{path}: unknown suffix {path.suffix!r}; give one of {known}")
    if os.path.isdir(path):
        raise IsADirectoryError(f"{path}: it is a folder; give the name of a file")
    if os.path.isfile(path) and not _is_stream(path) and not force:
        raise FileExistsError(f"{path}: the file exists; {remedy}")
    if os.path.exists(path) and not os.access(path, os.W_OK):
        raise PermissionError(f"{path}: it is protected against writing; give another file")
    if not _is_stream(path):
        _try_to_write(path)
    return path


def _try_to_write(path: Path) -> None:
    """Write an empty file beside the file, and try its name."""
    target = Path(os.path.realpath(path))
    if not target.parent.is_dir():
        raise FileNotFoundError(f"{path}: there is no folder {target.parent}; create it first")
    try:
        _empty_file(target.parent, path.suffix).unlink()
        with suppress(FileNotFoundError):
            target.stat()
    except OSError as error:
        reason = error.strerror or str(error)
        raise OSError(f"{path}: it cannot be written ({reason}); give another file") from None


def _is_stream(path: Path) -> bool:
    """Whether it is a device, a pipe, or a name of an open file such as /dev/stdout: nothing to replace."""
    named = os.path.abspath(path.parent) in ("/dev", "/dev/fd", "/proc/self/fd")
    return os.path.exists(path) and (named or not os.path.isfile(path))


def same_file(one: str | Path, other: str | Path) -> bool:
    """Whether two paths lead to one file or folder, by links or another spelling; it need not exist."""
    try:
        return os.path.samefile(one, other)
    except (OSError, ValueError):  # one of them does not exist
        return os.path.realpath(one) == os.path.realpath(other)


@contextmanager
def replacing(path: str | Path) -> Iterator[Path]:
    """Give a temporary file to write; when all is written, it takes the place of `path` in one step.

    Whenever the program ends, the file at `path` is the old one or the new one, whole.  Where `path` is a
    link, what it points to is replaced; a device or a pipe receives what was written.

    Parameters
    ----------
    path : str or Path
        File to write; its folder exists.

    Yields
    ------
    Path
        A file with the same suffix, empty.

    Raises
    ------
    OSError
        If it cannot be written: names `path`.
    KeyboardInterrupt
        If the program is interrupted meanwhile: names `path`.
    """
    path = Path(path)
    target, stream = Path(os.path.realpath(path)), _is_stream(path)
    folder = Path(tempfile.gettempdir()) if stream else target.parent
    aside = None
    try:
        aside = _empty_file(folder, path.suffix)
        yield aside
        _copy(aside, path) if stream else _move(aside, target)
    except OSError as error:
        raise OSError(f"{path}: it could not be written ({error.strerror or error}){_kept(target)}") from None
    except KeyboardInterrupt:
        raise KeyboardInterrupt(f"{path} is not written{_kept(target)}") from None
    finally:
        if aside is not None:
            aside.unlink(missing_ok=True)


def write_text(path: str | Path, text: str) -> None:
    """Write a text file in UTF-8 aside, and put it in its place; see `replacing`."""
    with replacing(path) as aside:
        aside.write_text(text, encoding="utf-8", errors="replace", newline="")


def _empty_file(folder: Path, suffix: str) -> Path:
    """A new file, with the permissions that the user's files have."""
    path = folder / f"{ASIDE}{os.urandom(6).hex()}{suffix}"
    os.close(os.open(path, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o666))
    return path


def _move(aside: Path, target: Path) -> None:
    """Put a file in the place of another, whose permissions it takes; not before it is on the disk."""
    if target.exists():
        shutil.copymode(target, aside)
    with aside.open("rb+") as file:
        os.fsync(file.fileno())
    os.replace(aside, target)


def _copy(aside: Path, stream: Path) -> None:
    """Write the content of a file to a device, a pipe or an open file."""
    with aside.open("rb") as source, stream.open("ab") as written:
        shutil.copyfileobj(source, written)


def _kept(target: Path) -> str:
    return "; the file that was there is unchanged" if target.is_file() else ""
