"""A lock on a result directory: one thread of one process writes there at a time."""

from __future__ import annotations

import errno
import fcntl
import os
import socket
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from fem_impact.errors import OutputPathError
from fem_impact.files.atomic import make_directory, unwritable

LOCK = ".lock"
_NO_LOCKS = (errno.ENOLCK, errno.ENOTSUP, errno.EOPNOTSUPP, errno.ENOSYS)
_thread = threading.local()  # its attribute `directories`: those that this thread has locked


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
    place = make_directory(out).resolve()
    directories: set[Path] = _thread.__dict__.setdefault("directories", set())
    if place in directories:
        yield
        return
    handle = _locked_file(place / LOCK)
    directories.add(place)
    try:
        yield
    finally:
        directories.discard(place)
        (place / LOCK).unlink(missing_ok=True)
        os.close(handle)


def _locked_file(path: Path) -> int:
    """Return the handle of the lock file, locked and with its owner written into it."""
    try:
        handle = _opened(path)
        # the previous owner may remove the file between its opening and its locking here
        while not (path.exists() and os.path.samestat(os.fstat(handle), path.stat())):
            os.close(handle)
            handle = _opened(path)
        os.truncate(handle, 0)
        os.pwrite(handle, f"process {os.getpid()} on {socket.gethostname()}".encode(), 0)
    except OSError as error:
        raise unwritable(path, error) from error
    return handle


def _opened(path: Path) -> int:
    """Open and lock the file. Raises OutputPathError when another has locked it."""
    handle = os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        owner = os.pread(handle, 200, 0).decode(errors="replace")
        os.close(handle)
        problem = f"{path.parent}: {owner or 'another process'} is writing its results there."
        raise OutputPathError(
            f"{problem} Wait for its end, or choose another directory with --out."
        ) from None
    except OSError as error:
        if error.errno not in _NO_LOCKS:
            os.close(handle)
            raise
    return handle
