"""What a run depends on, as one number: a finished run with the same one need not be repeated."""

import functools
import hashlib


@functools.lru_cache(maxsize=None)
def _file_digest(path, _size, _mtime_ns):
    return hashlib.sha256(path.read_bytes()).hexdigest()


def file_digest(path):
    """Of a file's content; read once as long as the file stays as it is."""
    status = path.stat()
    return _file_digest(path, status.st_size, status.st_mtime_ns)


def fingerprint(arguments, files):
    """Of a command's arguments and the content of the files that it reads, in their order."""
    digest = hashlib.sha256()
    for part in [*arguments, *(file_digest(path) for path in files)]:
        digest.update(str(part).encode() + b'\0')
    return digest.hexdigest()
