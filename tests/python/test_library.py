# SPDX-License-Identifier: Apache-2.0
"""Every scenario of the library: events through Python are the program's. Takes a minute: `ctest -L long`."""
import unittest
import warnings

import prehend
import takes


class Library(takes.Folder, unittest.TestCase):
    def test_every_scenario(self):
        warnings.simplefilter("ignore")
        file = self.folder / "suite.episodes"
        takes.program("check", "--no-pictures", "--record", file, code=None)  # what it says of them is not judged here
        episodes = prehend.open(file)
        self.assertGreater(len(episodes), 200)
        told = takes.printed("episode", "resegment", file, code=None)
        grammar = prehend.Grammar("pick_and_place")
        for one, (name, events) in zip(episodes, told):
            self.assertEqual(one.name, name)
            self.assertEqual(takes.found(one.events, one.ticks_per_second), events, name)
            self.assertEqual(takes.found(one.segment(), one.ticks_per_second), events, name)
        told = takes.printed("episode", "resegment", file, "--grammar", "pick_and_place", code=None)
        for one, (name, events) in zip(episodes, told):
            self.assertEqual(takes.found(grammar.segment(one), one.ticks_per_second), events, name)


if __name__ == "__main__":
    unittest.main()
