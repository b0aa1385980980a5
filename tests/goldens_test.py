"""What scripts/goldens takes for the same and what for a difference."""

import importlib.machinery
import importlib.util
import pathlib
import sys
import unittest

sys.dont_write_bytecode = True  # no cache beside the script
loader = importlib.machinery.SourceFileLoader("goldens", str(pathlib.Path(__file__).parent.parent / "scripts" / "goldens"))
goldens = importlib.util.module_from_spec(importlib.util.spec_from_loader("goldens", loader))
sys.modules["goldens"] = goldens
loader.exec_module(goldens)


def verdict(name, old, new, tolerance=1e-9):
    return goldens.judge(name, old, new, tolerance)[0]


class Judge(unittest.TestCase):
    def test_same_bytes(self):
        self.assertEqual(verdict("a.txt", b"k2 6.9071\n", b"k2 6.9071\n"), "identical")

    def test_numbers_within_the_tolerance(self):
        self.assertEqual(verdict("a.json", b'{"k": 1.0000000001}', b'{"k": 1.0}'), "within")
        self.assertEqual(verdict("a.csv", b"k,1.0000000001\n", b"k,1.0\n"), "within")

    def test_numbers_beyond_the_tolerance(self):
        self.assertEqual(verdict("a.json", b'{"k": 1.00000001}', b'{"k": 1.0}'), "differs")
        self.assertEqual(verdict("a.json", b'{"k": 0.5}', b'{"k": 0.6}'), "differs")

    def test_lists_are_relative_to_their_largest(self):
        self.assertEqual(verdict("a.json", b'{"r": [1.0, 1e-17]}', b'{"r": [1.0, -2e-17]}'), "within")
        self.assertEqual(verdict("a.json", b'{"r": [[1.0, 0.0],\n [1e-17, 1.0]]}', b'{"r": [[1.0, 0.0],\n [0.0, 1.0]]}'), "within")
        self.assertEqual(verdict("a.json", b'{"a": 1.0, "b": 1e-13}', b'{"a": 1.0, "b": 2e-13}'), "differs")
        self.assertEqual(verdict("a.json", b'{"a": 1.0, "b": 1e-17}', b'{"a": 1.0, "b": 2e-17}'), "within")
        self.assertEqual(verdict("a.json", b'{"left_mm": 3.8106e-10}', b'{"left_mm": 3.8111e-10}'), "within")
        self.assertEqual(verdict("a.json", b'{"left_mm": 3.8e-07}', b'{"left_mm": 3.9e-07}'), "differs")

    def test_shares_are_relative_to_the_whole(self):
        share = b'{"shrink": {"value": %s, "low": -0.1}, "explained": %s, "k": {"value": %s}}'
        old = share % (b"0.00048008", b"0.00096486", b"2.5")
        self.assertEqual(verdict("a.json", old, share % (b"0.00047998", b"0.00096464", b"2.5"), 1e-4), "within")
        self.assertEqual(verdict("a.json", old, share % (b"0.00068008", b"0.00096486", b"2.5"), 1e-4), "differs")
        self.assertEqual(verdict("a.json", old, share % (b"0.00048008", b"0.00096486", b"2.501"), 1e-4), "differs")
        rows = b'effects,k,explained_percent\n"bearing, tilt",%s,%s\n'
        old = rows % (b"0.0480088836", b"0.09648614796")
        self.assertEqual(verdict("a.csv", old, rows % (b"0.0480088836", b"0.09646427574"), 1e-4), "within")
        self.assertEqual(verdict("a.csv", old, rows % (b"0.0480088836", b"0.11648614796"), 1e-4), "differs")
        self.assertEqual(verdict("a.csv", old, rows % (b"0.0479979797", b"0.09648614796"), 1e-4), "differs")

    def test_components_near_zero_in_columns(self):
        self.assertEqual(verdict("a.csv", b"left_x_mm\n-6.452773317e-06\n", b"left_x_mm\n-6.451602991e-06\n", 1e-4), "within")
        self.assertEqual(verdict("a.csv", b"left_x_mm\n-6.452773317e-06\n", b"left_x_mm\n-6.352773317e-06\n", 1e-4), "differs")
        self.assertEqual(verdict("a.csv", b"k\n-6.452773317e-06\n", b"k\n-6.451602991e-06\n", 1e-4), "differs")

    def test_one_rounded_number_may_be_its_neighbour(self):
        self.assertEqual(verdict("a.txt", b"  k2   9.9999 +-0.1", b"  k2  10.0000 +-0.1"), "within")
        self.assertEqual(verdict("a.txt", b"9.9999 +-0.11 9.8", b"10.0000 +-0.12 9.7"), "differs")
        self.assertEqual(verdict("a.json", b'{"why": "rms 27.31 um"}', b'{"why": "rms 27.32 um"}'), "within")
        self.assertEqual(verdict("a.txt", b"9.9999", b"10.0000", 0), "differs")

    def test_counts_names_and_words(self):
        self.assertEqual(verdict("a.txt", b"19 postures", b"18 postures"), "differs")
        self.assertEqual(verdict("a.txt", b"P10 at 0.5", b"P11 at 0.5"), "differs")
        self.assertEqual(verdict("a.json", b'{"k": 1.0}', b'{"k": null}'), "differs")
        self.assertEqual(verdict("a.json", b'{"k": 1.0}', b'{"j": 1.0}'), "differs")
        self.assertEqual(verdict("a.txt", b"a  9.9\n", b"a 9.9\n"), "differs")

    def test_files_that_come_and_go(self):
        self.assertEqual(verdict("a.txt", None, b"new"), "differs")
        self.assertEqual(verdict("a.txt", b"old", None), "differs")

    def test_first_differing_lines_are_shown(self):
        words = goldens.judge("a.txt", b"one\ntwo\nthree\n", b"one\n2\nthree\n", 1e-9)[1]
        self.assertEqual(words, "differs\n    2 - two\n    2 + 2")

    def test_versions_and_pictures_of_another_machine(self):
        self.assertEqual(goldens.normalised("a.json", b'"Eigen": "3.4.0",'), b'"Eigen": "...",')
        self.assertEqual(goldens.normalised("a.csv", b"Ceres Solver,2.1.0\n"), b"Ceres Solver,...\n")
        self.assertEqual(goldens.normalised("a.html", b'<th>VTK</th>\n<td class="n">9.1.0</td>'), b'<th>VTK</th>\n<td class="n">...</td>')
        self.assertEqual(goldens.normalised("a.html", b'src="data:image/png;base64,iVBO+/=="'), b'src="data:image/png;base64,..."')


if __name__ == "__main__":
    unittest.main()
