"""What keeps a policy from being judged, in words for people."""


class ExportError(Exception):
    """An export or a model that cannot be used; the message names the file and the remedy."""
