"""Tests of what is measured: `python -m unittest transfer.test_measure` in deploy/. Needs no export."""

import math
import unittest

import numpy as np

from .error import ExportError
from .film import stride
from .measure import Record, Step, cost_of_transport, outcome

LEFT, RIGHT, BOTH, NONE = [300.0, 0.0], [0.0, 300.0], [160.0, 155.0], [0.0, 0.0]
JOINTS = ["left_knee_joint", "right_knee_joint"]
HZ = 50.0


def step(velocity=(1.0, 0.0, 0.0), forces=BOTH, command=(1.0, 0.0, 0.0), **other):
    values = {
        "work": 0.0, "heights": np.zeros(2), "speeds": np.zeros(2), "shoulders": np.zeros(2), "lean": 0.0,
        "saturated": np.zeros(2, dtype=bool), "sole_peak": 0.0, "action_change": 0.0,
    }
    return Step(command=np.array(command), velocity=np.array(velocity), forces=np.array(forces), **(values | other))


def of(*steps, settled=True):
    """Figures of one robot that weighs 300 N, past its first two seconds or at its start."""
    record = Record(HZ)
    record.add(steps[0])
    record.held = 100 if settled else 1
    for each in steps[1:]:
        record.add(each)
    record.close()
    return outcome(record, 300.0, JOINTS)


class Measures(unittest.TestCase):
    def test_cost_of_transport_is_work_per_weight_and_way(self):
        self.assertAlmostEqual(cost_of_transport(75.0, 300.0, 0.5), 0.5)  # 75 W / (300 N · 0.5 m/s)
        self.assertIsNone(cost_of_transport(75.0, 300.0, 0.05))
        # 2 J a step are 100 W at 50 Hz; 100 / (300 · 1).
        row = of(step(work=2.0), step(work=2.0))
        self.assertAlmostEqual(row["cost_of_transport"], 1 / 3)
        self.assertEqual(row["energy_j"], 2000.0)

    def test_feet_are_counted_by_the_force_they_carry(self):
        # Both down, left only, none, right lands: (2 + 1 + 0 + 1) / (2 · 4); one landing / 2 / 4 · 50.
        row = of(step(forces=BOTH), step(forces=LEFT), step(forces=NONE), step(forces=RIGHT))
        self.assertEqual(row["duty_factor"], 0.5)
        self.assertEqual(row["flight_share"], 0.25)
        self.assertEqual(row["double_support"], 0.25)
        self.assertEqual(row["stride_rate_hz"], 6.25)
        self.assertEqual(of(step(forces=[20.0, 20.1]))["duty_factor"], 0.5)

    def test_soles_slip_on_the_ground_and_are_clear_of_it_in_the_air(self):
        up = step(forces=LEFT, heights=np.array([0.5, 0.03]), speeds=np.array([0.2, 9.0]))
        down = step(forces=BOTH, heights=np.array([0.5, 0.5]), speeds=np.array([0.1, 0.2]))
        row = of(up, up, down)
        self.assertAlmostEqual(row["foot_clearance"], 0.03)
        self.assertAlmostEqual(row["slip_per_stride"], (0.2 + 0.2 + 0.1 + 0.2) / 50)  # one landing

    def test_sway_within_a_stride_is_an_error_and_not_off_the_command(self):
        fast, slow = (1.5, 0.25, 0.5), (0.5, -0.25, -0.5)
        # The left foot lands in the second, the fourth and the sixth step.
        walk = [step(forces=RIGHT)]
        for _ in range(3):
            walk += [step(fast, LEFT), step(slow, RIGHT)]
        row = of(*walk)
        self.assertAlmostEqual(row["off"], 0.0)
        self.assertAlmostEqual(row["off_yaw_rate"], 0.0)
        self.assertAlmostEqual(row["rmse_settled"], math.sqrt(0.3125))  # 0.5² + 0.25²
        self.assertAlmostEqual(row["rmse"], math.sqrt(6 * 0.3125 / 7))
        self.assertAlmostEqual(row["rmse_yaw_rate"], math.sqrt(6 * 0.25 / 7))

    def test_a_robot_that_stands_is_off_by_its_drift_and_a_new_command_settles_anew(self):
        still = [step((0.25, 0.0, 0.0), command=(0.0, 0.0, 0.0))] * 3
        self.assertAlmostEqual(of(*still)["off"], 0.25)
        self.assertIsNone(of(*still, settled=False)["off"])
        record = Record(HZ)
        for command in ((1.0, 0.0, 0.0), (0.5, 0.0, 0.0)):
            for _ in range(101):
                record.add(step((0.75, 0.0, 0.0), command=command))
        self.assertEqual(record.settled, 2)
        record.close()
        # Both are off by 0.25, one too slow and one too fast.
        self.assertAlmostEqual(outcome(record, 300.0, JOINTS)["off"], 0.25)

    def test_arms_trunk_motors_soles_and_actions(self):
        swing = np.radians([[0, 0], [20, -10], [-10, 20], [0, 0]])
        walk = [step(forces=RIGHT), step(forces=LEFT)]
        walk += [step(forces=RIGHT, shoulders=angles, lean=math.radians(4)) for angles in swing]
        walk += [step(forces=LEFT, saturated=np.array([False, True]), sole_peak=750.0, action_change=0.7)]
        row = of(*walk)
        self.assertAlmostEqual(row["arm_swing_deg"], 30.0)
        self.assertAlmostEqual(row["trunk_lean_deg"], 4 * 4 / 7)
        self.assertAlmostEqual(row["torque_saturated_share"], 1 / 7)
        self.assertEqual(row["saturated_joint"], "right_knee_joint")
        self.assertEqual(list(row["saturated_shares"].values()), [0.0, 1 / 7])
        self.assertEqual(row["sole_force_peak_weights"], 2.5)
        self.assertAlmostEqual(row["action_rate"], 0.1)

    def test_robots_add_up(self):
        records = [Record(HZ), Record(HZ)]
        for record, forward, count in zip(records, (1.25, 0.75), (3, 1), strict=True):
            record.held, record.command = 100, np.array([1.0, 0.0, 0.0])
            for _ in range(count):
                record.add(step((forward, 0.0, 0.0)))
            record.close()
        records[0].merge(records[1])
        row = outcome(records[0], 300.0, JOINTS)
        self.assertEqual(row["off"], 0.25)  # They do not cancel.
        self.assertEqual(row["velocity"], [1.125, 0.0])  # (3 · 1.25 + 0.75) / 4
        with self.assertRaisesRegex(ExportError, "timestep"):
            outcome(Record(HZ), 300.0, JOINTS)

    def test_a_stride_goes_from_landing_to_landing_once_settled(self):
        forces = np.full((200, 2), 300.0)
        # The left foot is in the air before steps 40, 110, 115 (patter) and 150.
        for landing in (40, 110, 115, 150):
            forces[landing - 3 : landing, 0] = 0.0
        self.assertEqual(stride(forces, HZ), (110, 150))
        self.assertIsNone(stride(forces[:150], HZ))


if __name__ == "__main__":
    unittest.main()
