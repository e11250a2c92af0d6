"""What keeps a policy from being run, in words for people."""


class RobotError(Exception):
    """A policy, a network or a robot that cannot be used; the message names it and the remedy."""
