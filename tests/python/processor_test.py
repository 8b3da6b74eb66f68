"""pillarfield.Processor: order, results lent, threads, tare, forks."""

import gc
import os
import threading
import unittest

import numpy as np

import pillarfield as pf
import skins


class Ring(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.simulation = pf.simulate(skins.scene(frames=30))
        cls.plan = skins.plan_of(cls.simulation, outputs=["angles"], estimator="direct")
        cls.expected = pf.solve(cls.simulation, outputs=["angles"], estimator="direct")

    def equal(self, forces, index):
        return all(np.array_equal(getattr(forces, name), getattr(self.expected[index], name))
                   for name in ("shear_x", "shear_y", "normal", "status", "theta"))

    def test_stream_keeps_order(self):
        for ahead in (0, 1, 2):
            with pf.Processor(self.plan, frames_in_flight=3) as processor:
                for index, forces in enumerate(processor.stream(self.simulation.frames, ahead)):
                    self.assertTrue(self.equal(forces, index))
                self.assertEqual((index, processor.in_flight), (29, 0))

    def test_held_results_stay_right_after_the_processor(self):
        for lent in (0, 2, 6):
            with pf.Processor(self.plan, lent=lent) as processor:
                held = list(processor.stream(self.simulation.frames))
            del processor
            gc.collect()
            for index, forces in enumerate(held):
                self.assertTrue(self.equal(forces, index), (lent, index))

    def test_lent_results_are_read_only_and_copies_are_not(self):
        with pf.Processor(self.plan) as processor:
            forces = next(processor.stream(self.simulation.frames))
        with self.assertRaises(ValueError):
            forces.normal[0, 0] = 1
        with self.assertRaises(ValueError):
            forces.normal.setflags(write=True)
        forces.copy().normal[0, 0] = 1

    def test_lent_memory_is_used_in_place(self):
        with pf.Processor(self.plan, frames_in_flight=1, lent=1) as processor:
            places = set()
            for forces in processor.stream(self.simulation.frames):
                places.add(forces.normal.ctypes.data)
                del forces
        self.assertLessEqual(len(places), 2)  # two slots, again and again

    def test_frames_copy_no_plan(self):
        """A copy of the plan takes longer than a frame of a large skin."""
        class WithoutPlan(pf.Processor):
            plan = None
        with WithoutPlan(pf.Plan(pf.Skin(8, 12, counts_per_newton=320, layout="pillars"))) as processor:
            processor.submit(np.full((8, 12), 32, np.uint8))
            self.assertEqual(processor.receive().skin.rows, 8)

    def test_order_of_calls(self):
        processor = pf.Processor(self.plan, frames_in_flight=1)
        self.assertIsNone(processor.try_receive())
        with self.assertRaisesRegex(pf.Error, "no frame is in flight"):
            processor.receive()
        processor.submit(self.simulation.frames[0])
        with self.assertRaisesRegex(pf.Error, "all frames are in flight"):
            processor.submit(self.simulation.frames[0])
        while (forces := processor.try_receive()) is None:
            pass
        self.assertTrue(self.equal(forces, 0))
        processor.close()
        processor.close()
        for call in (processor.receive, processor.try_receive, lambda: processor.tare):
            with self.assertRaisesRegex(pf.Error, "closed"):
                call()

    def test_a_stream_left_early_leaves_nothing_in_flight(self):
        processor = pf.Processor(self.plan, frames_in_flight=3)
        for forces in processor.stream(self.simulation.frames, ahead=2):
            break
        del forces
        gc.collect()
        self.assertEqual(processor.in_flight, 0)

        def broken():
            yield self.simulation.frames[0]
            raise RuntimeError("mine")

        with self.assertRaisesRegex(RuntimeError, "mine"):
            list(processor.stream(broken(), ahead=2))
        self.assertEqual(processor.in_flight, 0)

    def test_a_new_tare(self):
        frame = np.full((8, 12), 100, np.uint8)
        skin = pf.Skin(8, 12, counts_per_newton=100)
        plan = pf.Plan(skin, calibration=pf.Calibration(8, 12, tare=np.zeros((8, 12))))
        with pf.Processor(plan) as processor:
            normals = []
            for tare in (0, 50):
                processor.set_tare(np.full((8, 12), tare))
                processor.submit(frame)
                normals.append(float(processor.receive().normal[0, 0]))
            self.assertTrue((processor.tare == 50).all())
            with self.assertRaises(pf.Error):
                processor.set_tare(np.zeros((8, 11)))
            with self.assertRaises(pf.Error):
                processor.set_tare(np.full((8, 12), np.nan))
        self.assertEqual(normals, [1.0, 0.5])

    def test_a_step_brings_its_threshold(self):
        idle = (50 + np.random.default_rng(1).normal(0, 2, (50, 8, 12))).astype(np.float32)
        skin = pf.Skin(8, 12, layout="sensels")
        plan = pf.Plan(skin, sensel_type="float32", calibration=pf.Calibration(8, 12, tare=np.zeros((8, 12))))
        with pf.Processor(plan) as processor:
            processor.set_tare(pf.calibrate.tare(idle, skin=skin))
            self.assertAlmostEqual(processor.plan.skin.threshold_counts, 9, delta=2)

    def test_threads_take_turns(self):
        done = []
        with pf.Processor(self.plan, frames_in_flight=8) as processor:

            def work():
                for frame in self.simulation.frames:
                    try:
                        processor.submit(frame)
                        done.append(float(processor.receive().normal.sum()))
                    except pf.Error:
                        pass

            threads = [threading.Thread(target=work) for _ in range(6)]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join()
        sums = {float(forces.normal.sum()) for forces in self.expected}
        self.assertGreater(len(done), 60)
        self.assertLessEqual(set(done), sums)

    def test_a_fork_is_told_and_ends(self):
        processor = pf.Processor(self.plan, contacts=True)
        held = next(processor.stream(self.simulation.frames))
        child = os.fork()
        if child == 0:
            refused = 0
            for call in (processor.receive, lambda: pf.solve(self.simulation),
                         lambda: pf.Processor(self.plan),
                         lambda: processor.submit(self.simulation.frames[0])):
                try:
                    call()
                except pf.Error as error:
                    refused += "forked" in str(error)
            fits = self.equal(held, 0)  # Memory came along.
            fits &= self.equal(pf.solve(self.simulation, device="host", outputs=["angles"], estimator="direct")[0], 0)
            del processor, held
            gc.collect()
            os._exit(0 if (refused, fits) == (4, True) else 1)
        self.assertEqual(os.waitpid(child, 0)[1], 0)
        processor.submit(self.simulation.frames[3])
        self.assertTrue(self.equal(processor.receive(), 3))


if __name__ == "__main__":
    unittest.main()
