"""Writing of files: tried beforehand, written under another name, and put in their place in one step."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path

ASIDE = ".unfinished-"  # start of the name of a file that is still being written


def as_path(name: str, value: object, wanted: str = "a file") -> Path:
    """Return an argument as a path.

    Parameters
    ----------
    name : str
        Name of the argument, for the message.
    value : object
        Text or path.
    wanted : str
        Kind of thing that the path is to name.

    Raises
    ------
    InvalidValue
        If `value` is neither text nor a path.
    """
    if not isinstance(value, str | os.PathLike):
        # Imported here, since it loads numpy, which help does without.
        from beamdyn.common.inputs.checks import InvalidValue

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
        If `path` is neither text nor a path, or its suffix is none of those allowed.
    FileExistsError
        If the file exists and `force` is not set.
    FileNotFoundError
        If there is no such folder.
    OSError
        If the path is a folder, or cannot be written for another reason.
    """
    path = as_path("path", path)
    stream = _is_stream(path)
    if suffixes and path.suffix.lower() not in suffixes:
        known = ", ".join(filter(None, suffixes))
        raise ValueError(f"{path}: unknown suffix {path.suffix!r}; give one of {known}")
    if os.path.isdir(path):
        raise IsADirectoryError(f"{path}: it is a folder; give the name of a file")
    if os.path.isfile(path) and not stream and not force:
        raise FileExistsError(f"{path}: the file exists; {remedy}")
    if os.path.exists(path) and not os.access(path, os.W_OK):
        raise PermissionError(f"{path}: it is protected against writing; give another file")
    target = Path(os.path.realpath(path))
    if not stream and not target.parent.is_dir():
        raise FileNotFoundError(f"{path}: there is no folder {target.parent}; create it first")
    if not stream:
        try:  # writes an empty file in the same folder, and tries whether the system accepts the file's name
            _empty_file(target.parent, path.suffix).unlink()
            with suppress(FileNotFoundError):
                target.stat()
        except OSError as error:
            reason = error.strerror or str(error)
            raise OSError(f"{path}: it cannot be written ({reason}); give another file") from None
    return path


def _is_stream(path: Path) -> bool:
    """Whether a path is a device, a pipe or an open file such as /dev/stdout, which cannot be replaced."""
    named = os.path.abspath(path.parent) in ("/dev", "/dev/fd", "/proc/self/fd")
    return os.path.exists(path) and (named or not os.path.isfile(path))


def same_file(one: str | Path, other: str | Path) -> bool:
    """Whether two paths lead to the same file or folder, by links or another spelling."""
    try:
        return os.path.samefile(one, other)
    except (OSError, ValueError):  # one of the two does not exist
        return os.path.realpath(one) == os.path.realpath(other)


@contextmanager
def replacing(path: str | Path) -> Iterator[Path]:
    """Yield the path of a temporary file, which replaces `path` in one step when all is written.

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
        If the file cannot be written; the message names `path`.
    KeyboardInterrupt
        If the program is interrupted meanwhile; the message names `path`.
    """
    path = Path(path)
    target, stream = Path(os.path.realpath(path)), _is_stream(path)
    kept = "; the file that was there is unchanged" if target.is_file() else ""
    aside = None
    try:
        aside = _empty_file(Path(tempfile.gettempdir()) if stream else target.parent, path.suffix)
        yield aside
        if stream:
            with aside.open("rb") as source, path.open("ab") as written:
                shutil.copyfileobj(source, written)
        else:
            if target.exists():
                shutil.copymode(target, aside)
            with aside.open("rb+") as file:
                os.fsync(file.fileno())  # the new file must be on the disk before it replaces the old one
            os.replace(aside, target)
    except OSError as error:
        raise OSError(f"{path}: it could not be written ({error.strerror or error}){kept}") from None
    except KeyboardInterrupt:
        raise KeyboardInterrupt(f"{path} is not written{kept}") from None
    finally:
        if aside is not None:
            aside.unlink(missing_ok=True)


def write_text(path: str | Path, text: str) -> None:
    """Write a text file in UTF-8 under another name, and put it in its place; see `replacing`."""
    with replacing(path) as aside:
        aside.write_text(text, encoding="utf-8", errors="replace", newline="")


def _empty_file(folder: Path, suffix: str) -> Path:
    """Make an empty file with the user's usual permissions."""
    path = folder / f"{ASIDE}{os.urandom(6).hex()}{suffix}"
    os.close(os.open(path, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o666))
    return path
