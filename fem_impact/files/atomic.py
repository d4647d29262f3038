"""Files that are whole: written in one step, locked while one process writes, read as they were written."""

import errno
import hashlib
import json
import os
import socket
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from tempfile import mkstemp
from typing import Any

from fem_impact.errors import OutputPathError, ResultError


@contextmanager
def atomic_path(path: str | Path) -> Iterator[Path]:
    """Yield a temporary file in the target's folder; it becomes ``path`` only if the block succeeds.

    The suffix of ``path`` is kept, since encoders choose the format by it.

    Raises
    ------
    OutputPathError
        The folder cannot be written or the disk is full; the temporary file is gone then, and an
        older file at ``path`` stands as it was.
    """
    target = Path(path)
    make_directory(target.parent)
    try:
        handle, name = mkstemp(dir=target.parent, prefix=f".{target.stem}-", suffix=target.suffix)
        os.close(handle)
        draft = Path(name)
        try:
            yield draft
            with draft.open("rb") as file:
                os.fsync(file.fileno())
            mask = os.umask(0o022)  # can only be read by setting it
            os.umask(mask)
            draft.chmod(0o666 & ~mask)
            os.replace(draft, target)
        finally:
            draft.unlink(missing_ok=True)
    except OSError as error:
        raise unwritable(target, error) from error


def write_bytes(path: str | Path, data: bytes) -> Path:
    """Write ``data`` to ``path`` in one step; return the path. Raises OutputPathError."""
    with atomic_path(path) as draft:
        draft.write_bytes(data)
    return Path(path)


def write_text(path: str | Path, text: str) -> Path:
    """Write ``text`` as UTF-8 to ``path`` in one step; return the path. Raises OutputPathError."""
    return write_bytes(path, text.encode("utf-8"))


def read_text(path: str | Path) -> str:
    """Return the UTF-8 text of a result file.

    Raises
    ------
    ResultError
        The file is missing, a folder, not allowed to be read, or no text.
    """
    try:
        return read_bytes(path).decode("utf-8")
    except UnicodeDecodeError as error:
        raise ResultError(f"{path}: not UTF-8 text at byte {error.start}; the file is damaged.") from error


def read_bytes(path: str | Path) -> bytes:
    """Return the content of a file.

    Raises
    ------
    ResultError
        The file is missing, a folder, or not allowed to be read.
    """
    try:
        return Path(path).read_bytes()
    except OSError as error:
        raise ResultError(f"{path}: cannot be read ({error.strerror}).") from error


def make_directory(path: str | Path) -> Path:
    """Make a result folder with its parents; return it.

    Raises
    ------
    OutputPathError
        A file stands in the way, or the place cannot be written.
    """
    try:
        Path(path).mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise unwritable(Path(path), error) from error
    return Path(path)


def unwritable(path: Path, error: OSError) -> OutputPathError:
    """Return the OutputPathError for an error of the operating system."""
    full = "free some space or " if error.errno in (errno.ENOSPC, errno.EDQUOT) else ""
    why = error.strerror or str(error)
    return OutputPathError(f"{path}: cannot be written ({why}); {full}choose another place.")


LOCK = ".lock"
_NO_LOCKS = (errno.ENOLCK, errno.ENOTSUP, errno.EOPNOTSUPP, errno.ENOSYS)


