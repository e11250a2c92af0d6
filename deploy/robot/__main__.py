"""`python deploy/robot --help`: a policy on a robot's DDS topics, or the robot that stands in for one."""

import sys
from pathlib import Path

# Run as a folder, it is no package yet, and its modules are not to be met under their bare names.
sys.path[0] = str(Path(__file__).resolve().parents[1])

from robot.command import main  # noqa: E402

if __name__ == "__main__":
    sys.exit(main())
