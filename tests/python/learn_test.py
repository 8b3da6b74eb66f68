"""examples_test with the example that trains a network."""

import os
import unittest

os.environ["LEARN"] = "1"
from examples_test import *  # noqa: E402, F403

if __name__ == "__main__":
    WORK.mkdir(parents=True, exist_ok=True)  # noqa: F405
    unittest.main(defaultTest="Examples.test_learn_forces")
