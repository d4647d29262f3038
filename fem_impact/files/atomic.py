"""Atomic files, written beside the target, synced and renamed in one step; the lock on their directory."""

import errno
import os
import socket
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import mkstemp

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
        return Path(path).read_bytes().decode("utf-8")
    except UnicodeDecodeError as error:
        raise ResultError(f"{path}: not UTF-8 text at byte {error.start}; the file is damaged.") from error
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
