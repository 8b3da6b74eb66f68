"""`pillarfield body`: plans and simulations of a body. The tests require no absolute speed."""

import math
import unittest

from command import SCENES, CommandTest, run, run_json

HAND = SCENES / "body/hand.toml"


class Body(CommandTest):
    def test_simulation_without_losses(self):
        report = run_json("body", "simulate", HAND, "--seconds", 0.3)
        self.assertEqual((report["patches"], report["frames"]), (2, 299))
        self.assertEqual((report["lost_packets"], report["old_blocks"]), (0, 0))
        self.assertEqual(report["longest_healing_s"], 0)
        self.assertLess(report["changed_share"], report["sent_share"])
        self.assertLess(report["sent_share"], 0.2)
        self.assertLessEqual(report["frame_median_ms"], report["frame_p99_ms"])
        self.assertLess(report["worst_clock_s"], 1e-3)
        # Both hands are pressed alike: the normal forces cancel, the shear adds up.
        force = report["load"]["force_n"]
        self.assertGreater(report["load"]["normal_n"], 150)
        self.assertLess(abs(force[2]), 0.02 * report["load"]["normal_n"])
        self.assertGreater(math.hypot(*force), 30)

    def test_losses_heal_within_a_second(self):
        report = run_json("body", "simulate", HAND, "--seconds", 1.5, "--loss", 5)
        self.assertAlmostEqual(report["lost_packets"] / report["packets"], 0.05, delta=0.01)
        self.assertGreater(report["old_blocks"], 1000)
        self.assertGreater(report["longest_healing_s"], 0.001)
        self.assertLess(report["longest_healing_s"], 1)

    def test_rare_refresh_heals_later(self):
        often, rarely = (run_json("body", "simulate", HAND, "--seconds", 1, "--loss", 20,
                                  "--refresh", refresh)["longest_healing_s"]
                         for refresh in (0.02, 0.8))
        self.assertLess(often, rarely)

    def test_plan(self):
        report = run_json("body", "plan", HAND)
        self.assertEqual([each["changed_share"] for each in report["timings"]],
                         [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1])
        sizes = [each["changed_bytes"] for each in report["timings"]]
        self.assertEqual(sizes, sorted(sizes))
        self.assertGreater(sizes[-1], report["timings"][-1]["whole_bytes"])
        self.assertEqual(report["timings"][0]["whole_bytes"], report["sensels"] + 2 * 64)
        self.assertIn("Changed blocks take less time up to", run("body", "plan", HAND).stdout)

    def test_wrong_file_in_one_line(self):
        file = self.folder / "body.toml"
        file.write_text('[[patch]]\nname = "a"\n')
        self.assert_fails("body", "plan", file,
                          names=[f"{file}:1: key 'scene' in [[patch]] is missing"])


if __name__ == "__main__":
    unittest.main()
