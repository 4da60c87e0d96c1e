"""Writing of files: checks in advance, and replacement of the old file in one step."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path

ASIDE = ".unfinished-"  # prefix of the name of a file that is still being written


def as_path(name: str, value: object, wanted: str = "a file") -> Path:
    """Convert an argument to a path.

    Parameters
    ----------
    name : str
        Name of the argument, for the message.
    value : object
        The argument: a text or a path.
    wanted : str
        Description of the file or folder that the path should name, for the message.

    Raises
    ------
    InvalidValue
        If `value` is neither text nor a path.
    """
    if not isinstance(value, str | os.PathLike):
        # Imported here, since the import loads numpy, which is not needed to show help.
        from beamdyn.common.inputs.checks import InvalidValue

        raise InvalidValue(name, value, f"give the name of {wanted}, as text or path")
    return Path(value)


def check_writable(
    path: str | Path,
    suffixes: Sequence[str] = (),
    force: bool = False,
    remedy: str = "choose another name, or overwrite it with force",
) -> Path:
    """Check that a file can be written, by writing an empty file in the same folder.

    Parameters
    ----------
    path : str or Path
        File to write; a link stands for the file to which it points.
    suffixes : sequence of str
        Allowed suffixes in lower case with their dots; "" allows a name without suffix; an empty sequence
        allows all.
    force : bool
        Overwrite a file that exists.
    remedy : str
        Advice for the message about a file that exists.

    Returns
    -------
    Path

    Raises
    ------
    ValueError
        If `path` is neither text nor a path, or its suffix is not allowed.
    FileExistsError
        If the file exists and `force` is not set.
    FileNotFoundError
        If the folder does not exist.
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
        try:  # an empty file in the same folder also shows whether the system accepts the file's name
            _empty_file(target.parent, path.suffix).unlink()
            with suppress(FileNotFoundError):
                target.stat()
        except OSError as error:
            reason = error.strerror or str(error)
            raise OSError(f"{path}: it cannot be written ({reason}); give another file") from None
    return path


def _is_stream(path: Path) -> bool:
    """Return whether a path is a device, a pipe or an open file (/dev/stdout): it cannot be replaced."""
    named = os.path.abspath(path.parent) in ("/dev", "/dev/fd", "/proc/self/fd")
    return os.path.exists(path) and (named or not os.path.isfile(path))


def same_file(one: str | Path, other: str | Path) -> bool:
    """Return whether two paths lead to the same file or folder, through links or different spellings."""
    try:
        return os.path.samefile(one, other)
    except (OSError, ValueError):  # one of the two files does not exist
        return os.path.realpath(one) == os.path.realpath(other)


@contextmanager
def replacing(path: str | Path) -> Iterator[Path]:
    """Yield the path of a temporary file, which replaces `path` in one step when all data are written.

    Even if the program is stopped, the file at `path` is either the complete old file or the complete new
    one.  If `path` is a link, the file to which it points is replaced; to a device or a pipe, the data are
    written.

    Parameters
    ----------
    path : str or Path
        File to write, in an existing folder.

    Yields
    ------
    Path
        Path of an empty file with the same suffix.

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
                os.fsync(file.fileno())  # data must be on the disk before the old file is replaced
            os.replace(aside, target)
    except OSError as error:
        raise OSError(f"{path}: it could not be written ({error.strerror or error}){kept}") from None
    except KeyboardInterrupt:
        raise KeyboardInterrupt(f"{path} is not written{kept}") from None
    finally:
        if aside is not None:
            aside.unlink(missing_ok=True)


def write_text(path: str | Path, text: str) -> None:
    """Write a text file in UTF-8 under a temporary name, then replace the old file; see `replacing`."""
    with replacing(path) as aside:
        aside.write_text(text, encoding="utf-8", errors="replace", newline="")


def _empty_file(folder: Path, suffix: str) -> Path:
    """Make an empty file with the user's usual permissions."""
    path = folder / f"{ASIDE}{os.urandom(6).hex()}{suffix}"
    os.close(os.open(path, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o666))
    return path
