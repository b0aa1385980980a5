"""What is refused, where it is and by which words."""

import os
import pathlib
import pickle
import shutil
import tempfile
import unittest
import warnings

import numpy
import stiffscope

SAMPLES = pathlib.Path(os.environ["STIFFSCOPE_SOURCE_DIR"]) / "samples"


class Refused(unittest.TestCase):

    def error(self, call, *arguments, **options):
        with self.assertRaises(stiffscope.InputError) as raised:
            call(*arguments, **options)
        return raised.exception

    def test_a_cell_by_file_line_column_and_value(self):
        with tempfile.TemporaryDirectory() as folder:
            shutil.copytree(SAMPLES / "active", f"{folder}/day")
            file = pathlib.Path(folder) / "day" / "states.csv"
            lines = file.read_text().splitlines()
            lines[2] = lines[2].replace("26.26764", "twenty")
            file.write_text("\n".join(lines) + "\n")
            error = self.error(stiffscope.open, f"{folder}/day")
        self.assertEqual((error.file, error.line, error.column, error.value), (str(file), 3, "q1_deg", "twenty"))
        self.assertEqual(error.expected, "expected a number")
        self.assertEqual(str(error).count("\n"), 0)
        self.assertIsNone(error.argument)
        self.assertIsInstance(error, ValueError)
        again = pickle.loads(pickle.dumps(error))
        self.assertEqual((str(again), again.line), (str(error), 3))

    def test_arguments_by_their_name_in_python(self):
        active = SAMPLES / "active"
        self.assertEqual(self.error(stiffscope.identify, active, method="dppp").argument, "method")
        self.assertIn("did you mean 'dpp'?", str(self.error(stiffscope.identify, active, method="dppp")))
        self.assertEqual(self.error(stiffscope.identify, active, subset_size=0).argument, "subset_size")
        self.assertEqual(self.error(stiffscope.identify, active, with_="bearing_tlt").argument, "with_")
        self.assertEqual(self.error(stiffscope.fit, "circel", numpy.zeros((3, 3))).argument, "shape")
        self.assertEqual(self.error(stiffscope.plan, active, load=float("nan")).argument, "load")
        self.assertEqual(self.error(stiffscope.plan, active, min_deg=[1, 2]).argument, "min_deg")
        self.assertEqual(self.error(stiffscope.plan, SAMPLES / "unloaded", unloaded=True, load=1).argument, "unloaded")
        self.assertNotIn("--", str(self.error(stiffscope.identify, active, step="heavy")))

    def test_arrays_by_row_and_column(self):
        day = stiffscope.open(SAMPLES / "active")
        error = self.error(day.compensate, [[0, 0, 0, 0, 0, 0], [0, 0, 800, 0, 0, 0]], numpy.zeros(6))
        self.assertEqual((error.file, error.line, error.column), ("postures", 2, "q3_deg"))
        error = self.error(day.compensate, [[0, 0, 0, 0, 0, 0]], [0, float("nan"), 0, 0, 0, 0])
        self.assertEqual((error.file, error.line, error.column), ("wrenches", 1, "fy_n"))
        self.assertEqual(self.error(day.compensate, [[0, 0, 0, 0, 0]], numpy.zeros(6)).argument, "postures")
        self.assertEqual(self.error(day.compensate, numpy.zeros((2, 6))).argument, "wrenches")
        error = self.error(stiffscope.fit, "plane", [[0, 0, 0], [1, 0, float("inf")], [0, 1, 0]])
        self.assertEqual((error.file, error.line, error.column), ("points", 2, "z"))

    def test_what_postures_have_themselves_is_refused_beside_them(self):
        day = stiffscope.open(SAMPLES / "active")
        wrench = [0, 0, -1000, 0, 0, 0]
        columns = {"pose": ["a"], **{f"q{j}_deg": [10.0 * j] for j in range(1, 7)},
                   **{name: [1.0] for name in ("fx_n", "fy_n", "fz_n", "mx_nm", "my_nm", "mz_nm")}}
        for postures in (None, "postures.csv", columns):
            self.assertEqual(self.error(day.compensate, postures, wrench).argument, "wrenches")
            self.assertEqual(self.error(day.compensate, postures, names=["b"]).argument, "names")
        error = self.error(stiffscope.calibrate, SAMPLES / "unloaded", urdf="a.out", csv="./a.out")
        self.assertEqual(error.argument, "urdf")

    def test_postures_that_are_no_numbers_or_have_no_name(self):
        day = stiffscope.open(SAMPLES / "active")
        angles, wrench = [[0, 0, 0, 0, 0, 0]], [0, 0, -1000, 0, 0, 0]
        self.assertEqual(self.error(day.compensate, [["a"] * 6], wrench).argument, "postures")
        self.assertEqual(self.error(day.compensate, [[0] * 6, [0]], wrench).argument, "postures")
        self.assertEqual(self.error(day.compensate, numpy.array(angles) + 1j, wrench).argument, "postures")
        hidden = numpy.ma.masked_array(numpy.zeros((1, 6)), mask=[[False, True] + [False] * 4])
        error = self.error(day.compensate, hidden, wrench)
        self.assertEqual((error.file, error.line, error.column), ("postures", 1, "q2_deg"))
        for nameless in (None, float("nan"), ""):
            self.assertEqual(self.error(day.compensate, angles, wrench, names=[nameless]).argument, "names")
        self.assertNotIn("\n", str(self.error(day.compensate, wrenches=numpy.zeros((3, 6)))))

    def test_a_day_without_a_load_has_no_stiffness(self):
        result = stiffscope.identify(SAMPLES / "unloaded")
        self.assertFalse(result.serves)
        self.assertIn("load_cell", result.why_not)
        self.assertIn("no joint stiffness", str(result))

    def test_what_does_not_serve_says_why(self):
        fitted = stiffscope.fit("sphere", [[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0]])
        self.assertFalse(fitted.serves)
        self.assertTrue(fitted.why_not)
        self.assertFalse(fitted.determined)

    def test_warnings_are_pythons(self):
        with tempfile.TemporaryDirectory() as folder:
            shutil.copytree(SAMPLES / "active", f"{folder}/day")
            file = pathlib.Path(folder) / "day" / "nests.csv"
            file.write_text(file.read_text().rstrip("\n"))
            with warnings.catch_warnings(record=True) as caught:
                warnings.simplefilter("always")
                stiffscope.open(f"{folder}/day")
        self.assertEqual([warning.category for warning in caught], [stiffscope.InputWarning])
        self.assertIn("nests.csv", str(caught[0].message))


if __name__ == "__main__":
    unittest.main()
