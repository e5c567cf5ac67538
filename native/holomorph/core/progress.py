"""Progress functions of parts of the work."""


def scaled(progress, begin, end):
    """A progress function for the part [begin, end] of the work; None for none."""
    if progress is None:
        return None
    return lambda fraction, stage: progress(begin + (end - begin) * fraction, stage)
