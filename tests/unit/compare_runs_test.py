"""Tests tools/compare_runs.py.

    python3 compare_runs_test.py TOOLS
"""
import contextlib
import io
import sys
import unittest

sys.path.insert(0, sys.argv.pop(1))
from compare_runs import what_grew  # noqa: E402


def row(name, us, error):
    return {"section": "frames", "frame": "far", "size": "64x36", "kind": "whole", "name": name, "us": us,
            "p10_us": 0.99 * us, "p90_us": 1.01 * us, "relative_rmse": error}


def run(us=50, error=0.02, device="a"):
    return {"device": device, "results": [row("Pellucid", 100, 0.01), row("HDRP, 20 samples", us, error)]}


def grew(before, now):
    with contextlib.redirect_stdout(io.StringIO()):
        return list(what_grew(before, now))


class CompareRuns(unittest.TestCase):
    def test_times_beyond_the_spread_are_named(self):
        self.assertEqual(grew(run(), run()), [])
        self.assertEqual(grew(run(), run(us=51)), [])
        [line] = grew(run(), run(us=55))
        self.assertTrue(line.startswith("slower: frames: far: 64x36: whole: HDRP, 20 samples: 55.0 us"), line)
        wide = run()
        wide["results"][1]["p90_us"] = 60
        self.assertEqual(grew(wide, run(us=55)), [])

    def test_errors_that_grew_are_named_and_times_of_two_devices_refused(self):
        with self.assertRaises(ValueError):
            grew(run(), run(device="b"))
        before, now = run(), run(error=0.03, device="b")
        for one in before, now:
            for r in one["results"]:
                for time in "us", "p10_us", "p90_us":
                    del r[time]
        [line] = grew(before, now)
        self.assertTrue(line.startswith("worse: "), line)


unittest.main()
