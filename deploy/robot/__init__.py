"""A trained policy on Unitree's DDS topics: a controller with its safety, and a robot in MuJoCo that answers it."""
