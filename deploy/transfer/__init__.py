"""A trained policy in another simulator: reading an export, the robot in MuJoCo, episodes, pictures."""
