"""leak_test with a million frames."""

import leak_test

leak_test.FRAMES = 1_000_000
leak_test.main()