@contextmanager
def directory_lock(out: Path) -> Iterator[None]:
    """Make a directory and keep every other process and thread from writing results to it.

    The operating system locks the file `LOCK`, which names the owner, and releases it when the process ends,
    also when it is killed. A thread may lock a directory twice. On a file system without locks nothing is
    locked.

    Raises
    ------
    OutputPathError
        Another process or thread writes to the directory, or it cannot be made.
    """
    from filelock import FileLock, Timeout  # 20 ms, for which no help text should wait

    path = make_directory(out).resolve() / LOCK
    # one object a path, which counts how often each thread has locked it. A second attempt is made where the
    # previous owner removes the file between its opening and its locking here
    lock = FileLock(path, timeout=0.1, is_singleton=True, fallback_to_soft=False)
    try:
        lock.acquire()
        if lock.lock_counter == 1:
            path.write_text(f"process {os.getpid()} on {socket.gethostname()}", encoding="utf-8")
    except Timeout:
        owner = path.read_text("utf-8", "replace") if path.exists() else ""
        raise OutputPathError(
            f"{path.parent}: {owner or 'another process'} is writing its results there. Wait for its end, or "
            "choose another directory (out)."
        ) from None
    except OSError as error:
        if error.errno not in _NO_LOCKS:
            raise unwritable(path, error) from error
    try:
        yield
    finally:
        if lock.lock_counter <= 1:
            path.unlink(missing_ok=True)
        lock.release()


DIGESTS = "files.sha256"
"""Written when a run is done, one line a file, as ``sha256sum --check`` reads it."""


def write_digests(folder: Path, names: Iterable[str]) -> Path:
    """Write the digests of those files that are there; return the path.

    Raises
    ------
    OutputPathError
        The place cannot be written or the disk is full.
    """
    lines = (f"{_digest(folder / name)}  {name}\n" for name in names if (folder / name).is_file())
    return write_text(folder / DIGESTS, "".join(lines))


def check_digest(path: Path) -> None:
    """Refuse a file that is not the one its run wrote; one without a stated digest passes.

    Raises
    ------
    ResultError
        The file was cut off or changed, or is of another run.
    """
    listed = path.parent / DIGESTS
    if not (listed.is_file() and path.is_file()):
        return
    parts = (line.partition("  ") for line in read_text(listed).splitlines())
    digests = {name: value for value, _, name in parts}
    if digests.get(path.name, "") not in ("", _digest(path)):
        raise ResultError(
            f"{path}: is not the file that the run wrote, by {DIGESTS}: it was cut off or changed, or is of "
            "another run. Restore a copy, or run the scene again."
        )


def _digest(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


CHECKSUM = "checksum_sha256"
"""Last key of a record: SHA-256 of all other keys."""


def signed(values: Mapping[str, Any]) -> dict[str, Any]:
    """Return a record of plain JSON values with its checksum."""
    return {**values, CHECKSUM: checksum(values)}


def checksum(values: Mapping[str, Any]) -> str:
    """Return the SHA-256 of a record written with sorted keys, without spaces and in ASCII."""
    canonical = json.dumps(dict(values), sort_keys=True, separators=(",", ":"), ensure_ascii=True)
    return hashlib.sha256(canonical.encode("ascii")).hexdigest()


def read_signed(text: str, source: str) -> dict[str, Any]:
    """Return a record from text, without its checksum.

    Parameters
    ----------
    text : str
    source : str
        The file named in the message.

    Raises
    ------
    ResultError
        It is not JSON, not one record, a key stands twice, or the checksum is missing or wrong.
    """
    try:
        values = json.loads(text, object_pairs_hook=_unrepeated, parse_constant=_no_constant)
    except (ValueError, RecursionError) as error:
        raise ResultError(f"{source}: not a readable JSON record ({error}); it may be cut off.") from error
    if not isinstance(values, dict):
        raise ResultError(f"{source}: holds a JSON {type(values).__name__}, not a record of keys.")
    written = values.pop(CHECKSUM, None)
    if written is None:
        raise ResultError(f'{source}: key "{CHECKSUM}" is missing; the file is not complete.')
    if written != checksum(values):
        raise ResultError(
            f'{source}: key "{CHECKSUM}" = {str(written)[:16]}... does not match the contents; '
            "the file was damaged or edited. Compute it again or restore a copy."
        )
    return values


def _unrepeated(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    values = dict(pairs)
    if len(values) != len(pairs):
        raise ValueError("a key stands twice")
    return values


def _no_constant(name: str) -> float:
    raise ValueError(f"{name} is no JSON number")
