"""A refusal: one sentence that names the thing, its value and the cure."""


class Refusal(Exception):
    """Something that was asked for cannot be done; the message is one sentence for the user."""


class CacheRefusal(Refusal):
    """A cache file cannot be written or read; what was written before is kept."""


def sentence_of(error: BaseException) -> str:
    """The message of an error as one line, with its kind where it has no message of its own."""
    text = " ".join(str(error).split())
    return text if text else type(error).__name__


def cannot_write(path: str, error: OSError) -> CacheRefusal:
    """The refusal for a file that the system did not let us write."""
    reason = error.strerror or sentence_of(error)
    return CacheRefusal(
        f'the cache "{path}" cannot be written ({reason}): free disk space or choose a folder '
        "that you may write to; frames so far are kept"
    )
