"""A lock on a result directory: one thread of one process writes there at a time."""

import errno
import os
import socket
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from fem_impact.errors import OutputPathError
from fem_impact.files.atomic import make_directory, unwritable

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
